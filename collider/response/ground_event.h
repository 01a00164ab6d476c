/* The event of a vehicle that strikes the ground so hard that it takes harm. */
#ifndef JOLON_COLLIDER_RESPONSE_GROUND_EVENT_H
#define JOLON_COLLIDER_RESPONSE_GROUND_EVENT_H

#include "collider/response/response_context.h"

/* How a row strikes the ground. */
struct ground_strike {
    struct vec3 at, velocity; /* of the row before the ground acts [m, m/s] */
    struct vec3 normal;       /* of the ground, unit, upwards */
    double closing_mps;       /* that the ground takes */
    double time;              /* of the frame, 0 to 1 */
    enum response response;
};

/* Writes a collision of the row with the ground, and counts it. The row has its new damage already.
 */
void ground_event_write(struct response_context *context, uint32_t row,
                        const struct ground_strike *strike);

#endif
