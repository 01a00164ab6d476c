/* Events as text. */
#include "ipc/topics/event_lines.h"

#include "ipc/process/clock.h"
#include "ipc/topics/event_reading.h"

#include <stdio.h>
#include <string.h>

const char *event_lines_clock(char text[EVENT_LINES_CLOCK_MAX], double time_s)
{
    unsigned long long tenths = time_s > 0.0 ? (unsigned long long)(time_s * 10.0 + 1e-6) : 0;
    (void)snprintf(text, EVENT_LINES_CLOCK_MAX, "%02llu:%02llu:%02llu.%llu", tenths / 36000,
                   tenths / 600 % 60, tenths / 10 % 60, tenths % 10);
    return text;
}

void event_lines_event(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    char time[EVENT_LINES_CLOCK_MAX], words[EVENT_TEXT_MAX];
    const jolon_EventHeader *header = event;
    struct event_reading reading = event_reading_of(topic, event);
    event_text(words, &reading.event, reading.kind);
    (void)snprintf(line, EVENT_MERGE_LINE_MAX, "%s %s", event_lines_clock(time, header->time_s),
                   words);
}

void event_lines_ids(uint32_t ids[EVENT_LINES_IDS], enum dds_topic topic, const void *event)
{
    struct event_reading reading = event_reading_of(topic, event);
    memcpy(ids, reading.ids, sizeof reading.ids);
}

void event_lines_silence(char *line, size_t bytes, const struct world_mirror *mirror,
                         uint64_t now_ns)
{
    line[0] = '\0';
    if (!mirror->frame_ns)
        (void)snprintf(line, bytes,
                       "world '%s': waiting for its reporter; `jolon worlds` lists the worlds",
                       mirror->name);
    else if (!world_mirror_live(mirror, now_ns))
        (void)snprintf(line, bytes,
                       "world '%s': silent for %llu s since frame %llu; waiting for its reporter",
                       mirror->name, (unsigned long long)((now_ns - mirror->frame_ns) / NS_PER_S),
                       (unsigned long long)mirror->frame.frame);
}
