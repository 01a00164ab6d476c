/* Smoke and fire of wrecks and damaged vehicles. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_SMOKE_H
#define JOLON_RENDERER_SCENE_PARTICLES_SMOKE_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/frame/motion_trails.h"
#include "world/entity/kind.h"

/* Adds the fire and smoke of a wreck, or the smoke of a damaged vehicle. */
void smoke_entity(struct draw_list *list, const struct frame_view *frame_view,
                  const struct motion_trail *trail, uint32_t slot, const struct kind *kind);

#endif
