/* A fork-join pool: the caller opens a job and works on it too; helper threads enter while it is
 * open.
 *
 * Jobs follow each other within microseconds, and putting a thread to sleep and waking it takes
 * tens of them. So a waiting thread polls for a short while before it sleeps, and without an end
 * while the caller holds the pool. Then it yields its processor now and again: beside other
 * programs the caller may be on the same one. The caller does not wait for a helper that woke after
 * all work was done.
 *
 * Each thread begins with a share of its own, and helps the others when that is done. Jobs over the
 * same rows follow each other, so what a thread has written mostly lies in the cache of the
 * processor that reads it next. */
#include "world/runtime/thread_pool.h"

#include "world/runtime/work_done.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define POLLS 1500 /* polls before sleeping: about 40 us */

/* The gate: the job's number, whether it is open, and how many helpers are in it. */
#define GATE_IN   0xffu
#define GATE_OPEN 0x100u
#define GATE_JOB  0x200u

/* A thread's share of the pieces. On a cache line of its own, because its thread takes most. */
struct share {
    _Alignas(64) _Atomic uint32_t next;
    uint32_t end;
};

struct thread_pool {
    uint32_t threads;
    uint32_t polls; /* 0: fewer processors than threads, so a waiting thread sleeps at once */
    pthread_t thread[THREAD_POOL_MAX];
    pthread_mutex_t mutex;
    pthread_cond_t begin, done;
    _Atomic uint32_t names; /* next helper's number */
    _Atomic uint64_t gate;
    _Atomic uint32_t asleep; /* helpers that sleep, or are about to; changed under mutex */
    _Atomic bool waiting;    /* the caller sleeps, or is about to; changed under mutex */
    _Atomic bool held;       /* helpers poll until they are let go; set under mutex */
    _Atomic bool stop;       /* changed under mutex */
    /* The job; written while the gate is shut and no helper is in it. */
    thread_pool_function *function;
    void *context;
    uint32_t count, grain;
    struct share share[THREAD_POOL_MAX];
};

static void pause_briefly(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#else
    sched_yield();
#endif
}

/* Works on what is left of a share. Only the caller counts its pieces as work done. A caller
 * without a piece waits for one piece of each helper at most. */
static void work_on(struct thread_pool *workers, struct share *share, uint32_t worker)
{
    for (;;) {
        uint32_t piece = atomic_fetch_add_explicit(&share->next, 1, memory_order_relaxed);
        if (piece >= share->end)
            return;
        uint32_t first = piece * workers->grain, left = workers->count - first;
        workers->function(workers->context, first,
                          first + (left < workers->grain ? left : workers->grain), worker);
        work_done_by(worker);
    }
}

static void work(struct thread_pool *workers, uint32_t worker)
{
    for (uint32_t i = 0; i < workers->threads; i++)
        work_on(workers, &workers->share[(worker + i) % workers->threads], worker);
}

/* Gives each thread a share of the job's pieces. */
static void share_out(struct thread_pool *workers)
{
    uint64_t pieces = (workers->count + (uint64_t)workers->grain - 1) / workers->grain;
    for (uint32_t i = 0; i < workers->threads; i++) {
        struct share *share = &workers->share[i];
        atomic_store_explicit(&share->next, (uint32_t)(pieces * i / workers->threads),
                              memory_order_relaxed);
        share->end = (uint32_t)(pieces * (i + 1) / workers->threads);
    }
}

/* --- helpers -----------------------------------------------------------------------------------*/

/* Returns true if a job is open that the helper has not seen, or if the pool ends. */
static bool is_needed(struct thread_pool *workers, uint64_t seen)
{
    uint64_t gate = atomic_load(&workers->gate);
    return (gate & GATE_OPEN && gate / GATE_JOB != seen) || atomic_load(&workers->stop);
}

static void sleep_until_needed(struct thread_pool *workers, uint64_t seen)
{
    pthread_mutex_lock(&workers->mutex);
    atomic_fetch_add(&workers->asleep, 1);
    while (!is_needed(workers, seen) && !atomic_load(&workers->held))
        pthread_cond_wait(&workers->begin, &workers->mutex);
    atomic_fetch_sub(&workers->asleep, 1);
    pthread_mutex_unlock(&workers->mutex);
}

static void wait_for_job(struct thread_pool *workers, uint64_t seen)
{
    for (;;) {
        for (uint32_t i = 0; i < workers->polls || atomic_load(&workers->held); i++) {
            if (is_needed(workers, seen))
                return;
            if (i % POLLS == POLLS - 1)
                sched_yield(); /* the caller may wait for this processor */
            else
                pause_briefly();
        }
        sleep_until_needed(workers, seen);
        if (is_needed(workers, seen))
            return;
    }
}

/* Enters the open job. Returns false if it is shut. */
static bool enter(struct thread_pool *workers, uint64_t *seen)
{
    uint64_t gate = atomic_load(&workers->gate);
    while (gate & GATE_OPEN) {
        if (atomic_compare_exchange_weak(&workers->gate, &gate, gate + 1)) {
            *seen = gate / GATE_JOB;
            return true;
        }
    }
    return false;
}

/* Leaves the job. The last helper to leave a shut job wakes the caller if it sleeps. */
static void leave(struct thread_pool *workers)
{
    uint64_t gate = atomic_fetch_sub(&workers->gate, 1) - 1;
    if (gate & (GATE_OPEN | GATE_IN) || !atomic_load(&workers->waiting))
        return;
    pthread_mutex_lock(&workers->mutex);
    pthread_cond_signal(&workers->done);
    pthread_mutex_unlock(&workers->mutex);
}

static void *helper(void *argument)
{
    struct thread_pool *workers = argument;
    uint32_t worker = atomic_fetch_add(&workers->names, 1) + 1;
    uint64_t seen = 0;
    for (;;) {
        wait_for_job(workers, seen);
        if (atomic_load(&workers->stop))
            return NULL;
        if (enter(workers, &seen)) {
            work(workers, worker);
            leave(workers);
        }
    }
}

/* --- the caller --------------------------------------------------------------------------------*/

/* Opens the job to helpers, and wakes those that sleep. While the pool is held they have been
 * woken, and may only not have come yet. */
static void open_job(struct thread_pool *workers)
{
    uint64_t job = atomic_load(&workers->gate) / GATE_JOB + 1;
    atomic_store(&workers->gate, job * GATE_JOB | GATE_OPEN);
    if (!atomic_load(&workers->held) && atomic_load(&workers->asleep) > 0) {
        pthread_mutex_lock(&workers->mutex);
        pthread_cond_broadcast(&workers->begin);
        pthread_mutex_unlock(&workers->mutex);
    }
}

static bool is_empty(struct thread_pool *workers)
{
    return (atomic_load(&workers->gate) & GATE_IN) == 0;
}

/* Shuts the job to further helpers, and returns when none is in it. */
static void shut_job(struct thread_pool *workers)
{
    atomic_fetch_and(&workers->gate, ~(uint64_t)GATE_OPEN);
    for (uint32_t i = 0; i < workers->polls; i++) {
        if (is_empty(workers))
            return;
        pause_briefly();
    }
    pthread_mutex_lock(&workers->mutex);
    atomic_store(&workers->waiting, true);
    while (!is_empty(workers))
        pthread_cond_wait(&workers->done, &workers->mutex);
    atomic_store(&workers->waiting, false);
    pthread_mutex_unlock(&workers->mutex);
}

void thread_pool_hold(struct thread_pool *workers)
{
    if (!workers || workers->polls == 0)
        return;
    pthread_mutex_lock(&workers->mutex);
    atomic_store(&workers->held, true);
    if (atomic_load(&workers->asleep) > 0)
        pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->mutex);
}

void thread_pool_let_go(struct thread_pool *workers)
{
    if (workers)
        atomic_store(&workers->held, false);
}

bool thread_pool_is_held(const struct thread_pool *workers)
{
    return workers && atomic_load(&workers->held);
}

static uint32_t polls_for(uint32_t threads)
{
    cpu_set_t processors;
    if (sched_getaffinity(0, sizeof processors, &processors) != 0)
        return 0;
    return (uint32_t)CPU_COUNT(&processors) >= threads ? POLLS : 0;
}

struct thread_pool *thread_pool_create(uint32_t threads)
{
    if (threads < 1 || threads > THREAD_POOL_MAX) {
        errno = EINVAL;
        return NULL;
    }
    struct thread_pool *workers = aligned_alloc(_Alignof(struct thread_pool), sizeof *workers);
    if (!workers)
        return NULL;
    memset(workers, 0, sizeof *workers);
    workers->threads = 1;
    workers->polls = polls_for(threads);
    pthread_mutex_init(&workers->mutex, NULL);
    pthread_cond_init(&workers->begin, NULL);
    pthread_cond_init(&workers->done, NULL);
    while (workers->threads < threads) {
        int error = pthread_create(&workers->thread[workers->threads], NULL, helper, workers);
        if (error != 0) {
            thread_pool_destroy(workers);
            errno = error;
            return NULL;
        }
        workers->threads++;
    }
    return workers;
}

void thread_pool_destroy(struct thread_pool *workers)
{
    if (!workers)
        return;
    pthread_mutex_lock(&workers->mutex);
    atomic_store(&workers->stop, true);
    atomic_store(&workers->held, false);
    pthread_cond_broadcast(&workers->begin);
    pthread_mutex_unlock(&workers->mutex);
    for (uint32_t i = 1; i < workers->threads; i++)
        pthread_join(workers->thread[i], NULL);
    pthread_cond_destroy(&workers->begin);
    pthread_cond_destroy(&workers->done);
    pthread_mutex_destroy(&workers->mutex);
    free(workers);
}

uint32_t thread_pool_threads(const struct thread_pool *workers)
{
    return workers ? workers->threads : 1;
}

void thread_pool_run(struct thread_pool *workers, thread_pool_function *function, void *context,
                     uint32_t count, uint32_t grain)
{
    grain = grain > 0 ? grain : 1;
    if (!workers || workers->threads == 1 || count <= grain) {
        if (count > 0)
            function(context, 0, count, 0);
        return;
    }
    workers->function = function;
    workers->context = context;
    workers->count = count;
    workers->grain = grain;
    share_out(workers);
    open_job(workers);
    work(workers, 0);
    shut_job(workers);
}
