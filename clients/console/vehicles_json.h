/* The answer of /api/list: the list of vehicles. */
#ifndef JOLON_CLIENTS_CONSOLE_VEHICLES_JSON_H
#define JOLON_CLIENTS_CONSOLE_VEHICLES_JSON_H

#include "clients/console/world_query.h"

/* Writes the rows of one page of the filtered and sorted list. */
void vehicles_json(const struct world_query *list, struct http_answer *answer);

#endif
