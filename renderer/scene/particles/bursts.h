/* Particles of events: shots, explosions, splashes, sparks. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_BURSTS_H
#define JOLON_RENDERER_SCENE_PARTICLES_BURSTS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/frame/effects.h"

/* Adds the particles of an effect at this age. */
void bursts_effect(struct draw_list *list, const struct frame_view *frame_view,
                   const struct effect *effect, double age_s);

#endif
