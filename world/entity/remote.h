/* Remote entities: vehicles that another simulator owns and tells us of (docs/dis.md).
 *
 * A remote entity is a row like any other, with BEHAVIOUR_REMOTE, or a munition. Records of its
 * owner reach the mover through the gateway's ring, and are recorded with the run. Between two of
 * them the mover extrapolates the row by dead reckoning. The collider does not let contacts move or
 * damage it. It corrects the row by what its owner has told: the correction lies between two frames
 * and is no motion, so nothing is struck by it. */
#ifndef JOLON_WORLD_ENTITY_REMOTE_H
#define JOLON_WORLD_ENTITY_REMOTE_H

#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/maths/dead_reckoning.h"

#include <string.h>

#define REMOTE_MARKING_MAX 12u

/* Rows of remote entities at most, of CAPACITY_MAX. */
#define REMOTE_ROWS_MAX 131072u

/* The types of records. They share the ring of the gateway's commands, so no number is one of
 * enum command_type. */
enum remote_type {
    REMOTE_TRACK = 256, /* where an entity is and how it moves; makes its row at first */
    REMOTE_LOST,        /* the entity is gone, or its owner was not heard of for too long */
    REMOTE_STRUCK,      /* a munition of another simulator detonates here, or a body strikes ours */
    REMOTE_FIRE,        /* an entity of another simulator fires */
    REMOTE_OWNER,       /* who owns an entity, for a gateway that starts anew; has no effect */
    REMOTE_TYPE_END
};

#define REMOTE_FLAG_CLAMPED 1u /* a land vehicle is set on our ground where that is near */

/* STRUCK, instead of a model: it bursts where it is told, and not on the ground below. */
#define REMOTE_BURST_IN_AIR 128u

/* A record in the gateway's ring, in a slot of the size of a command. Everything is in the axes of
 * the world, also the velocity, acceleration and rates of models 6 to 9, whose axes turn with the
 * body. */
struct remote_record {
    uint64_t sequence; /* as in struct command */
    uint64_t remote;   /* remote_id() of the entity; STRUCK: of the firer or of the body, 0: none */
    uint64_t event;    /* FIRE, STRUCK: remote_id() of the event. TRACK, OWNER: a number of who
                          sent it, for a gateway that starts anew; it means nothing to the world */
    uint32_t type;     /* enum remote_type */
    uint32_t slot;     /* where the sender has seen the entity's row; SLOT_NONE: nowhere */
    union {
        uint32_t entity;    /* FIRE, STRUCK: our vehicle that is the target, 0: none */
        struct {            /* TRACK */
            uint8_t damage; /* enum damage */
            uint8_t flags;  /* REMOTE_FLAG_* */
            uint8_t unused[2];
        };
    };
    uint16_t kind;      /* TRACK: of the row; FIRE, STRUCK: of the munition. STRUCK:
                           KIND_NONE for a body, such as a vehicle that drives into ours */
    uint8_t force;      /* enum force */
    uint8_t model;      /* TRACK: enum dead_reckoning_model; STRUCK: 0 or REMOTE_BURST_IN_AIR */
    double position[3]; /* [m]; STRUCK with a target: in its body axes */
    float velocity[3];  /* [m/s] */
    union {
        float acceleration[3]; /* [m/s^2] TRACK */
        struct {               /* STRUCK */
            float flown_m;     /* how far the munition has flown, 0: from a muzzle right here */
            float mass_kg;     /* of a body */
            float restitution; /* of a body: 0 inelastic, 1 elastic */
        };
    };
    float rates[3];                   /* [rad/s] TRACK: angular velocity */
    float attitude[3];                /* [rad] TRACK: heading, pitch, roll */
    int16_t turret, gun;              /* [pi / 32768 rad] TRACK */
    char marking[REMOTE_MARKING_MAX]; /* TRACK: for people; the rest is NUL */
};
_Static_assert(sizeof(struct remote_record) == sizeof(struct command), "a record is in a slot");

/* Why a record is refused. */
enum remote_refusal {
    REMOTE_TAKEN,    /* it is not */
    REMOTE_UNKNOWN,  /* not a type, or values out of range */
    REMOTE_NO_KIND,  /* the kind does not exist, or does not fit */
    REMOTE_TOO_MANY, /* world.remotes_max entities are there */
    REMOTE_NO_ROW,   /* the table is full */
    REMOTE_JUMPS,    /* it would jump further than an entity can */
    REMOTE_NOBODY,   /* there is no such entity */
    REMOTE_REFUSAL_COUNT
};

/* A TRACK further from where the row is than this is refused [m]. */
#define REMOTE_JUMP_M 10000.0

/* Without a TRACK for this long, or over this way, an entity is no longer extrapolated [s of
 * simulation, m]. The way is well below a jump, so that a TRACK of an owner who has gone on in
 * another direction, or at another rate of time, is not refused. */
#define REMOTE_TRUST_S 30.0
#define REMOTE_TRUST_M (0.5 * REMOTE_JUMP_M)

/* The number by which the owner's simulation knows an entity or an event. Never 0 for an entity. */
static inline uint64_t remote_id(uint16_t site, uint16_t application, uint16_t entity)
{
    return (uint64_t)site << 32 | (uint64_t)application << 16 | entity;
}

/* Writes SITE:APPLICATION:ENTITY. Returns text. */
#define REMOTE_ID_TEXT 24u
const char *remote_id_text(uint64_t remote, char text[REMOTE_ID_TEXT]);

static inline struct remote_record remote_record_of(const struct command *slot)
{
    struct remote_record record;
    memcpy(&record, slot, sizeof record);
    return record;
}

static inline struct command remote_record_slot(const struct remote_record *record)
{
    struct command slot;
    memcpy(&slot, record, sizeof slot);
    return slot;
}

/* Adds the record in a slot to the hash of those before it, 0 before the first. Its number in the
 * ring is left out: a log that is played again gives it another. */
uint64_t remote_record_hash(const struct command *slot, uint64_t before);

static inline bool remote_is_record(uint32_t type)
{
    return type >= REMOTE_TRACK && type < REMOTE_TYPE_END;
}

/* A munition in flight has BEHAVIOUR_FLIGHT whoever owns it, so that it is drawn and listed among
 * munitions and no agent takes it for a vehicle. Ours have no driver. */
static inline bool remote_is_munition(const struct entities *e, uint32_t i)
{
    return e->row[i].behaviour == BEHAVIOUR_FLIGHT && e->row[i].driver != 0;
}

static inline bool remote_is(const struct entities *e, uint32_t i)
{
    return e->row[i].behaviour == BEHAVIOUR_REMOTE || remote_is_munition(e, i);
}

/* A remote row has no agent and no driver, and a munition no target here, so it uses their fields:
 *   driver                        remote_id()
 *   order_arg                     enum dead_reckoning_model | REMOTE_FLAG_* << REMOTE_FLAGS_SHIFT
 *   seen_tick                     when its last TRACK came
 *   climb, traverse, elevate      acceleration [m/s^2, world axes]
 *   goal_x, ease, goal_z          velocity by which an error of its place vanishes [m/s]
 *   steer, brake, dodge           rates by which one of its attitude vanishes [rad/s, world axes]
 *   until_tick                    the last step at whose end both are corrected
 *   leg, jolt_tick, target_slot   its marking, four characters each (target_id is 0) */
#define REMOTE_FLAGS_SHIFT 8u
#define REMOTE_MODEL_MASK  0xffu

/* A clamped land vehicle is set on our ground if it is this near [m]. */
#define REMOTE_CLAMP_M 30.0

/* Writes the marking of a remote row, "" of every other. Ends it with a NUL. */
void remote_marking(const struct entities *e, uint32_t i, char marking[REMOTE_MARKING_MAX + 1]);

static inline struct vec3 remote_acceleration(const struct entities *e, uint32_t i)
{
    return (struct vec3){(double)e->row[i].climb, (double)e->row[i].traverse,
                         (double)e->row[i].elevate};
}

static inline struct vec3 remote_drift(const struct entities *e, uint32_t i)
{
    return (struct vec3){e->row[i].goal_x, (double)e->row[i].ease, e->row[i].goal_z};
}

static inline struct vec3 remote_turn(const struct entities *e, uint32_t i)
{
    return (struct vec3){(double)e->row[i].steer, (double)e->row[i].brake, (double)e->row[i].dodge};
}

/* Returns true if the row is corrected at the end of the step of this tick. */
static inline bool remote_is_corrected(const struct entities *e, uint32_t i, uint32_t tick)
{
    return remote_is(e, i) && (int32_t)(e->row[i].until_tick - tick) >= 0;
}

#endif
