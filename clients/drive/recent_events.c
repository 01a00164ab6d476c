/* Chooses events by the entities that they concern. */
#include "clients/drive/recent_events.h"

#include "ipc/topics/event_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void recent_events_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event)
{
    uint32_t ids[EVENT_LINES_IDS];
    char words[EVENT_MERGE_LINE_MAX];
    event_lines_ids(ids, topic, event);
    event_lines_event(words, topic, event);
    int used = 0;
    for (int i = 0; i < EVENT_LINES_IDS; i++)
        used += snprintf(line + used, EVENT_MERGE_LINE_MAX - (size_t)used, "%u ", ids[i]);
    (void)snprintf(line + used, EVENT_MERGE_LINE_MAX - (size_t)used, "%.*s", (int)RECENT_EVENTS_MAX,
                   words);
}

bool recent_events_take(void *context, const char *line)
{
    struct recent_events *events = context;
    const struct session *session = events->session;
    bool concerns = false;
    for (int i = 0; i < EVENT_LINES_IDS; i++) {
        char *end;
        unsigned long id = strtoul(line, &end, 10);
        concerns = concerns || (id != 0 && (id == session->vehicle || id == session->last_target));
        line = *end ? end + 1 : end;
    }
    if (concerns)
        (void)snprintf(events->line[events->count++ % RECENT_EVENTS_KEPT], RECENT_EVENTS_MAX, "%s",
                       line);
    return true;
}
