/* GET /api/place?at=PLACE: a place in all its forms. */
#ifndef JOLON_CLIENTS_CONSOLE_PLACE_JSON_H
#define JOLON_CLIENTS_CONSOLE_PLACE_JSON_H

#include "clients/console/world_query.h"

/* Writes the place that `at` names, in any form of world/terrain/place.h: x and z [m], and as
 * place_json_put() does. */
void place_json(const struct world_query *query, struct http_answer *answer);

/* Writes the members latitude_deg, longitude_deg, degrees and mgrs of a place of the world [m]. */
void place_json_put(struct json_writer *json, const struct params *params, double x, double z);

#endif
