/* Notices failed allocations of C++. assimp is C++ and catches the exception of a failed
 * allocation, so that its caller would not know. */
#ifndef JOLON_CONFIG_SYNTAX_MEMORY_H
#define JOLON_CONFIG_SYNTAX_MEMORY_H

#include <stdbool.h>

/* After memory_watch() memory_missed() returns true once an allocation of C++ has failed. */
void memory_watch(void);
bool memory_missed(void);

#endif
