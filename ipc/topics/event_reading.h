/* Reads an event of the topics back into the event that the reporter published. Pure; any thread.
 */
#ifndef JOLON_IPC_TOPICS_EVENT_READING_H
#define JOLON_IPC_TOPICS_EVENT_READING_H

#include "ipc/topics/dds_topics.h"
#include "status.h"
#include "world/entity/event.h"
#include "world/event_text.h"

#define EVENT_READING_IDS 3

struct event_reading {
    /* As in the ring, but without its number, time and place in the frame, which are in the
     * sample's header. A party's kind is only in `kind`. */
    struct event event;
    const char
        *kind[EVENT_TEXT_PARTIES];   /* in the sample; NULL for a party that it does not have */
    uint32_t ids[EVENT_READING_IDS]; /* of its vehicles and munitions, 0: none */
};

/* sample: of an event's topic, checked by samples_good(). It must outlive the result. */
struct event_reading event_reading_of(enum dds_topic topic, const void *sample);

#endif
