/* Fixed objects made of polygons, whole and damaged. */
#ifndef JOLON_RENDERER_SCENE_FIXED_OBJECTS_H
#define JOLON_RENDERER_SCENE_FIXED_OBJECTS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"

/* Adds the fixed objects in view to the bodies, and felled trees beside their stumps. */
void fixed_objects_add(struct draw_list *list, const struct static_scene *static_scene,
                       const struct frame_view *frame_view);

#endif
