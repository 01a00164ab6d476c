/* Flares and the smoke of grenades. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_DECOY_PARTICLES_H
#define JOLON_RENDERER_SCENE_PARTICLES_DECOY_PARTICLES_H

#include "renderer/scene/frame/effects.h"
#include "renderer/scene/particles/particles.h"

/* Adds the particles of an EFFECT_DECOY at its age [s]. */
void decoy_particles_add(struct draw_list *list, const struct frame_view *frame_view,
                         const struct effect *effect, double age);

#endif
