/* Events: the event ring, in order and with none left out, onto the event topics.
 *
 * At least once: a new reporter goes back to what its predecessor may not have delivered, and at
 * least EVENT_TOPICS_AGAIN events, so that late subscribers of its own find some history. */
#ifndef JOLON_REPORTER_EVENT_TOPICS_H
#define JOLON_REPORTER_EVENT_TOPICS_H

#include "ipc/frame/event_cursor.h"
#include "ipc/topics/dds_topics.h"
#include "world/entity/event.h"

#define EVENT_TOPICS_AGAIN   4096u
#define EVENT_TOPICS_AGAIN_S 1.0 /* [s of simulation] before the predecessor's last frame */
#define EVENT_TOPICS_AT_ONCE 128u
#define EVENT_TOPICS_COUNT   5u

struct event_topics {
    dds_entity_t writer[EVENT_TOPICS_COUNT];
    uint64_t previous[EVENT_TOPICS_COUNT]; /* sequence last seen for the topic; UINT64_MAX: none */
    struct event_cursor cursor;
    uint64_t publish_from;       /* events before this sequence only say what was last on a topic */
    uint64_t publish_from_frame; /* ... unless their frame is at least this */
    uint64_t run;
    uint64_t frame; /* the last frame of which every event was published */
    uint64_t logged_ns;
    uint64_t gaps; /* events lost to the ring since the world began */
    struct event event[EVENT_TOPICS_AT_ONCE];
};

/* Makes the writers and finds the place to begin; -1 with the reason. */
int event_topics_open(struct event_topics *events, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error);

/* Publishes committed events until there are no more or the clock reaches until_ns. True when none
 * was left. What DDS does not take stays for the next call. */
bool event_topics_publish(struct event_topics *events, const struct view *view, uint64_t until_ns);

/* Waits until the subscribers have what was published, or until until_ns. */
void event_topics_flush(const struct event_topics *events, uint64_t until_ns);

#endif
