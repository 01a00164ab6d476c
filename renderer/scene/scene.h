/* Fills the draw list of one picture from a frame of the world and a camera. Pure: it needs no
 * graphics library. */
#ifndef JOLON_RENDERER_SCENE_SCENE_H
#define JOLON_RENDERER_SCENE_SCENE_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"
#include "renderer/scene/frame/effects.h"

/* Allocates the lists. Returns 0, or -1 with errno ENOMEM. */
int scene_init(struct draw_list *list);
void scene_free(struct draw_list *list);

/* Fills all lists with what the camera sees. The camera is copied into the draw list. */
void scene_build(struct draw_list *list, const struct camera *camera,
                 const struct static_scene *static_scene, const struct frame_view *frame_view,
                 const struct effects *effects);

#endif
