/* Trees and bushes of the world, and grass near the eye. */
#ifndef JOLON_RENDERER_SCENE_PLANTS_PLANTS_H
#define JOLON_RENDERER_SCENE_PLANTS_PLANTS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"

/* Adds the plants in view to the draw list. */
void plants_add(struct draw_list *list, const struct static_scene *static_scene,
                const struct frame_view *frame_view);

#endif
