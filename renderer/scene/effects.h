/* What happened lately and still shows: flashes, explosions, dust of collisions. Taken from events;
 * a bounded memory, the oldest gives way. Pure. */
#ifndef JOLON_RENDERER_EFFECTS_H
#define JOLON_RENDERER_EFFECTS_H

#include "renderer/scene/moment.h"

#include <stdint.h>

#define EFFECTS_MAX   512u
#define EFFECT_LIFE_S 14.0 /* the longest that any of them shows */

enum effect_type { EFFECT_FLASH, EFFECT_EXPLOSION, EFFECT_SPLASH, EFFECT_CRASH };

struct effect {
    struct vec3 point; /* [m, world] */
    double time_s;     /* of simulation */
    float size_m;      /* radius of the fireball, the splash, the dust */
    uint32_t type;     /* enum effect_type */
    uint32_t seed;
};

struct effects {
    struct effect ring[EFFECTS_MAX];
    uint64_t taken; /* effects ever; the ring holds the last of them */
};

/* Takes committed events in their order. moment is a frame at or after theirs. */
void effects_take(struct effects *effects, const struct moment *moment, const struct event *events,
                  uint32_t count);

/* The effects held, 0 .. count - 1, in no order of importance. */
uint32_t effects_count(const struct effects *effects);

#endif
