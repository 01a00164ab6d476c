/* What happened lately and still shows: shots, explosions, splashes, wrecks and the dust of
 * collisions, and where things lately were. Taken from events and from moments; a bounded memory,
 * in which what is over first gives way. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_EFFECTS_H
#define JOLON_RENDERER_SCENE_FRAME_EFFECTS_H

#include "renderer/scene/frame/frame_view.h"
#include "renderer/scene/frame/motion_trails.h"

#include <stdint.h>

#define EFFECTS_MAX   1024u
#define EFFECT_LIFE_S 40.0 /* the longest that any of them shows */

enum effect_type {
    EFFECT_FLASH,     /* a shot leaves its muzzle */
    EFFECT_EXPLOSION, /* a charge on a body or in the air */
    EFFECT_BURST,     /* ... in the ground, which it throws up */
    EFFECT_SPLASH,    /* ... in water */
    EFFECT_HIT,       /* metal on metal: sparks */
    EFFECT_CRASH,     /* dust of a collision */
    EFFECT_WRECK,     /* a vehicle is destroyed: it bursts, and parts of it fly */
    EFFECT_TYPE_COUNT
};

struct effect {
    struct vec3 point;  /* [m, world] */
    double time_s;      /* of simulation */
    float size_m;       /* radius of the flash, the fireball, the splash, the dust */
    float direction[3]; /* unit: where the shot went; the wreck's velocity [m/s] */
    uint32_t type;      /* enum effect_type */
    uint32_t seed;
    uint16_t kind; /* of the wreck */
};

struct effects {
    struct effect effect[EFFECTS_MAX];
    uint32_t count; /* of them */
    struct motion_trails trails;
};

/* Takes committed events in their order, and what can be seen of the moment itself. moment is a
 * frame at or after theirs. */
void effects_take(struct effects *effects, const struct frame_view *frame_view,
                  const struct event *events, uint32_t count);

/* How long it shows [s]. */
double effects_life_s(enum effect_type type);

#endif
