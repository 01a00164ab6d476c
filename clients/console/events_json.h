/* The answer of /api/events. */
#ifndef JOLON_CLIENTS_CONSOLE_EVENTS_JSON_H
#define JOLON_CLIENTS_CONSOLE_EVENTS_JSON_H

#include "clients/console/world_query.h"

/* Writes the events from the query's "after" on, or the newest ones, with their texts. */
void events_json(const struct world_query *asked, struct http_answer *answer);

#endif
