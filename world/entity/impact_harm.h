/* The harm of an impact of two bodies. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_IMPACT_HARM_H
#define JOLON_WORLD_ENTITY_IMPACT_HARM_H

#include "world/entity/kind.h"

/* A vehicle is highly damaged at this share of the harm that destroys it. */
#define IMPACT_HARM_SHARE_HIGH 0.6

/* How much more the energy that a vehicle loses in a collision with another damages it than the
 * energy of a charge that explodes on it, of which most goes past. What is outside breaks first:
 * tracks, wheels, gun and sights. Without them the vehicle is highly damaged. The frame inside
 * withstands more. With these weights the thesis's cases (p. 14) come true: two tanks at 20 mph are
 * highly damaged and live, crossing or head on, and a jeep that a tank hits at 40 mph is destroyed.
 */
#define IMPACT_HARM_OUTSIDE 25.0
#define IMPACT_HARM_INSIDE  2.0

/* Returns the harm [J] by this energy of a collision to a vehicle that has this harm already [J].
 * An impact does as much harm as several with the same energy in all. */
static inline double impact_harm(const struct kind *kind, double harm_j, double joules)
{
    double room = maths_max(0.0, IMPACT_HARM_SHARE_HIGH * kind->resistance_j - harm_j);
    double outside = maths_min(joules, room / IMPACT_HARM_OUTSIDE);
    return IMPACT_HARM_OUTSIDE * outside + IMPACT_HARM_INSIDE * (joules - outside);
}

#endif
