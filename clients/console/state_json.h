/* The answer of /api/state: one frame of the world. */
#ifndef JOLON_CLIENTS_CONSOLE_STATE_JSON_H
#define JOLON_CLIENTS_CONSOLE_STATE_JSON_H

#include "clients/console/world_query.h"

/* Writes the frame, its counters, the entities of the requested area, the players, the fire
 * missions and the vehicle of the query's "me". */
void state_json(const struct world_query *asked, struct http_answer *answer);

#endif
