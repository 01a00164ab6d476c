/* The last events that concern the driven vehicle or its last target. */
#ifndef JOLON_CLIENTS_DRIVE_RECENT_EVENTS_H
#define JOLON_CLIENTS_DRIVE_RECENT_EVENTS_H

#include "clients/drive/session.h"
#include "ipc/topics/event_merge.h"

#define RECENT_EVENTS_KEPT 32u
#define RECENT_EVENTS_MAX  120u

struct recent_events {
    const struct session *session;
    char line[RECENT_EVENTS_KEPT]
             [RECENT_EVENTS_MAX]; /* a ring, [count % RECENT_EVENTS_KEPT] next */
    uint64_t count;
};

/* An event_merge_format that writes the ids of the entities before the text, for
 * recent_events_take(). */
void recent_events_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event);

/* An event_merge_print whose context is a struct recent_events: keeps the events that concern the
 * vehicle or its last target. */
bool recent_events_take(void *events, const char *line);

#endif
