/* The program's subscription to frames, entities and events.
 *
 * {"want":{"frames":true,"entities":[7,"West"],"rate_hz":5,"events":["fire","collision"]}};
 * entities may also be "all" or {"near":7,"within_m":500}. A new subscription replaces the old one.
 */
#ifndef JOLON_CLIENTS_HARNESS_SUBSCRIPTION_H
#define JOLON_CLIENTS_HARNESS_SUBSCRIPTION_H

#include "clients/harness/output.h"
#include "ipc/topics/world_mirror.h"
#include "ipc/topics/event_merge.h"

#include <cjson/cJSON.h>

#define SUBSCRIPTION_ENTITIES_MAX 1024u
#define SUBSCRIPTION_RATE_HZ      5.0
#define SUBSCRIPTION_RATE_MIN_HZ  0.1
#define SUBSCRIPTION_RATE_MAX_HZ  10.0 /* the rate of the topics */

struct subscription {
    bool frames, all;
    bool places;   /* entities have latitude, longitude and MGRS */
    uint32_t near; /* id, 0: not by distance */
    double within_m;
    double rate_hz;
    uint32_t events; /* bits of the event topics, from 0 */
    uint32_t count;
    uint32_t id[SUBSCRIPTION_ENTITIES_MAX]; /* [count] */

    uint64_t due_ns;         /* of the next states, CLOCK_MONOTONIC */
    uint64_t frame;          /* of the last entities written */
    uint64_t from_run, from; /* events of this run before this frame are left out */
    uint64_t missed;         /* of merge.missed, already reported */
};

/* Reads a subscription. Returns 0, or -1 with the error; the old subscription then remains. */
int subscription_read(struct subscription *subscription, const cJSON *want,
                      const struct world_mirror *mirror, struct error_text *error);

/* Writes the frame and the entities when they are due. */
void subscription_states(struct subscription *subscription, const struct world_mirror *mirror,
                         struct output *output, uint64_t now_ns);

/* Returns when subscription_states() is due [CLOCK_MONOTONIC ns]; UINT64_MAX: never. */
uint64_t subscription_due_ns(const struct subscription *subscription);

/* An event_merge_format for subscription_events(): writes what that function selects by, and the
 * event as JSON. */
void subscription_format(char line[EVENT_MERGE_LINE_MAX], enum dds_topic topic, const void *event);

/* Writes the events that have come and are subscribed to. */
void subscription_events(struct subscription *subscription, struct event_merge *merge,
                         struct output *output);

/* The description of the world, which the program gets at the start and when another world takes
 * its place. The caller frees it. */
cJSON *subscription_world(const struct world_mirror *mirror);

#endif
