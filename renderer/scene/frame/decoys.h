/* Notes which vehicles release decoys, because a homing missile comes near them, or because their
 * crews hide them in smoke. */
#ifndef JOLON_RENDERER_SCENE_FRAME_DECOYS_H
#define JOLON_RENDERER_SCENE_FRAME_DECOYS_H

#include "renderer/scene/frame/effects.h"

/* Adds the decoys of the frame. A vehicle releases one every DECOYS_INTERVAL_S while a missile
 * comes near, and one every DECOYS_SCREEN_S while its smoke hides it; calling this twice with one
 * frame adds nothing. */
#define DECOYS_INTERVAL_S 0.3
#define DECOYS_SCREEN_S   3.0
void decoys_take(struct effects *effects, const struct frame_view *frame_view);

#endif
