/* The response "mps" (thesis row 42): platforms of MPS II and III that came near each other. Both
 * are destroyed and stay where they are, whatever their speeds, angle and masses. A platform passes
 * through fixed objects. */
#include "collider/response/damage.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"

static void destroy_both(struct response_context *context, const struct impact *impact,
                         struct outcome *outcome)
{
    const struct vec3 still = {0.0, 0.0, 0.0};
    outcome->response = RESPONSE_DESTROYED;
    path_change_stay(context, impact->a, impact->time, still);
    path_change_stay(context, impact->b, impact->time, still);
    damage_destroy(context, impact->a, impact->time);
    damage_destroy(context, impact->b, impact->time);
}

const struct response_functions response_mps = {.moving = destroy_both};
