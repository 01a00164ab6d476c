/* Platforms that meet are lost. */
#include "collider/response/response_mps.h"

void response_mps_moving(struct response_context *respond, const struct impact *impact,
                         struct outcome *outcome)
{
    const struct vec3 still = {0.0, 0.0, 0.0};
    outcome->response = RESPONSE_DESTROYED;
    path_change_stay(respond, impact->a, impact->time, still);
    path_change_stay(respond, impact->b, impact->time, still);
    damage_destroy(respond, impact->a, impact->time);
    damage_destroy(respond, impact->b, impact->time);
}
