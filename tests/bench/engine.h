/* The interface of a collision engine to the benchmark, for C and C++. */
#ifndef JOLON_TESTS_BENCH_ENGINE_H
#define JOLON_TESTS_BENCH_ENGINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ENGINE_RADIUS_M 3.0 /* of every moving sphere */
#define ENGINE_DT_S     (1.0 / 60.0)
#define ENGINE_FIXED    0x80000000u /* flag of b in a touch: the other bits index a fixed sphere */

struct engine_body {
    double x, z, vx, vz; /* [m, m/s], all at height 0 */
};

struct engine_sphere {
    double x, z, radius_m;
};

struct engine_scene {
    struct engine_body *body;
    uint32_t bodies;
    struct engine_sphere *fixed;
    uint32_t fixed_count;
};

struct engine_touch {
    uint32_t a, b;
};

struct engine_touches {
    struct engine_touch *touch;
    size_t count, capacity;
};

/* Adds a touch. Ends the process when memory is out. */
void engine_touches_add(struct engine_touches *touches, uint32_t a, uint32_t b);

/* Returns true if body a touches body b, or the fixed sphere that b names. */
static inline bool engine_touching(const struct engine_scene *scene, uint32_t a, uint32_t b)
{
    const struct engine_body *p = &scene->body[a];
    double x, z, reach;
    if (b & ENGINE_FIXED) {
        const struct engine_sphere *ball = &scene->fixed[b & ~ENGINE_FIXED];
        x = ball->x - p->x;
        z = ball->z - p->z;
        reach = ENGINE_RADIUS_M + ball->radius_m;
    } else {
        x = scene->body[b].x - p->x;
        z = scene->body[b].z - p->z;
        reach = 2.0 * ENGINE_RADIUS_M;
    }
    return x * x + z * z <= reach * reach;
}

struct engine {
    const char *name, *variant; /* variant: which data structure of the engine, or "" */
    uint32_t threads;           /* the most that the engine can use */
    /* Makes a world with the scene's fixed spheres and bodies. The scene outlives it. */
    void *(*open)(const struct engine_scene *scene, uint32_t threads);
    void (*close)(void *self);
    /* Gives the engine the positions of the bodies. Not measured. */
    void (*place)(void *self);
    /* Finds all touches now or within the coming step. This is measured. */
    void (*detect)(void *self, struct engine_touches *touches);
};

extern const struct engine engine_jolon, engine_ode, engine_bullet;

#ifdef __cplusplus
}
#endif

#endif
