/* The effect of a collision's energy on one body. */
#ifndef JOLON_COLLIDER_RESPONSE_IMPACT_DAMAGE_H
#define JOLON_COLLIDER_RESPONSE_IMPACT_DAMAGE_H

#include "collider/response/response_context.h"
#include "world/entity/impact_harm.h"

struct contact_spring_impact;
struct kind;

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
