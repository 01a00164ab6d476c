/* Platforms that meet are lost. */
#include "collider/attrition.h"

void attrition_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct vec3 still = {0.0, 0.0, 0.0};
    outcome->response = RESPONSE_DESTROYED;
    respond_stay(respond, impact->a, impact->time, still);
    respond_stay(respond, impact->b, impact->time, still);
    harm_destroy(respond, impact->a, impact->time);
    harm_destroy(respond, impact->b, impact->time);
}
