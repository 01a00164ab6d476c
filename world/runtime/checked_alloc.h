/* Memory for libraries that do not check whether an allocation failed.
 *
 * libconfig writes to the result of malloc even if it is null, and libseccomp frees twice or loops
 * for ever. So both are linked statically, and their allocations go through checked_alloc.c: when
 * one fails, the call into the library ends there. What the library had allocated until then is
 * lost, which is acceptable before a refusal that ends the process. */
#ifndef JOLON_WORLD_RUNTIME_CHECKED_ALLOC_H
#define JOLON_WORLD_RUNTIME_CHECKED_ALLOC_H

#include <stdbool.h>

/* Calls function(context), which calls a C library and nothing else. Returns true when it came
 * back, false when an allocation in it failed. Any thread; not within itself. */
bool memory_guarded(void (*function)(void *context), void *context);

#endif
