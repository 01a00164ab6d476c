/* Which parts of a model collide on their own, and what they turn about. A model whose pieces that
 * collide include a body and a turret has up to three such parts: body, turret and gun. Any other
 * model is all body, and so its gun does not move either. Start-up only. */
#ifndef JOLON_CONFIG_MESH_MODEL_PARTS_H
#define JOLON_CONFIG_MESH_MODEL_PARTS_H

#include "world/maths/maths.h"
#include "world/model.h"

#include <stdint.h>

struct hulls;
struct scenario;

/* Sets the part (enum hull_part) of each vertex that collides. part: set to 0, room for them. */
void model_parts_of_vertices(uint8_t *part, const struct scenario *scenario,
                             const struct model *model);

/* Returns what the visible turret or gun turns about [m, body axes], as it is drawn: a turret about
 * the middle of its lowest corners, a gun about the middle of its rear end. Of several guns the
 * first counts. Zero if there is none. */
struct vec3 model_parts_pivot(const struct scenario *scenario, const struct model *model,
                              enum model_part part);

/* Returns the radius about the position that contains all hulls, wherever the turret points and
 * whatever the gun's elevation within its limits [m]. */
double model_parts_reach(const struct hulls *hulls, const struct scenario *scenario,
                         double gun_low_rad, double gun_high_rad);

#endif
