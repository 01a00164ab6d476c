/* An outlet: something slow that is done with pictures, in a thread of its own behind a bounded
 * queue, so that drawing never waits for a disk or an encoder. */
#ifndef JOLON_RENDERER_OUTPUT_OUTPUT_QUEUE_H
#define JOLON_RENDERER_OUTPUT_OUTPUT_QUEUE_H

#include "ipc/segment/segment.h"
#include "renderer/output/picture.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#define OUTPUT_QUEUE_NICENESS                                                                      \
    15 /* behind the drawing: what comes late is dropped, not waited for */
#define OUTPUT_QUEUE_MAX 32u

struct output_queue_work {
    void *self;
    /* Takes one picture, in the outlet's thread. 0, or -1 with the reason: it takes no more then.
     */
    int (*take)(void *self, const struct picture *picture, struct error_text *error);
    uint32_t depth; /* pictures of one view that may wait, 1 or more */
    bool lossless;  /* a full queue is waited for: every picture counts, whenever it comes */
};

struct output_queue {
    struct output_queue_work work;
    pthread_t thread;
    pthread_mutex_t lock; /* of all below */
    pthread_cond_t added, removed;
    struct picture *waiting[OUTPUT_QUEUE_MAX]; /* the oldest first */
    uint32_t count;
    bool running, ending, failed;
    uint64_t taken, dropped;
    struct error_text error; /* when it failed */
};

/* Returns when the thread runs; signals are not for it. 0, or -1 with errno. */
int output_queue_start(struct output_queue *queue, const struct output_queue_work *work);

/* Hands it a picture, which the caller goes on holding. A view of which enough waits keeps the
 * newest and loses the one before, which is counted: so order holds, and the last always comes. A
 * patient outlet waits for room instead. */
void output_queue_put(struct output_queue *queue, struct picture *picture);

/* Has it failed? Then the reason is copied. */
bool output_queue_failed(struct output_queue *queue, struct error_text *error);

/* Waits until what waits is done, and ends the thread; taken and dropped stay. 0, or -1 with the
 * reason when it had failed. */
int output_queue_end(struct output_queue *queue, struct error_text *error);

#endif
