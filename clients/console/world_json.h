/* The answers of /api/world, what stays the same for the whole run, and of /api/place. */
#ifndef JOLON_CLIENTS_CONSOLE_WORLD_JSON_H
#define JOLON_CLIENTS_CONSOLE_WORLD_JSON_H

#include "clients/console/world_query.h"

struct world;

/* Writes the world's name, sizes, kinds, vehicle names and the words of its enumerations. */
void world_json(const struct world_query *asked, struct http_answer *answer);

/* GET /api/place?at=PLACE: writes the place that `at` names, in any form of
 * world/terrain/location.h: x and z [m], and what world_json_earth() does. */
void world_json_place(const struct world_query *query, struct http_answer *answer);

/* Writes the members latitude_deg, longitude_deg, degrees and mgrs of a place of the world [m]. */
void world_json_earth(struct json_writer *json, const struct world *world, double x, double z);

#endif
