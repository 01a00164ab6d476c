/* A fork-join pool: the caller publishes a job and works on it too; helpers sleep in between. */
#include "world/workers.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

struct workers {
    uint32_t threads;
    pthread_t thread[WORKERS_MAX];
    pthread_mutex_t mutex;
    pthread_cond_t begin, done;
    uint64_t job;     /* counts jobs; under mutex */
    uint32_t running; /* helpers still in the job; under mutex */
    uint32_t names;   /* next helper's number; under mutex */
    bool stop;        /* under mutex */
    workers_function *function;
    void *context;
    uint32_t count, grain;
    _Atomic uint32_t next;
};

static void work(struct workers *workers, uint32_t worker)
{
    for (;;) {
        uint32_t first =
            atomic_fetch_add_explicit(&workers->next, workers->grain, memory_order_relaxed);
        if (first >= workers->count)
            return;
        uint32_t left = workers->count - first;
        workers->function(workers->context, first,
                          first + (left < workers->grain ? left : workers->grain), worker);
    }
}

static void *helper(void *argument)
{
    struct workers *workers = argument;
    uint64_t seen = 0;
    pthread_mutex_lock(&workers->mutex);
    uint32_t worker = ++workers->names;
    for (;;) {
        while (workers->job == seen && !workers->stop)
            pthread_cond_wait(&workers->begin, &workers->mutex);
        if (workers->stop)
            break;
        seen = workers->job;
        pthread_mutex_unlock(&workers->mutex);
        work(workers, worker);
        pthread_mutex_lock(&workers->mutex);
        if (--workers->running == 0)
            pthread_cond_signal(&workers->done);
    }
    pthread_mutex_unlock(&workers->mutex);
    return NULL;
}

struct workers *workers_create(uint32_t threads)
{
    if (threads < 1 || threads > WORKERS_MAX) {
        errno = EINVAL;
        return NULL;
    }
    struct workers *workers = calloc(1, sizeof *workers);
    if (!workers)
        return NULL;
    workers->threads = 1;
    pthread_mutex_init(&workers->mutex, NULL);
    pthread_cond_init(&workers->begin, NULL);
    pthread_cond_init(&workers->done, NULL);
    while (workers->threads < threads) {
        int error = pthread_create(&workers->thread[workers->threads], NULL, helper, workers);
        if (error != 0) {
            workers_destroy(workers);
            errno = error;
            return NULL;
        }
        workers->threads++;
    }
    return workers;
}

void workers_destroy(struct workers *workers)
{
    if (!workers)
        return;
    pthread_mutex_lock(&workers->mutex);
    workers->stop = true;
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->mutex);
    for (uint32_t i = 1; i < workers->threads; i++)
        pthread_join(workers->thread[i], NULL);
    pthread_cond_destroy(&workers->begin);
    pthread_cond_destroy(&workers->done);
    pthread_mutex_destroy(&workers->mutex);
    free(workers);
}

uint32_t workers_threads(const struct workers *workers)
{
    return workers ? workers->threads : 1;
}

void workers_run(struct workers *workers, workers_function *function, void *context, uint32_t count,
                 uint32_t grain)
{
    grain = grain > 0 ? grain : 1;
    if (!workers || workers->threads == 1 || count <= grain) {
        if (count > 0)
            function(context, 0, count, 0);
        return;
    }
    pthread_mutex_lock(&workers->mutex);
    workers->function = function;
    workers->context = context;
    workers->count = count;
    workers->grain = grain;
    atomic_store_explicit(&workers->next, 0, memory_order_relaxed);
    workers->running = workers->threads - 1;
    workers->job++;
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->mutex);
    work(workers, 0);
    pthread_mutex_lock(&workers->mutex);
    while (workers->running > 0)
        pthread_cond_wait(&workers->done, &workers->mutex);
    pthread_mutex_unlock(&workers->mutex);
}
