/* An event as one line of JSON, as jolon events --json tells it, but for its sequence. */
#ifndef JOLON_IPC_TOPICS_EVENT_JSON_H
#define JOLON_IPC_TOPICS_EVENT_JSON_H

#include "ipc/topics/event_merge.h"

/* A event_merge_format. */
void event_json(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event);

#endif
