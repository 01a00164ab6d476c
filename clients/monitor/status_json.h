/* The status as JSON: the members of `jolon status --json` and more. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_STATUS_JSON_H
#define JOLON_CLIENTS_MONITOR_STATUS_JSON_H

#include "ipc/topics/world_mirror.h"

/* Returns the status as an object without a newline, to be freed with cJSON_free(), or NULL if
 * there is no memory. With a filter it lists the vehicles that match it
 * (vehicle_table_matches()), sorted by id. */
char *status_json(const struct world_mirror *mirror, const char *filter, uint64_t now_ns);

#endif
