/* Memory for libraries that do not look whether they got it.
 *
 * libconfig writes to whatever malloc gave it, null or not, and libseccomp frees twice or goes
 * round for ever, so both are linked statically with their allocations led through checked_alloc.c:
 * where one fails, the call into the library ends there. What it had built until then is lost,
 * which is well before a refusal that ends the process. */
#ifndef JOLON_WORLD_RUNTIME_CHECKED_ALLOC_H
#define JOLON_WORLD_RUNTIME_CHECKED_ALLOC_H

#include <stdbool.h>

/* Calls function(context), which calls a library of C and nothing else; true when it came back,
 * false when an allocation in it failed. Any thread; not within itself. */
bool memory_guarded(void (*function)(void *context), void *context);

#endif
