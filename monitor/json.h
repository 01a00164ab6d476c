/* What the monitor prints as JSON: the shapes of `jolon status --json` and `jolon events --json`,
 * with more in them. Pure. */
#ifndef JOLON_MONITOR_JSON_H
#define JOLON_MONITOR_JSON_H

#include "topics/mirror.h"
#include "topics/tail.h"

/* The status as one object, without a newline, NULL when there is no memory; for cJSON_free(). */
char *json_status(const struct mirror *mirror, uint64_t now_ns);

/* An event as one object; a tail_format. */
void json_event(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event);

#endif
