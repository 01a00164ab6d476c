/* The events and the silence of a world as text. */
#ifndef JOLON_IPC_TOPICS_EVENT_LINES_H
#define JOLON_IPC_TOPICS_EVENT_LINES_H

#include "ipc/topics/event_merge.h"
#include "ipc/topics/event_reading.h"
#include "ipc/topics/world_mirror.h"

#define EVENT_LINES_CLOCK_MAX 32
#define EVENT_LINES_IDS       EVENT_READING_IDS

/* Writes a time as 00:03:25.7 and returns text. */
const char *event_lines_clock(char text[EVENT_LINES_CLOCK_MAX], double time_s);

/* Writes "00:03:25.7 tank 12 fired at jeep 7"; an event_merge_format. */
void event_lines_event(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event);

/* Lists the ids of the event's vehicles and munitions, 0 where there is none. */
void event_lines_ids(uint32_t ids[EVENT_LINES_IDS], enum dds_topic topic, const void *event);

/* Writes why no samples come, "" when they do. */
void event_lines_silence(char *line, size_t bytes, const struct world_mirror *mirror,
                         uint64_t now_ns);

#endif
