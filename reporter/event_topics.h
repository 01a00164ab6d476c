/* Publishes the event ring on the event topics, in order and without omissions.
 *
 * Delivery is at least once. A new reporter begins with the events that its predecessor may not
 * have delivered, and with at least EVENT_TOPICS_AGAIN events, so that late subscribers find some
 * history. */
#ifndef JOLON_REPORTER_EVENT_TOPICS_H
#define JOLON_REPORTER_EVENT_TOPICS_H

#include "ipc/frame/event_cursor.h"
#include "ipc/topics/dds_topics.h"
#include "world/entity/event.h"
#include "world/terrain/location.h"

#define EVENT_TOPICS_AGAIN   4096u
#define EVENT_TOPICS_AGAIN_S 1.0 /* [s of simulation] before the predecessor's last frame */
#define EVENT_TOPICS_AT_ONCE 128u

struct event_topics {
    dds_entity_t writer[EVENT_TOPIC_COUNT];
    uint64_t previous[EVENT_TOPIC_COUNT]; /* last sequence on the topic; UINT64_MAX: none */
    struct event_cursor cursor;
    uint64_t publish_from;       /* earlier events only set previous, ... */
    uint64_t publish_from_frame; /* ... unless their frame is at least this */
    struct location_frame earth; /* where the world lies */
    uint64_t run;
    uint64_t frame; /* the last frame of which every event was published */
    uint64_t logged_ns;
    uint64_t gaps; /* events overwritten in the ring since the world began */
    struct event event[EVENT_TOPICS_AT_ONCE];
};

/* Makes the writers and finds the first event to publish. Returns 0, or -1 with the reason. */
int event_topics_open(struct event_topics *events, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error);

/* Publishes committed events until none is left or the clock reaches until_ns. Returns true when
 * none is left. Events that DDS does not take stay for the next call. */
bool event_topics_publish(struct event_topics *events, const struct view *view, uint64_t until_ns);

/* Waits until the subscribers have received all events, or until until_ns. */
void event_topics_flush(const struct event_topics *events, uint64_t until_ns);

#endif
