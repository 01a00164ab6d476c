/* A picture for the outputs. Several threads share it by counted references; the last release
 * returns it to its pool. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_H
#define JOLON_RENDERER_OUTPUT_PICTURE_H

#include "renderer/image/image.h"

#include <pthread.h>
#include <stdint.h>

#define PICTURE_VIEW_BYTES    32
#define PICTURE_COMMENT_BYTES 512
#define PICTURE_POOL_MAX      32u /* of a pool, made when needed; 4 MB each at 1280x720 */

struct picture_pool {
    pthread_mutex_t lock;
    struct picture *spare; /* under lock, as the count */
    uint32_t count;        /* of pictures, in use or spare */
};

struct picture {
    struct image image;
    char view[PICTURE_VIEW_BYTES];       /* "chase", "map", ... */
    char comment[PICTURE_COMMENT_BYTES]; /* for the PNG file */
    uint64_t frame;
    double time_s; /* of the simulation */
    struct picture_pool *pool;
    struct picture *next; /* in the pool */
    uint32_t references;  /* under the pool's lock */
};

void picture_pool_init(struct picture_pool *pool);
/* Every picture must have been released. */
void picture_pool_free(struct picture_pool *pool);

/* Makes a picture with one reference. It takes the image's pixels and gives it others of the same
 * size and undefined content. Returns NULL and leaves the image alone when there is no memory, or
 * PICTURE_POOL_MAX pictures are in use. */
struct picture *picture_make(struct picture_pool *pool, struct image *image, const char *view,
                             const char *comment);

/* Adds a reference. */
struct picture *picture_hold(struct picture *picture);
/* Drops a reference. NULL is allowed. */
void picture_release(struct picture *picture);

#endif
