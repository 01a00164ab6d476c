/* Grass and brush near the eye that are looks alone: too low to stop anything, they are no objects
 * of the world. Made by blocks of ground and kept as long as the eye is near: what a block bears
 * depends on its place and on the craters in it, never on when it was made. Pure. */
#ifndef JOLON_RENDERER_SCENE_PLANTS_GRASS_H
#define JOLON_RENDERER_SCENE_PLANTS_GRASS_H

#include <stdint.h>

#define GRASS_RANGE_M 170.0 /* at full detail */

struct crater_index;
struct draw_list;
struct draw_list_plant;
struct grass;
struct world;

/* NULL when there is no memory. */
struct grass *grass_new(void);
void grass_free(struct grass *grass);

/* Writes those in view of the scene's camera to plants; how many, at most room. How far they reach
 * goes with the scene's detail. */
uint32_t grass_show(struct grass *grass, const struct draw_list *list, const struct world *world,
                    const struct crater_index *craters, struct draw_list_plant *plants,
                    uint32_t room);

#endif
