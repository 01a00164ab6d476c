/* All particles of a picture except the discs of rotors. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_PARTICLE_EMITTERS_H
#define JOLON_RENDERER_SCENE_PARTICLES_PARTICLE_EMITTERS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/frame/effects.h"

/* Adds the particles of all entities and effects, and sorts the whole list: farthest first. */
void particle_emitters_add(struct draw_list *list, const struct frame_view *frame_view,
                           const struct effects *effects);

#endif
