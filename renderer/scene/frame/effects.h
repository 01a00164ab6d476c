/* Recent events that are still visible: shots, explosions, splashes, wrecks and the dust of
 * collisions; and the trails of entities. They are taken from events and frames. The memory is
 * bounded: the effect that ends first is replaced. Pure. */
#ifndef JOLON_RENDERER_SCENE_FRAME_EFFECTS_H
#define JOLON_RENDERER_SCENE_FRAME_EFFECTS_H

#include "renderer/scene/frame/frame_view.h"
#include "renderer/scene/frame/motion_trails.h"

#include <stdint.h>

#define EFFECTS_MAX   1024u
#define EFFECT_LIFE_S 40.0 /* the longest life of any effect */

enum effect_type {
    EFFECT_FLASH,     /* a shot leaves its muzzle */
    EFFECT_EXPLOSION, /* a charge on a body or in the air */
    EFFECT_BURST,     /* a charge in the ground, which throws up soil */
    EFFECT_SPLASH,    /* a charge in water */
    EFFECT_HIT,       /* metal on metal: sparks */
    EFFECT_CRASH,     /* dust of a collision */
    EFFECT_WRECK,     /* a vehicle is destroyed: it bursts, and parts of it fly off */
    EFFECT_DECOY,     /* a flare, or a salvo of smoke grenades */
    EFFECT_TYPE_COUNT
};

struct effect {
    struct vec3 point;  /* [m, world] */
    double time_s;      /* of simulation */
    float size_m;       /* radius of the flash, the fireball, the splash, the dust */
    float direction[3]; /* of a shot: unit; of a wreck or a decoy: its velocity [m/s] */
    uint32_t type;      /* enum effect_type */
    uint32_t seed;
    uint16_t kind; /* of a wreck, or of who released a decoy */
};

struct effects {
    struct effect effect[EFFECTS_MAX];
    uint32_t count; /* used entries */
    struct motion_trails trails;
};

/* Takes committed events in their order, and what the frame itself shows. The frame is that of the
 * events or a later one. */
void effects_take(struct effects *effects, const struct frame_view *frame_view,
                  const struct event *events, uint32_t count);

/* Returns an entry for a new effect: a free one, or the one that ends first. */
struct effect *effects_allocate(struct effects *effects);

/* Returns how long an effect is visible [s]. */
double effects_life_s(enum effect_type type);

#endif
