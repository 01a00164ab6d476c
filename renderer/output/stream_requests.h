/* Requested pictures, for the drawing thread. */
#ifndef JOLON_RENDERER_OUTPUT_STREAM_REQUESTS_H
#define JOLON_RENDERER_OUTPUT_STREAM_REQUESTS_H

#include "renderer/output/picture.h"
#include "renderer/output/picture_requests.h"

#include <stdbool.h>
#include <stdint.h>

struct stream;

struct stream_request {
    struct picture_requests_key key;
    uint64_t generation; /* of its row; 0: there is no request */
    bool waiting;        /* a client waits for it now */
    bool again;          /* draw it even if the last picture is still up to date */
};

/* Fills requests[PICTURE_REQUESTS_MAX] with the rows that clients have requested lately. Returns
 * the number of rows for which a client waits. */
uint32_t stream_requests_read(struct stream *stream, struct stream_request *requests);

/* Answers a row's request: with a picture, which the caller continues to hold, or with NULL: there
 * is no such vehicle. A request that has changed since (another generation) gets no answer. */
void stream_requests_answer(struct stream *stream, uint32_t row, uint64_t generation,
                            struct picture *picture);

/* Sleeps until the time (CLOCK_MONOTONIC), or until a client requests a picture. */
void stream_requests_wait(struct stream *stream, uint64_t until_ns);

#endif
