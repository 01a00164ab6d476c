/* Parts that fly off a destroyed vehicle. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_DEBRIS_H
#define JOLON_RENDERER_SCENE_PARTICLES_DEBRIS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"
#include "renderer/scene/frame/effects.h"

/* Adds the parts in view to the bodies: those in flight and those that lie on the ground. */
void debris_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view, const struct effects *effects);

#endif
