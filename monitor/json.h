/* What the monitor prints as JSON: the shapes of `jolon status --json` and `jolon events --json`,
 * with more in them. Pure. */
#ifndef JOLON_MONITOR_JSON_H
#define JOLON_MONITOR_JSON_H

#include "topics/mirror.h"

/* The status as one object, without a newline, NULL when there is no memory; for cJSON_free(). With
 * a filter also the vehicles that suit it (table_suits()), by their ids. */
char *json_status(const struct mirror *mirror, const char *filter, uint64_t now_ns);

#endif
