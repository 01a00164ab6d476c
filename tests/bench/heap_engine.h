/* The interface of a physics engine to the benchmark of heaps, for C and C++. Axes of the world: x
 * east, y up, z south. One thread calls it. */
#ifndef JOLON_TESTS_BENCH_HEAP_ENGINE_H
#define JOLON_TESTS_BENCH_HEAP_ENGINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HEAP_DT_S        (1.0 / 60.0)
#define HEAP_SPEED_MPS   10.0 /* inwards, at the start */
#define HEAP_FRICTION    0.6  /* of tanks with each other and with the ground */
#define HEAP_GRAVITY     9.81 /* [m/s2] */
#define HEAP_BOX_CORNERS 8

struct view;

/* Where a tank starts. The heap's middle is at 0, 0. */
struct heap_place {
    double x, z;                 /* [m] */
    double forward_x, forward_z; /* unit: inwards */
};

/* What every engine is given. A box of its length, width and height stands for a
 * tank in the other engines. */
struct heap_tanks {
    struct heap_place *place;
    uint32_t count;
    double mass_kg, acceleration_mps2;
    double half_m[3];  /* of the box: forward, up, right; it stands on the ground */
    struct view *view; /* the world of Jolon */
};

/* Returns the force that drives a tank of the other engines inwards [N]. What the friction of the
 * ground leaves of the force gives the tank its acceleration. */
static inline double heap_engine_push(const struct heap_tanks *tanks)
{
    return tanks->mass_kg * (tanks->acceleration_mps2 + HEAP_FRICTION * HEAP_GRAVITY);
}

/* A tank at the end of a frame. */
struct heap_body {
    double at[3];                       /* [m] of the origin of its hulls */
    double forward[3], up[3], right[3]; /* unit */
    double speed_mps;
};

struct heap_pair {
    uint32_t a, b;
};

/* What is seen of an engine at the end of a frame. */
struct heap_look {
    struct heap_body *body; /* [tanks] */
    struct heap_pair *pair; /* tanks in contact */
    size_t pairs, capacity;
    uint64_t told;     /* collisions that the engine has told so far, if it tells them */
    uint64_t checksum; /* of the whole state, by an engine that has one; else 0 */
};

/* Adds a pair in contact. Ends the process when memory is out. */
void heap_look_add(struct heap_look *look, uint32_t a, uint32_t b);

struct heap_engine {
    const char *name;
    uint32_t threads; /* the most that the engine can use */
    bool boxes;       /* its tanks are boxes, and not the hulls of the model */
    bool tells;       /* it tells collisions itself; otherwise every new pair is a collision */
    /* Makes a world with the tanks at their places. The tanks outlive it. */
    void *(*open)(const struct heap_tanks *tanks, uint32_t threads);
    void (*close)(void *self);
    /* Lets the tanks drive inwards, or not, and moves them if the engine does so apart from
     * collisions. Not measured. */
    void (*drive)(void *self, bool push);
    /* Collides. This is measured. */
    void (*step)(void *self);
    void (*look)(void *self, struct heap_look *look);
};

extern const struct heap_engine heap_jolon, heap_ode, heap_bullet;

#ifdef __cplusplus
}
#endif

#endif
