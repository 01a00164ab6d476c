/* A motion: what a receiver is told of a moving body, from which it computes where the body is
 * until it is told again (dead reckoning). For a while the body turns and gains speed evenly, as
 * vehicles that cruise do (cruise.h); from then on it goes straight on. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_TOLD_MOTION_H
#define JOLON_WORLD_ENTITY_TOLD_MOTION_H

#include "world/maths/maths.h"

struct told_motion {
    struct vec3 at;                          /* [m] */
    struct vec3 velocity;                    /* [m/s] */
    double heading_rad, pitch_rad, roll_rad; /* as the fields of an entity */
    float turn_rps, pitch_rps, roll_rps;     /* [rad/s] by which these change ... */
    float gain_mps2, climb_mps2; /* ... and the speed along the heading and the climb [m/s2] ... */
    float lasts_s;               /* ... for so long from now */
};

/* Returns the motion of a body so long after this one, from 0 on. */
struct told_motion told_motion_at(const struct told_motion *motion, double after_s);

#endif
