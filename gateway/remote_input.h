/* What other simulators tell of their entities, as records in the gateway's ring
 * (world/entity/remote.h): Entity State is TRACK or LOST, Fire is FIRE, Detonation is STRUCK,
 * and so is a Collision of which our own collider has not told.
 *
 * Places on the earth become places of the world here, so that the step of the mover has no result
 * of them. Times are those of arrival. Time stamps only tell an Entity State that the network has
 * delayed or repeated from the next one. */
#ifndef JOLON_GATEWAY_REMOTE_INPUT_H
#define JOLON_GATEWAY_REMOTE_INPUT_H

#include "gateway/earth/local_frame.h"
#include "gateway/entity_ids.h"
#include "gateway/remote_table.h"
#include "gateway/type_table.h"
#include "ipc/process/rate.h"

#define REMOTE_INPUT_EVENTS 4096u /* shots and detonations that are remembered; a power of two */
#define REMOTE_INPUT_TOLD   64u   /* unknown types of which the log has told */

/* An entity is told at most this often [s]; what comes in between is told by what comes last. */
#define REMOTE_INPUT_LEAST_S 0.02

/* What networks delay and repeat is known by its time stamp, when it is at most this much older
 * than what came this long ago at most [s]. Other differences are those of wrong clocks. */
#define REMOTE_INPUT_LATE_S 1.0

/* Collisions of others with our vehicles. Our collider has most of them itself: what it tells from
 * so long before to so long after they come is the same collision [s]. */
#define REMOTE_INPUT_BODIES   256u
#define REMOTE_INPUT_BEFORE_S 2.0
#define REMOTE_INPUT_AFTER_S  0.3

/* The last entities that were deactivated, of which Entity States may come late. */
#define REMOTE_INPUT_GONE 256u

struct remote_input {
    const struct type_table *types;
    const struct local_frame *frame;
    struct entity_ids own;
    bool clamp;
    uint64_t timeout_ns;
    struct remote_table table;
    struct rate shots;
    struct {
        uint64_t event;
        uint32_t type;            /* enum remote_type */
        struct vec3 place;        /* [m] of a FIRE: where it was */
    } heard[REMOTE_INPUT_EVENTS]; /* the last shots and detonations, to know them again */
    uint32_t heard_count;
    struct {
        uint64_t remote, heard_ns;
        uint32_t stamp;
    } gone[REMOTE_INPUT_GONE]; /* deactivated entities */
    uint32_t gone_count;
    struct {
        uint64_t heard_ns; /* 0: the place is free */
        struct remote_record record;
    } bodies[REMOTE_INPUT_BODIES]; /* collisions that wait for our own collider */
    struct {
        uint64_t remote, heard_ns;
        uint32_t entity;
    } met[REMOTE_INPUT_BODIES]; /* the last collisions that our collider has told of */
    uint32_t met_count;
    struct pdu_entity_type told[REMOTE_INPUT_TOLD];
    uint32_t told_count;
    uint64_t taken; /* of the ring, as the last snapshot has it */
    /* Counts. */
    uint64_t tracks, lost, fires, struck;
    uint64_t collisions;    /* of others with ours, of which our collider has told, too */
    uint64_t refused_body;  /* collisions without a mass, or more than can wait */
    uint64_t refused_full;  /* Entity States beyond world.remotes_max */
    uint64_t refused_place; /* outside the square, or not on the earth */
    uint64_t refused_jump;
    uint64_t refused_twin; /* of an id that another sender has */
    uint64_t refused_type; /* of no type that can be shown */
    uint64_t refused_ring; /* the ring was full */
    uint64_t repeated;     /* shots and detonations that came before */
    uint64_t late;         /* Entity States that are older than what came before, or copies */
    uint64_t logged_ns, logged;
};

/* Reserves memory; types, frame, own, clamp and timeout_ns are set. Finds the shots that a
 * predecessor has written. Returns 0, or -1 with the reason. */
int remote_input_open(struct remote_input *input, const struct view *view,
                      struct error_text *error);
void remote_input_close(struct remote_input *input);

/* Takes a PDU. Returns false if it is of a type that is none of these, or if the world has no room
 * for remote entities. */
bool remote_input_take(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       const struct udp_address *from, uint64_t now_ns);

/* Notes that our collider has told of a collision of one of our vehicles with a remote entity. */
void remote_input_met(struct remote_input *input, uint32_t entity, uint64_t remote,
                      uint64_t now_ns);

/* Writes what waits into the ring. */
void remote_input_tell(struct remote_input *input, struct view *view, uint64_t now_ns);

/* Learns the rows from a new snapshot, and removes entities that were not heard of for too long. */
void remote_input_see(struct remote_input *input, struct view *view,
                      const struct snapshot *snapshot, uint64_t now_ns);

#endif
