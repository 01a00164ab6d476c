/* Dead reckoning: where a simulator that receives an Entity State shows the entity until the next.
 * The models are 1 to 9 of IEEE 1278.1-2012 annex E; other numbers are treated as 1. Pure; any
 * thread. */
#ifndef JOLON_WORLD_MATHS_DEAD_RECKONING_H
#define JOLON_WORLD_MATHS_DEAD_RECKONING_H

#include "world/maths/rotation.h"

#include <stdint.h>

enum dead_reckoning_model {
    DEAD_RECKONING_STATIC = 1,
    DEAD_RECKONING_FPW = 2, /* F: keeps its attitude, R: turns; P: constant velocity, */
    DEAD_RECKONING_RPW = 3, /* V: constant acceleration; W: world axes, B: body axes */
    DEAD_RECKONING_RVW = 4,
    DEAD_RECKONING_FVW = 5,
    DEAD_RECKONING_FPB = 6,
    DEAD_RECKONING_RPB = 7,
    DEAD_RECKONING_RVB = 8,
    DEAD_RECKONING_FVB = 9
};

struct dead_reckoning {
    uint8_t model;
    struct vec3 position;     /* [m] axes that do not turn: of DIS those of the earth (ECEF) */
    struct vec3 velocity;     /* [m/s] the same; body axes for models 6 to 9 */
    struct vec3 acceleration; /* [m/s^2] axes as for velocity */
    struct vec3 rates;        /* [rad/s] angular velocity, body axes */
    struct mat3 matrix;       /* from body axes to those of the position */
};

/* Writes position and attitude time_s after the state. A turn of more than 1e5 rad, which no
 * vehicle makes, is left out. */
void dead_reckoning_at(const struct dead_reckoning *state, double time_s, struct vec3 *position,
                       struct mat3 *matrix);

#endif
