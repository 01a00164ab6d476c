/* A picture on its way out. It goes to several outlets, each with a thread of its own, and is not
 * copied: they hold it together, and the last that lets go returns its pixels to the pool. */
#ifndef JOLON_RENDERER_OUTPUT_PICTURE_H
#define JOLON_RENDERER_OUTPUT_PICTURE_H

#include "renderer/image/image.h"

#include <pthread.h>
#include <stdint.h>

#define PICTURE_VIEW_BYTES    32
#define PICTURE_COMMENT_BYTES 512
#define PICTURE_POOL_MAX      32u /* of a pool; 1280x720 takes 4 MB each, only when they are needed */

struct picture_pool {
    pthread_mutex_t lock;
    struct picture *spare; /* under lock, as the count */
    uint32_t count;        /* of pictures that there are, spare or not */
};

struct picture {
    struct image image;
    char view[PICTURE_VIEW_BYTES];       /* "chase", "map", ... */
    char comment[PICTURE_COMMENT_BYTES]; /* about it, for who reads files */
    uint64_t frame;
    double time_s; /* of the simulation */
    struct picture_pool *pool;
    struct picture *next; /* in the pool */
    uint32_t references;  /* under the pool's lock */
};

void picture_pool_init(struct picture_pool *pool);
/* When every picture is back. */
void picture_pool_free(struct picture_pool *pool);

/* Makes a picture of what was drawn, held once. It takes the image's pixels and gives it others of
 * the same size for them, whose content is anything. NULL, and the image as it was, when there is
 * no memory or PICTURE_POOL_MAX are under way. */
struct picture *picture_make(struct picture_pool *pool, struct image *image, const char *view,
                             const char *comment);

struct picture *picture_hold(struct picture *picture);
/* NULL is nothing. */
void picture_release(struct picture *picture);

#endif
