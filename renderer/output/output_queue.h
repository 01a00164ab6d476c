/* An output queue: slow work on pictures, in a thread of its own behind a bounded queue, so that
 * drawing does not wait for a disk or an encoder. */
#ifndef JOLON_RENDERER_OUTPUT_OUTPUT_QUEUE_H
#define JOLON_RENDERER_OUTPUT_OUTPUT_QUEUE_H

#include "ipc/segment/segment.h"
#include "renderer/output/picture.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#define OUTPUT_QUEUE_NICENESS                                                                      \
    15 /* below the drawing thread: it drops pictures, and does not wait */
#define OUTPUT_QUEUE_MAX 32u

struct output_queue_work {
    void *self;
    /* Processes one picture, in the queue's thread. Returns 0, or -1 with the reason, after which
     * it is not called again. */
    int (*take)(void *self, const struct picture *picture, struct error_text *error);
    uint32_t depth; /* pictures of one view that may wait, 1 or more */
    bool lossless;  /* output_queue_put() waits for room, and drops no picture */
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

/* Starts the thread, which takes no signals but SIGSYS, and waits until it runs. Returns 0, or -1
 * with errno. */
int output_queue_start(struct output_queue *queue, const struct output_queue_work *work);

/* Queues a picture, and adds a reference to it. When enough pictures of its view wait, it replaces
 * the newest of them, which counts as dropped. So the order is kept, and a view's last picture is
 * always processed. A lossless queue waits for room instead. */
void output_queue_put(struct output_queue *queue, struct picture *picture);

/* Returns true if the work has failed, with the reason. */
bool output_queue_failed(struct output_queue *queue, struct error_text *error);

/* Processes the pictures that wait and ends the thread. The counters remain. Returns 0, or -1 with
 * the reason if the work has failed. */
int output_queue_end(struct output_queue *queue, struct error_text *error);

#endif
