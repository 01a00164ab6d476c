/* An event as one line of JSON, with the members of `jolon events --json` except its sequence. */
#ifndef JOLON_IPC_TOPICS_EVENT_JSON_H
#define JOLON_IPC_TOPICS_EVENT_JSON_H

#include "ipc/topics/event_merge.h"

/* A event_merge_format. */
void event_json(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event);

#endif
