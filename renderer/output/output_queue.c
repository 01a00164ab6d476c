/* The queue and its thread. */
#include "renderer/output/output_queue.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>

/* The oldest picture that waits, now the caller's; NULL when the end is asked for and none waits.
 */
static struct picture *next(struct output_queue *outlet)
{
    while (outlet->count == 0 && !outlet->ending)
        pthread_cond_wait(&outlet->come, &outlet->lock);
    if (outlet->count == 0)
        return NULL;
    struct picture *picture = outlet->waiting[0];
    memmove(outlet->waiting, outlet->waiting + 1, --outlet->count * sizeof outlet->waiting[0]);
    pthread_cond_signal(&outlet->gone);
    return picture;
}

static void *work(void *argument)
{
    struct output_queue *outlet = argument;
    struct picture *picture;
    setpriority(PRIO_PROCESS, 0,
                OUTPUT_QUEUE_NICENESS); /* this thread's alone; no loss where it fails */
    pthread_mutex_lock(&outlet->lock);
    outlet->running = true;
    pthread_cond_signal(&outlet->gone);
    while ((picture = next(outlet)) != NULL) {
        bool wanted = !outlet->failed;
        struct reason reason;
        pthread_mutex_unlock(&outlet->lock);
        bool done = wanted && outlet->work.take(outlet->work.self, picture, &reason) == 0;
        picture_release(picture);
        pthread_mutex_lock(&outlet->lock);
        if (done)
            outlet->taken++;
        if (wanted && !done) {
            outlet->failed = true;
            outlet->reason = reason;
        }
    }
    pthread_mutex_unlock(&outlet->lock);
    return NULL;
}

static void forget(struct output_queue *outlet)
{
    pthread_cond_destroy(&outlet->come);
    pthread_cond_destroy(&outlet->gone);
    pthread_mutex_destroy(&outlet->lock);
}

int output_queue_start(struct output_queue *outlet, const struct output_queue_work *job)
{
    sigset_t all, before;
    CHECK(job->depth > 0 && job->depth <= OUTPUT_QUEUE_MAX);
    *outlet = (struct output_queue){.work = *job,
                                    .lock = PTHREAD_MUTEX_INITIALIZER,
                                    .come = PTHREAD_COND_INITIALIZER,
                                    .gone = PTHREAD_COND_INITIALIZER};
    sigfillset(&all);
    sigdelset(&all, SIGSYS); /* what the sandbox forbids is to be told */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&outlet->thread, NULL, work, outlet);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (error != 0) {
        forget(outlet);
        errno = error;
        return -1;
    }
    pthread_mutex_lock(&outlet->lock);
    while (!outlet->running)
        pthread_cond_wait(&outlet->gone, &outlet->lock);
    pthread_mutex_unlock(&outlet->lock);
    return 0;
}

/* Where the newest that waits of this view is, when there may not be more of it; else the end. */
static uint32_t place_for(const struct output_queue *outlet, const char *view)
{
    uint32_t of_view = 0, newest = outlet->count;
    for (uint32_t i = 0; i < outlet->count; i++) {
        if (strcmp(outlet->waiting[i]->view, view) == 0) {
            of_view++;
            newest = i;
        }
    }
    if (of_view >= outlet->work.depth)
        return newest;
    return outlet->count < OUTPUT_QUEUE_MAX ? outlet->count : OUTPUT_QUEUE_MAX - 1;
}

void output_queue_put(struct output_queue *outlet, struct picture *picture)
{
    pthread_mutex_lock(&outlet->lock);
    while (outlet->work.patient && outlet->count >= outlet->work.depth)
        pthread_cond_wait(&outlet->gone, &outlet->lock);
    uint32_t place = place_for(outlet, picture->view);
    if (place < outlet->count) {
        picture_release(outlet->waiting[place]);
        outlet->dropped++;
    } else {
        outlet->count++;
    }
    outlet->waiting[place] = picture_hold(picture);
    pthread_cond_signal(&outlet->come);
    pthread_mutex_unlock(&outlet->lock);
}

bool output_queue_failed(struct output_queue *outlet, struct reason *reason)
{
    pthread_mutex_lock(&outlet->lock);
    bool failed = outlet->failed;
    if (failed)
        *reason = outlet->reason;
    pthread_mutex_unlock(&outlet->lock);
    return failed;
}

int output_queue_end(struct output_queue *outlet, struct reason *reason)
{
    pthread_mutex_lock(&outlet->lock);
    outlet->ending = true;
    pthread_cond_signal(&outlet->come);
    pthread_mutex_unlock(&outlet->lock);
    pthread_join(outlet->thread, NULL);
    forget(outlet);
    if (outlet->failed)
        *reason = outlet->reason;
    return outlet->failed ? -1 : 0;
}
