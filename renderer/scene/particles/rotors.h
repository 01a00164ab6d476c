/* Discs of turning rotors. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_ROTORS_H
#define JOLON_RENDERER_SCENE_PARTICLES_ROTORS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"

/* Adds a particle for each rotor in view of an active aircraft. */
void rotors_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view);

#endif
