/* What the monitor prints as JSON: the shapes of `jolon status --json` and `jolon events --json`,
 * with more in them. Pure. */
#ifndef JOLON_CLIENTS_MONITOR_STATUS_JSON_H
#define JOLON_CLIENTS_MONITOR_STATUS_JSON_H

#include "ipc/topics/world_mirror.h"

/* The status as one object, without a newline, NULL when there is no memory; for cJSON_free(). With
 * a filter also the vehicles that suit it (vehicle_table_matches()), by their ids. */
char *status_json(const struct world_mirror *mirror, const char *filter, uint64_t now_ns);

#endif
