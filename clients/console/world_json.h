/* The answer of /api/world: what stays the same for the whole run. */
#ifndef JOLON_CLIENTS_CONSOLE_WORLD_JSON_H
#define JOLON_CLIENTS_CONSOLE_WORLD_JSON_H

#include "clients/console/world_query.h"

/* Writes the world's name, sizes, kinds, vehicle names and the words of its enumerations. */
void world_json(const struct world_query *asked, struct http_answer *answer);

#endif
