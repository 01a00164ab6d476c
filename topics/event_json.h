/* An event as one line of JSON, as jolon events --json tells it, but for its sequence. */
#ifndef JOLON_TOPICS_EVENT_JSON_H
#define JOLON_TOPICS_EVENT_JSON_H

#include "topics/tail.h"

/* A tail_format. */
void event_json(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event);

#endif
