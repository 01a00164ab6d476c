/* Grass and brush near the eye, for looks only: it is too low to stop anything and is not part of
 * the world. It is made in blocks of ground, which are kept while the eye is near. The contents of
 * a block depend only on its position and on the craters in it. Pure. */
#ifndef JOLON_RENDERER_SCENE_PLANTS_GRASS_H
#define JOLON_RENDERER_SCENE_PLANTS_GRASS_H

#include <stdint.h>

#define GRASS_RANGE_M 170.0 /* at full detail */

struct crater_index;
struct draw_list;
struct draw_list_plant;
struct grass;
struct road_index;
struct world;

/* Returns NULL if there is no memory. */
struct grass *grass_new(void);
void grass_free(struct grass *grass);

/* Writes the clumps in the camera's view to plants and returns their number, at most room. The
 * range depends on the draw list's detail. */
uint32_t grass_show(struct grass *grass, const struct draw_list *list, const struct world *world,
                    const struct road_index *roads, const struct crater_index *craters,
                    struct draw_list_plant *plants, uint32_t room);

#endif
