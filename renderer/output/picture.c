/* The pool of pictures. */
#include "renderer/output/picture.h"
#include "world/runtime/check.h"

#include <stdio.h>
#include <stdlib.h>

void picture_pool_init(struct picture_pool *pool)
{
    *pool = (struct picture_pool){.lock = PTHREAD_MUTEX_INITIALIZER};
}

static void destroy(struct picture *picture)
{
    image_free(&picture->image);
    free(picture);
}

void picture_pool_free(struct picture_pool *pool)
{
    while (pool->spare != NULL) {
        struct picture *picture = pool->spare;
        pool->spare = picture->next;
        pool->count--;
        destroy(picture);
    }
    CHECK(pool->count == 0);
    pthread_mutex_destroy(&pool->lock);
}

/* Returns a spare picture of that size, NULL for none. Frees spare pictures of other sizes, which
 * are seldom needed again. Under the lock. */
static struct picture *take_spare(struct picture_pool *pool, const struct image *like)
{
    while (pool->spare != NULL) {
        struct picture *picture = pool->spare;
        pool->spare = picture->next;
        if (picture->image.width == like->width && picture->image.height == like->height)
            return picture;
        pool->count--;
        destroy(picture);
    }
    return NULL;
}

static struct picture *make_new(const struct image *like)
{
    struct picture *picture = calloc(1, sizeof *picture);
    if (picture != NULL && image_init(&picture->image, like->width, like->height) != 0) {
        free(picture);
        picture = NULL;
    }
    return picture;
}

struct picture *picture_make(struct picture_pool *pool, struct image *image, const char *view,
                             const char *comment)
{
    pthread_mutex_lock(&pool->lock);
    struct picture *picture = take_spare(pool, image);
    if (picture == NULL && pool->count < PICTURE_POOL_MAX && (picture = make_new(image)) != NULL)
        pool->count++;
    pthread_mutex_unlock(&pool->lock);
    if (picture == NULL)
        return NULL;
    struct image drawn = *image;
    *image = picture->image;
    picture->image = drawn;
    picture->pool = pool;
    picture->references = 1;
    snprintf(picture->view, sizeof picture->view, "%s", view);
    snprintf(picture->comment, sizeof picture->comment, "%s", comment);
    return picture;
}

struct picture *picture_hold(struct picture *picture)
{
    pthread_mutex_lock(&picture->pool->lock);
    picture->references++;
    pthread_mutex_unlock(&picture->pool->lock);
    return picture;
}

void picture_release(struct picture *picture)
{
    if (picture == NULL)
        return;
    struct picture_pool *pool = picture->pool;
    pthread_mutex_lock(&pool->lock);
    if (--picture->references == 0) {
        picture->next = pool->spare;
        pool->spare = picture;
    }
    pthread_mutex_unlock(&pool->lock);
}
