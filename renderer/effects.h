/* What happened lately and still shows: flashes, explosions, dust of collisions, and the dents that
 * they left. Taken from events; a bounded memory, the oldest gives way. Pure. */
#ifndef JOLON_RENDERER_EFFECTS_H
#define JOLON_RENDERER_EFFECTS_H

#include "renderer/moment.h"

#include <stdint.h>

#define EFFECTS_MAX    512u
#define EFFECT_LIFE_S  14.0 /* the longest that any of them shows */
#define DENTED_MAX     256u /* bodies whose dents are remembered */
#define DENTS_PER_BODY 4u

enum effect_type { EFFECT_FLASH, EFFECT_EXPLOSION, EFFECT_SPLASH, EFFECT_CRASH };

struct effect {
    struct vec3 point; /* [m, world] */
    double time_s;     /* of simulation */
    float size_m;      /* radius of the fireball, the splash, the dust */
    uint32_t type;     /* enum effect_type */
    uint32_t seed;
};

/* A dent: the surface within radius of the point is pushed in towards the body's middle. */
struct bruise {
    float x, y, z; /* [m, body axes] */
    float depth_m;
};

struct dented {
    uint32_t id; /* of the entity, 0: free */
    uint32_t count;
    struct bruise dents[DENTS_PER_BODY];
};

struct effects {
    struct effect ring[EFFECTS_MAX];
    uint64_t taken; /* effects ever; the ring holds the last of them */
    struct dented bodies[DENTED_MAX];
    uint64_t dented; /* bodies ever */
};

/* Takes committed events in their order. moment is a frame at or after theirs. */
void effects_take(struct effects *effects, const struct moment *moment, const struct event *events,
                  uint32_t count);

/* The effects held, 0 .. count - 1, in no order of importance. */
uint32_t effects_count(const struct effects *effects);

/* Dents of an entity: those of its collisions, or, when it was damaged before this process looked,
 * some that follow from its id. At most DENTS_PER_BODY; how many. */
uint32_t effects_dents(const struct effects *effects, const struct kind *kind, uint32_t id,
                       enum damage damage, struct bruise dents[DENTS_PER_BODY]);

#endif
