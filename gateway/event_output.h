/* Fire, Detonation and Collision PDUs from the ring of events.
 *
 * The number of a Fire's and a Detonation's event is that of the munition, so both agree without a
 * memory. Who fired a munition is remembered for the last shots, and read again from the ring by a
 * gateway that starts anew. */
#ifndef JOLON_GATEWAY_EVENT_OUTPUT_H
#define JOLON_GATEWAY_EVENT_OUTPUT_H

#include "gateway/entity_output.h"
#include "gateway/remote_input.h"
#include "ipc/frame/event_cursor.h"
#include "world/entity/event.h"

#define EVENT_OUTPUT_AT_ONCE 64u
#define EVENT_OUTPUT_SHOTS   8192u /* power of two */

/* The collisions of so many frames are told to the way in. */
#define EVENT_OUTPUT_RECENT 120u

/* A contact whose closing speed is below this is no Collision (IEEE 1278.1) [m/s]. */
#define EVENT_OUTPUT_COLLISION_MPS 0.1f

struct event_output {
    struct pdu_output *output;
    const struct entity_output *entities; /* its snapshot has the bodies */
    struct remote_input *remotes;         /* is told of their collisions; NULL: nobody is */
    struct event_cursor cursor;
    uint64_t send_from_frame; /* earlier events were sent by a predecessor */
    uint64_t frame;           /* all events up to this frame are sent */
    uint64_t postponed;       /* passes in which the rate has put events off */
    uint64_t waiting;         /* events of all types that wait since the last pass */
    struct event event[EVENT_OUTPUT_AT_ONCE];
    struct {
        uint32_t munition, shooter;
        uint64_t tick;                /* of the shot */
        struct vec3 muzzle, velocity; /* [m], and [m/s] when it was seen last */
    } shot[EVENT_OUTPUT_SHOTS];
};

/* Finds the beginning of the ring. before: the last frame whose events a predecessor has sent, 0
 * when there was none; then events of the past are not sent. */
void event_output_open(struct event_output *events, const struct view *view, uint64_t before);

/* Sends the events that were committed, until the rate is used up. now_ns is the time of the clock.
 */
void event_output_send(struct event_output *events, const struct view *view, uint64_t now_ns);

#endif
