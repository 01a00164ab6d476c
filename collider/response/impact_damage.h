/* The effect of a collision's energy on one body. */
#ifndef JOLON_COLLIDER_RESPONSE_IMPACT_DAMAGE_H
#define JOLON_COLLIDER_RESPONSE_IMPACT_DAMAGE_H

#include "collider/response/response_context.h"

struct contact_spring_impact;
struct kind;

/* How much more the energy that a vehicle loses in a collision with another damages it than the
 * energy of a charge that explodes on it, of which most goes past. What is outside breaks first:
 * tracks, wheels, gun and sights. Without them the vehicle is highly damaged. The frame inside
 * withstands more. With these weights the thesis's cases (p. 14) come true: two tanks at 20 mph are
 * highly damaged and live, crossing or head on, and a jeep that a tank hits at 40 mph is destroyed.
 */
#define IMPACT_DAMAGE_OUTSIDE 23.0
#define IMPACT_DAMAGE_INSIDE  2.0

/* Returns the harm [J] by this energy of a collision to a vehicle that has this harm already [J].
 * An impact does as much harm as several with the same energy in all. Pure. */
double impact_damage_harm(const struct kind *kind, double harm_j, double joules);

/* Applies this energy to the row as damage and as a dent at the impact's point. side is 1 if the
 * normal points into the row, -1 if it points out of it. spring: the spring's impact; NULL for
 * other responses. */
void impact_damage_row(struct response_context *context, uint32_t row, const struct impact *impact,
                       double side, double joules, const struct contact_spring_impact *spring);

/* The same for the energy that the row loses in a collision with another vehicle. */
void impact_damage_vehicle(struct response_context *context, uint32_t row,
                           const struct impact *impact, double side, double joules,
                           const struct contact_spring_impact *spring);

#endif
