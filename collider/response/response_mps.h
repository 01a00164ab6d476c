/* The response "mps" (thesis row 42): what MPS II and III did with platforms that came near each
 * other. Nothing is looked at, neither speed nor angle nor mass. */
#ifndef JOLON_COLLIDER_RESPONSE_RESPONSE_MPS_H
#define JOLON_COLLIDER_RESPONSE_RESPONSE_MPS_H

#include "collider/response/response.h"

/* Both are destroyed and stay where they are. Fixed objects had no part in it: a platform that
 * meets one goes on as if it were not there. */
void response_mps_moving(struct response_context *respond, const struct impact *impact,
                         struct outcome *outcome);

#endif
