/* XXH3 with the widest vectors of the machine; the hash is the same with any of them. */
#ifndef JOLON_WORLD_MATHS_HASH_H
#define JOLON_WORLD_MATHS_HASH_H

#if defined(__x86_64__)
#include <xxh_x86dispatch.h>
#else
#include <xxhash.h>
#endif

#endif
