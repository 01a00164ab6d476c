/* A pool of a few threads that share one loop. Results must not depend on the number of threads:
 * the function may write only what belongs to its own rows. */
#ifndef JOLON_WORLD_RUNTIME_THREAD_POOL_H
#define JOLON_WORLD_RUNTIME_THREAD_POOL_H

#include <stdbool.h>
#include <stdint.h>

#define THREAD_POOL_MAX 16

struct thread_pool;

/* Processes rows first .. end - 1; worker is 0 .. threads - 1. */
typedef void thread_pool_function(void *context, uint32_t first, uint32_t end, uint32_t worker);

/* Creates a pool of 1..THREAD_POOL_MAX threads, one of which is the caller. Returns NULL with errno
 * on failure. */
struct thread_pool *thread_pool_create(uint32_t threads);
void thread_pool_destroy(struct thread_pool *workers);
uint32_t thread_pool_threads(const struct thread_pool *workers);

/* Keeps the helpers awake until they are let go, for work in many short jobs with longer pauses
 * between them: a helper that sleeps comes when the job is done. Only the caller of jobs calls
 * these. Nothing happens where there are fewer processors than threads. */
void thread_pool_hold(struct thread_pool *workers);
void thread_pool_let_go(struct thread_pool *workers);

/* Returns true while the helpers are kept awake: jobs of a few tens of microseconds pay. workers
 * may be NULL. */
bool thread_pool_is_held(const struct thread_pool *workers);

/* Runs function over 0 .. count - 1 in blocks of at most grain rows, on all threads; returns when
 * all are done. With fewer than two blocks, one thread or workers NULL the caller does it alone and
 * in one call. */
void thread_pool_run(struct thread_pool *workers, thread_pool_function *function, void *context,
                     uint32_t count, uint32_t grain);

#endif
