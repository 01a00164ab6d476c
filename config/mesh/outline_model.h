/* Makes the model and the hulls of a building from the convex parts of its outline. Start-up only.
 */
#ifndef JOLON_CONFIG_MESH_OUTLINE_MODEL_H
#define JOLON_CONFIG_MESH_OUTLINE_MODEL_H

#include "config/mesh/hulls.h"
#include "world/entity/hull.h"

#include <stdbool.h>
#include <stdint.h>

#define OUTLINE_CORNERS_MAX 32u

/* A convex part, body axes [m]: its corners clockwise, as seen from above. */
struct outline_part {
    double x[OUTLINE_CORNERS_MAX], z[OUTLINE_CORNERS_MAX];
    uint32_t corners; /* 3..OUTLINE_CORNERS_MAX */
};

/* A building: walls from foot_m to eaves_m over every part, and a flat roof; if top_m is higher,
 * the only part has four corners and a ridge at top_m between the middles of its two shorter sides.
 * Heights are over its position, which is on the ground. */
struct outline {
    struct outline_part part[HULLS_A_MODEL];
    uint32_t parts; /* 1..HULLS_A_MODEL */
    double foot_m, eaves_m, top_m;
};

/* Adds a model called name to the scenario's tables: its walls, doors or windows if it has any, and
 * its roof. Walls between two parts are left out. 0; -1 with errno ENOMEM. */
int outline_model_add(struct scenario *scenario, const struct outline *outline, const char *name,
                      bool windows);

/* Adds a hull of each part to the scenario's tables. 0; -1 as hulls_of_points(). */
int outline_model_hulls(struct hulls *hulls, struct scenario *scenario,
                        const struct outline *outline);

#endif
