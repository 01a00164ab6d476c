/* What other simulators tell of their entities, as records in the gateway's ring
 * (world/entity/remote.h): Entity State is TRACK or LOST, Fire is FIRE, Detonation is STRUCK,
 * and so is a Collision of which our own collider has not told.
 *
 * Places on the earth become places of the world here, so that the step of the mover has no result
 * of them. Velocities by the clock become those by simulated time, at the present time scale. Times
 * are those of arrival. Time stamps only tell an Entity State that the network has
 * delayed or repeated from the next one. */
#ifndef JOLON_GATEWAY_REMOTE_INPUT_H
#define JOLON_GATEWAY_REMOTE_INPUT_H

#include "gateway/earth/local_frame.h"
#include "gateway/entity_ids.h"
#include "gateway/remote_table.h"
#include "gateway/event_memory.h"
#include "gateway/type_notices.h"
#include "gateway/type_table.h"
#include "ipc/process/rate.h"

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

/* Who had an entity before a gateway that starts anew is read from the records in the ring. Where
 * they no longer say it, a sender becomes the owner who has the entity near its row, in the time in
 * which the former owner must send again (a heartbeat); then whoever comes first. */
#define REMOTE_INPUT_GRACE_S 6.0
#define REMOTE_INPUT_GRACE_M 500.0

/* Why something is refused. */
enum remote_input_refusal {
    REMOTE_INPUT_FULL,   /* beyond world.remotes_max */
    REMOTE_INPUT_PLACE,  /* outside the square, or not on the earth */
    REMOTE_INPUT_HEIGHT, /* below any ground, or above any flight */
    REMOTE_INPUT_JUMP,   /* too far from where the entity was */
    REMOTE_INPUT_TWIN,   /* of an identifier that another sender has */
    REMOTE_INPUT_RING,   /* the ring was full */
    REMOTE_INPUT_SHOTS,  /* shots, detonations and collisions beyond 1,000 a second */
    REMOTE_INPUT_BODY,   /* collisions without a mass, or more than can wait */
    REMOTE_INPUT_TYPE,   /* of no type that can be shown, whose types are told instead */
    REMOTE_INPUT_REFUSALS
};

struct remote_input {
    const struct type_table *types;
    const struct local_frame *frame;
    double side_m; /* of the world */
    struct entity_ids own;
    bool clamp;
    uint64_t timeout_ns;
    struct remote_table table;
    struct rate shots;
    struct event_memory heard;
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
    struct type_notices unknown;
    double time_scale; /* of the last snapshot; above 0 */
    uint64_t taken;    /* of the ring, as the last snapshot has it */
    uint64_t grace_ns; /* of REMOTE_INPUT_GRACE_S: its end */
    /* Counts. */
    uint64_t tracks, lost, fires, struck;
    uint64_t collisions; /* of others with ours, of which our collider has told, too */
    uint64_t refused[REMOTE_INPUT_REFUSALS];
    uint64_t twin; /* remote_id() of the last twin, and who sent it */
    struct udp_address twin_from;
    uint64_t repeated; /* shots and detonations that came before */
    uint64_t late;     /* Entity States that are older than what came before, or copies */
    /* Records that the world has refused (enum remote_refusal), and the entity of the last. */
    uint64_t world_refused[REMOTE_REFUSAL_COUNT], world_refused_remote;
    uint64_t refused_told, world_refused_told;
    uint32_t world_capacity;
};

/* Reserves memory; types, frame, own, clamp and timeout_ns are set. Finds the shots that a
 * predecessor has written, and who owns which entity. Returns 0, or -1 with the reason. */
int remote_input_open(struct remote_input *input, const struct view *view, uint64_t now_ns,
                      struct error_text *error);
void remote_input_close(struct remote_input *input);

/* Takes a PDU. Returns false if it is of a type that is none of these, or if the world has no room
 * for remote entities. */
bool remote_input_take(struct remote_input *input, struct view *view, const struct pdu *pdu,
                       const struct udp_address *from, uint64_t now_ns);

/* Notes that our collider has told of a collision of one of our vehicles with a remote entity. */
void remote_input_met(struct remote_input *input, uint32_t entity, uint64_t remote,
                      uint64_t now_ns);

/* Notes that the world has refused some records of a frame, the first of this entity. because: enum
 * remote_refusal. */
void remote_input_world_refused(struct remote_input *input, uint64_t remote, uint32_t count,
                                uint32_t because);

/* Writes what waits into the ring. */
void remote_input_tell(struct remote_input *input, struct view *view, uint64_t now_ns);

/* Learns the rows from a new snapshot, and removes entities that were not heard of for too long. */
void remote_input_see(struct remote_input *input, struct view *view,
                      const struct snapshot *snapshot, uint64_t now_ns);

#endif
