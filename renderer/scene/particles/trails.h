/* What moving entities leave behind: dust, wakes, missile smoke. */
#ifndef JOLON_RENDERER_SCENE_PARTICLES_TRAILS_H
#define JOLON_RENDERER_SCENE_PARTICLES_TRAILS_H

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/frame/motion_trails.h"
#include "world/entity/kind.h"

/* Adds what a moving entity leaves behind and what its rotor raises. */
void trails_entity(struct draw_list *list, const struct frame_view *frame_view,
                   const struct motion_trail *history, uint32_t slot, const struct kind *kind);

/* Adds the smoke of missiles that no longer exist. */
void trails_ended(struct draw_list *list, const struct frame_view *frame_view,
                  const struct motion_trails *histories);

#endif
