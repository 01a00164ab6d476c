/* Events of the topics as JSON objects. */
#include "ipc/topics/event_json.h"

#include "ipc/json/world_json.h"
#include "ipc/topics/event_reading.h"

#include <stdio.h>

void event_json(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    const jolon_EventHeader *header = event;
    const struct event_reading reading = event_reading_of(topic, event);
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "frame", header->frame);
    json_whole(object, "index", header->index);
    json_number(object, "time_s", header->time_s);
    json_event_members(object, &reading.event, reading.kind);
    if (!cJSON_PrintPreallocated(object, line, (int)EVENT_MERGE_LINE_MAX, 0))
        (void)snprintf(line, EVENT_MERGE_LINE_MAX,
                       "{\"frame\":%llu,\"index\":%u,\"type\":\"unprintable\"}",
                       (unsigned long long)header->frame, header->index);
    cJSON_Delete(object);
}
