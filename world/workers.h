/* Workers: a few threads that share one loop. Results must not depend on how many there are: the
 * function may write only what belongs to its own rows. */
#ifndef JOLON_WORLD_WORKERS_H
#define JOLON_WORLD_WORKERS_H

#include <stdint.h>

#define WORKERS_MAX 16

struct workers;

/* Does rows first .. end - 1; worker is 0 .. threads - 1. */
typedef void workers_function(void *context, uint32_t first, uint32_t end, uint32_t worker);

/* threads 1..WORKERS_MAX, the caller being one of them. NULL with errno. */
struct workers *workers_create(uint32_t threads);
void workers_destroy(struct workers *workers);
uint32_t workers_threads(const struct workers *workers);

/* Runs function over 0 .. count - 1 in pieces of at most grain rows, on all threads; returns when
 * all is done. Below two pieces, on one thread or with workers NULL, the caller does it alone and
 * in one piece. */
void workers_run(struct workers *workers, workers_function *function, void *context, uint32_t count,
                 uint32_t grain);

#endif
