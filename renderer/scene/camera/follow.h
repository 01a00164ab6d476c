/* Selects the vehicle that the camera follows. Pure. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_FOLLOW_H
#define JOLON_RENDERER_SCENE_CAMERA_FOLLOW_H

#include "renderer/scene/frame/effects.h"
#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

#define FOLLOW_KEEP_S  12.0 /* a selected vehicle is followed this long ... */
#define FOLLOW_WRECK_S 5.0  /* ... and as a wreck this long, to see it burn */
struct follow {
    uint32_t id;    /* 0: none yet */
    double since_s; /* of simulation */
};

/* Returns the slot of the vehicle to follow, or SLOT_NONE if there is none. first_id (0: none) is
 * preferred until it has been a wreck for FOLLOW_WRECK_S, or as long as it exists if only is set. *
 * * Next comes the vehicle followed so far, until FOLLOW_KEEP_S have passed or it is an old wreck.
 * Otherwise the liveliest is selected: one that fires (no howitzer) or is fired at, attacks, has
 * its target near, is on land, moves, and has others and recent effects in its picture. The vehicle
 * followed so far is kept unless another one is much livelier. The same frames and history give the
 * same selection. */
uint32_t follow_choose(struct follow *follow, const struct frame_view *frame_view,
                       const struct effects *effects, uint32_t first_id, bool only);

/* Where something happens around a vehicle. */
struct follow_sight {
    double heading_rad;
    double far_m; /* 0: nothing happens */
};

/* Returns where the target of the vehicle in a slot is, or else where explosions and wrecks are, or
 * else its own heading. */
struct follow_sight follow_look(const struct frame_view *frame_view, const struct effects *effects,
                                uint32_t slot);

#endif
