/* Which vehicle the camera follows. Pure. */
#ifndef JOLON_RENDERER_SCENE_CAMERA_FOLLOW_H
#define JOLON_RENDERER_SCENE_CAMERA_FOLLOW_H

#include "renderer/scene/frame/effects.h"
#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stdint.h>

#define FOLLOW_KEEP_S  12.0 /* a vehicle that was picked is kept so long ... */
#define FOLLOW_WRECK_S 5.0  /* ... and as a wreck so long, to see it burn */

struct follow {
    uint32_t id;    /* 0: none yet */
    double since_s; /* of simulation */
};

/* Slot of the vehicle to follow: that of first_id (0: none) until it has been a wreck for
 * FOLLOW_WRECK_S, or as long as it exists if only is set; then the one being followed, while its
 * time is not over and it is no older wreck either; else the liveliest: on land, moving, in
 * company, near what just happened. The same moment and history give the same choice. SLOT_NONE
 * when there is no vehicle. */
uint32_t follow_choose(struct follow *follow, const struct frame_view *frame_view,
                       const struct effects *effects, uint32_t first_id, bool only);

#endif
