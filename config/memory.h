/* assimp is C++, whose failed allocations are exceptions that it catches: here it is kept that
 * there was one. */
#ifndef JOLON_CONFIG_MEMORY_H
#define JOLON_CONFIG_MEMORY_H

#include <stdbool.h>

/* From now on an allocation of C++ that fails is remembered; memory_missed() says whether one was.
 */
void memory_watch(void);
bool memory_missed(void);

#endif
