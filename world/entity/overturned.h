/* When a land vehicle on its springs counts as overturned. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_OVERTURNED_H
#define JOLON_WORLD_ENTITY_OVERTURNED_H

#include "world/maths/maths.h"

#include <stdbool.h>

/* A vehicle that leans more lies on its side [cosine of 80 degrees]. */
#define OVERTURNED_COSINE 0.17364817766693033
/* One that leans less both lengthwise and sideways does not: cos(1)^2 is 0.29 [rad]. */
#define OVERTURNED_NEVER_RAD 1.0

/* Returns true if a vehicle with these angles [rad] lies on its side or on its roof. */
static inline bool overturned(double pitch_rad, double roll_rad)
{
    if (fabs(pitch_rad) < OVERTURNED_NEVER_RAD && fabs(roll_rad) < OVERTURNED_NEVER_RAD)
        return false;
    return maths_cos(pitch_rad) * maths_cos(roll_rad) < OVERTURNED_COSINE;
}

#endif
