/* Platforms that meet are lost. */
#include "collider/attrition.h"

int attrition_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct vec3 still = {0.0, 0.0, 0.0};
    outcome->response = RESPONSE_DESTROYED;
    if (respond_stay(respond, impact->a, impact->time, still) != 0 ||
        respond_stay(respond, impact->b, impact->time, still) != 0 ||
        harm_destroy(respond, impact->a, impact->time) != 0)
        return -1;
    return harm_destroy(respond, impact->b, impact->time);
}
