/* The queue and its thread. */
#include "renderer/output/output_queue.h"

#include "ipc/process/process.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <signal.h>
#include <string.h>

/* Waits for a picture. Returns the oldest with its reference; NULL at the end. Under the lock. */
static struct picture *next(struct output_queue *queue)
{
    while (queue->count == 0 && !queue->ending)
        pthread_cond_wait(&queue->added, &queue->lock);
    if (queue->count == 0)
        return NULL;
    struct picture *picture = queue->waiting[0];
    memmove(queue->waiting, queue->waiting + 1, --queue->count * sizeof queue->waiting[0]);
    pthread_cond_signal(&queue->removed);
    return picture;
}

static void *work(void *argument)
{
    struct output_queue *queue = argument;
    struct picture *picture;
    process_lower_priority(OUTPUT_QUEUE_NICENESS); /* this thread's alone; no loss where it fails */
    pthread_mutex_lock(&queue->lock);
    queue->running = true;
    pthread_cond_signal(&queue->removed);
    while ((picture = next(queue)) != NULL) {
        bool healthy = !queue->failed;
        struct error_text error;
        pthread_mutex_unlock(&queue->lock);
        bool done = healthy && queue->work.take(queue->work.self, picture, &error) == 0;
        picture_release(picture);
        pthread_mutex_lock(&queue->lock);
        if (done)
            queue->taken++;
        if (healthy && !done) {
            queue->failed = true;
            queue->error = error;
        }
    }
    pthread_mutex_unlock(&queue->lock);
    return NULL;
}

static void forget(struct output_queue *queue)
{
    pthread_cond_destroy(&queue->added);
    pthread_cond_destroy(&queue->removed);
    pthread_mutex_destroy(&queue->lock);
}

int output_queue_start(struct output_queue *queue, const struct output_queue_work *job)
{
    sigset_t all, before;
    CHECK(job->depth > 0 && job->depth <= OUTPUT_QUEUE_MAX);
    *queue = (struct output_queue){.work = *job,
                                   .lock = PTHREAD_MUTEX_INITIALIZER,
                                   .added = PTHREAD_COND_INITIALIZER,
                                   .removed = PTHREAD_COND_INITIALIZER};
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int code = pthread_create(&queue->thread, NULL, work, queue);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (code != 0) {
        forget(queue);
        errno = code;
        return -1;
    }
    pthread_mutex_lock(&queue->lock);
    while (!queue->running)
        pthread_cond_wait(&queue->removed, &queue->lock);
    pthread_mutex_unlock(&queue->lock);
    return 0;
}

/* Returns the place for a picture: that of its view's newest if enough wait, else the end. */
static uint32_t place_for(const struct output_queue *queue, const char *view)
{
    uint32_t of_view = 0, newest = queue->count;
    for (uint32_t i = 0; i < queue->count; i++) {
        if (strcmp(queue->waiting[i]->view, view) == 0) {
            of_view++;
            newest = i;
        }
    }
    if (of_view >= queue->work.depth)
        return newest;
    return queue->count < OUTPUT_QUEUE_MAX ? queue->count : OUTPUT_QUEUE_MAX - 1;
}

void output_queue_put(struct output_queue *queue, struct picture *picture)
{
    pthread_mutex_lock(&queue->lock);
    while (queue->work.lossless && queue->count >= queue->work.depth)
        pthread_cond_wait(&queue->removed, &queue->lock);
    uint32_t place = place_for(queue, picture->view);
    if (place < queue->count) {
        picture_release(queue->waiting[place]);
        queue->dropped++;
    } else {
        queue->count++;
    }
    queue->waiting[place] = picture_hold(picture);
    pthread_cond_signal(&queue->added);
    pthread_mutex_unlock(&queue->lock);
}

bool output_queue_failed(struct output_queue *queue, struct error_text *error)
{
    pthread_mutex_lock(&queue->lock);
    bool failed = queue->failed;
    if (failed)
        *error = queue->error;
    pthread_mutex_unlock(&queue->lock);
    return failed;
}

int output_queue_end(struct output_queue *queue, struct error_text *error)
{
    pthread_mutex_lock(&queue->lock);
    queue->ending = true;
    pthread_cond_signal(&queue->added);
    pthread_mutex_unlock(&queue->lock);
    pthread_join(queue->thread, NULL);
    forget(queue);
    if (queue->failed)
        *error = queue->error;
    return queue->failed ? -1 : 0;
}
