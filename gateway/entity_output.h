/* Entity State PDUs of our vehicles and guided missiles, and their events of Cursor on Target.
 *
 * A receiver shows an entity where its dead reckoning has it. The gateway computes the same, and
 * sends a new Entity State when the vehicle is more than a metre or three degrees from there, when
 * what can be seen of it has changed, and every 5 s anyway. It remembers only what it sent last, so
 * one that starts anew sends every entity once. */
#ifndef JOLON_GATEWAY_ENTITY_OUTPUT_H
#define JOLON_GATEWAY_ENTITY_OUTPUT_H

#include "gateway/cot_output.h"
#include "gateway/earth/local_frame.h"
#include "gateway/entity_ids.h"
#include "gateway/pdu_output.h"
#include "gateway/type_table.h"
#include "ipc/frame/snapshot.h"
#include "world/maths/dead_reckoning.h"

/* Thresholds and times of IEEE 1278.1. */
#define ENTITY_OUTPUT_POSITION_M  1.0
#define ENTITY_OUTPUT_ANGLE_RAD   (3.0 * RAD_PER_DEG)
#define ENTITY_OUTPUT_HEARTBEAT_S 5.0

/* A receiver that has lost the last Entity State still extrapolates the one before. When that is
 * further off than the threshold and what the entity moves in this time, the next one goes out [s].
 * Without it 1.4 % of the places of moving vehicles are too far off behind a network that loses
 * 5 %. Shorter times need more PDUs: 0.1 s 9 %, 0.15 s 7 %, 0.2 s 6 %, 0.3 s 4 %. Not sooner after
 * the last one than this, because a network loses several in a row. */
#define ENTITY_OUTPUT_LOST_S  0.15
#define ENTITY_OUTPUT_AGAIN_S 0.1

/* Rows that are followed from frame to frame between two passes: those that turn faster, or that
 * receivers have further off, than this, because they pass a threshold before the next pass. */
#define ENTITY_OUTPUT_FOLLOW_RPS   0.2
#define ENTITY_OUTPUT_FOLLOW_SHARE 0.5 /* of the thresholds */

/* What was sent last of a row, and how the row moves. */
struct entity_sent {
    uint32_t id; /* 0: nothing was sent */
    uint16_t kind;
    uint8_t force;
    uint8_t moving; /* the dead reckoning was not static */
    uint32_t appearance;
    uint8_t turret_changes, gun_changes; /* of the values as they were sent, modulo 256 */
    float turret, gun;                   /* [rad] */
    uint64_t sent_ns, heartbeat_ns;      /* of the clock */
    uint64_t frame_ns;                   /* the time of the frame that was sent */
    struct dead_reckoning state;         /* as the receivers have it */
    uint64_t before_ns;           /* the same of the Entity State before; 0: there was none */
    struct dead_reckoning before; /* as receivers have it that lost the last one */
    uint32_t before_appearance;
    struct vec3 place; /* [m] and attitude [rad] of the row, as they were sent */
    double heading, pitch, roll;
    /* Of the row in the last frame that was seen: world axes; rates in the body axes of DIS. */
    uint32_t seen_id;
    uint64_t seen_tick;
    struct vec3 seen_velocity, seen_rates, acceleration, rates;
    struct mat3 seen_turn;
    double seen_s;         /* the rates are those over so long */
    uint64_t earlier_tick; /* the frame that was seen before that one */
    struct vec3 earlier_velocity;
};

struct entity_output {
    struct pdu_output *output;
    struct cot_output *cot; /* NULL: no events of Cursor on Target are sent */
    const struct type_table *types;
    struct entity_ids ids;
    struct local_frame frame;
    struct snapshot snapshot; /* the last frame that was sent from */
    struct entity_sent *sent; /* [capacity] */
    uint32_t capacity;
    uint64_t frame_ns;  /* the time of the snapshot's frame, by the clock */
    double offset_s;    /* of the clock over the frames' own time, smoothed (frame_time_ns()) */
    uint32_t *followed; /* [capacity] rows between two passes */
    uint32_t followed_count;
    uint32_t next_row;  /* where the next pass begins, so that a full rate is shared */
    bool cut_short;     /* the rate did not suffice for the last pass */
    uint32_t known;     /* rows with an id: 0 .. known - 1 */
    uint64_t refused;   /* entities whose id is beyond the range of applications */
    uint64_t postponed; /* passes in which the rate has put Entity States off */
    bool told_refused;
    bool told_kind[KIND_COUNT_MAX];
};

/* Reserves memory. output, types, ids and frame are set. Returns 0, or -1 with the reason. */
int entity_output_open(struct entity_output *entities, const struct view *view,
                       struct error_text *error);
void entity_output_close(struct entity_output *entities);

/* Takes a new snapshot. now_ns is the time of the clock. Returns false if there is none now; the
 * last one stays. */
bool entity_output_look(struct entity_output *entities, const struct view *view, uint64_t now_ns);

/* Sends what is due by the snapshot. */
void entity_output_send(struct entity_output *entities, const struct view *view, uint64_t now_ns);

/* Between two passes: sends what is due by the last committed frame of the rows that the last pass
 * has chosen, if there is a later frame and the rate has sufficed for that pass. */
void entity_output_follow(struct entity_output *entities, const struct view *view, uint64_t now_ns);

/* Sends a last state with the bit "deactivated" for each entity that was sent. */
void entity_output_deactivate(struct entity_output *entities, const struct view *view,
                              uint64_t now_ns);

/* Returns the row of an entity in the last snapshot, SLOT_NONE when it is gone. */
uint32_t entity_output_row(const struct entity_output *entities, uint32_t id);

/* Returns the velocity that the entity of a row of the last snapshot had before the step of a tick
 * [m/s, world], as far as the gateway has seen: in a collision of that step, which has changed it.
 */
struct vec3 entity_output_velocity_before(const struct entity_output *entities, uint32_t row,
                                          uint64_t tick);

/* Returns true if entities of the kind are sent: vehicles and guided missiles, no rounds. */
bool entity_output_sends(const struct kind *kind);

#endif
