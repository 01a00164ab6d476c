/* Entities: vehicles and munitions as rows of a table.
 *
 * Each of the world's two buffers (written by the collider alone) and the moved table (written by
 * the mover alone) is such a table. A slot is a row. Slots are used again, ids never are: a
 * reference is (slot, id), and it is void when the id of the row differs. Id 0 is no entity.
 *
 * A frame touches few rows, and of these nearly all fields: so a row lies in one place
 * (docs/decisions/053-rows.md). */
#ifndef JOLON_WORLD_ENTITY_ENTITY_H
#define JOLON_WORLD_ENTITY_ENTITY_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SLOT_NONE       UINT32_MAX
#define CAPACITY_MAX    1048576u
#define CAPACITY_MIN    16u
#define TABLE_ALIGN     64u
#define ENTITY_NAME_MAX 24u

enum entity_state {
    ENTITY_FREE,   /* the slot is empty; its other fields mean nothing */
    ENTITY_ACTIVE, /* moves by its behaviour */
    ENTITY_WRECK,  /* destroyed; tumbles to rest and stays, an obstacle */
    ENTITY_STATE_COUNT
};

enum behaviour {
    BEHAVIOUR_IDLE,       /* stands; reacts when fired upon */
    BEHAVIOUR_HOLD,       /* keeps heading and speed, reacts to nothing */
    BEHAVIOUR_PATROL,     /* from goal to random goal within its area */
    BEHAVIOUR_ROUTE,      /* along its route's points, again and again */
    BEHAVIOUR_ATTACK,     /* returns fire at its target */
    BEHAVIOUR_FLEE,       /* away from its target */
    BEHAVIOUR_BACK_OFF,   /* away from what it ran into */
    BEHAVIOUR_DRIVEN,     /* by commands: a player or an outside program */
    BEHAVIOUR_FLIGHT,     /* a munition */
    BEHAVIOUR_FOLLOW,     /* keeps its place in its formation */
    BEHAVIOUR_SCRIPT,     /* by the steps of its script */
    BEHAVIOUR_WITHDRAW,   /* to its force's base, for rounds or fuel, or hurt */
    BEHAVIOUR_RESUPPLY,   /* there, until it has them */
    BEHAVIOUR_REPOSITION, /* to another place from which it can fire at its target */
    BEHAVIOUR_REMOTE,     /* as its owner, another simulator, tells (remote.h) */
    BEHAVIOUR_COUNT
};

enum force { FORCE_NEUTRAL, FORCE_BLUE, FORCE_RED, FORCE_COUNT };

/* Damage of anything, fixed or moving (thesis rows 27, 33). */
enum damage { DAMAGE_NONE, DAMAGE_LOW, DAMAGE_MED, DAMAGE_HIGH, DAMAGE_DESTROYED, DAMAGE_COUNT };

/* X(type, name) for every field, in the order in which they lie in a row: first what others ask of
 * a row, in 96 bytes, then the rest of its motion, then the agent's memory. Doubles begin at
 * multiples of 8 bytes. The mover writes all of M. The collider writes all of W: it copies M and
 * changes what collisions change: motion, state, damage, harm_j, threat_*, bump*, touch_*,
 * ENTITY_FLAG_BURST. */
#define ENTITY_FIELDS(X)                                                                           \
    X(double, x)             /* [m] world frame: east; metres to better than 1e-10 */              \
    X(double, y)             /* [m] up */                                                          \
    X(double, z)             /* [m] south */                                                       \
    X(double, vx)            /* [m/s] */                                                           \
    X(double, vy)            /* [m/s] */                                                           \
    X(double, vz)            /* [m/s] */                                                           \
    X(double, heading)       /* [rad] clockwise from north, 0..2 pi */                             \
    X(double, cruise_rps)    /* [rad/s] by which it turns while it cruises (cruise.h) */           \
    X(double, cruise_mps2)   /* [m/s2] by which it gains speed then, along its heading */          \
    X(uint32_t, cruise_tick) /* when its stretch ends (cruise.h); past: it has none */             \
    X(uint32_t, id)                                                                                \
    X(uint16_t, kind)                                                                              \
    X(uint8_t, state)                                                                              \
    X(uint8_t, behaviour)                                                                          \
    X(uint8_t, force)                                                                              \
    X(uint8_t, flags)           /* ENTITY_FLAG_* */                                                \
    X(uint8_t, damage)          /* enum damage */                                                  \
    X(uint8_t, order)           /* the behaviour it goes back to */                                \
    X(float, cruise_climb_mps2) /* [m/s2] by which an aircraft's climb grows while it cruises */   \
    X(float, turret)            /* [rad] clockwise off the heading, -pi..pi */                     \
    X(double, pitch)            /* [rad] nose up */                                                \
    X(double, roll)             /* [rad] right side down */                                        \
    X(float, gun)               /* [rad] up off the body's own plane */                            \
    X(float, cruise_pitch_rps)  /* [rad/s] by which its pitch and its roll grow then */            \
    X(float, cruise_roll_rps)                                                                      \
    X(float, throttle)       /* -1..1, by its driver or its agent */                               \
    X(double, spin_x)        /* [rad/s, world axes] by collisions, without steering */             \
    X(double, spin_y)        /* [rad/s] */                                                         \
    X(double, spin_z)        /* [rad/s] */                                                         \
    X(double, harm_j)        /* [J] energy absorbed; destroyed at the kind's resistance_j */       \
    X(double, goal_x)        /* [m] the behaviour's destination */                                 \
    X(double, goal_z)        /* [m] */                                                             \
    X(double, fuel_l)        /* [l] */                                                             \
    X(float, steer)          /* -1..1, by its driver or its agent: right */                        \
    X(uint32_t, target_slot) /* what it attacks, flees, or homes on */                             \
    X(uint32_t, target_id)                                                                         \
    X(uint32_t, threat_slot) /* fired at it since its agent last decided */                        \
    X(uint32_t, threat_id)                                                                         \
    X(uint32_t, until_tick)   /* when the behaviour, or a munition's life, ends; a wreck rests */  \
    X(uint32_t, reload_tick)  /* when it may fire again */                                         \
    X(uint32_t, seen_tick)    /* when it last saw its target */                                    \
    X(uint32_t, changed_tick) /* when its damage last grew; for fire and smoke */                  \
    X(uint32_t, jolt_tick)    /* when its chassis was last disturbed, while ENTITY_FLAG_CHASSIS */ \
    X(float, dodge)           /* [rad] to the right of its goal, around obstacles; when driven: */ \
    /* -1..1, where the steering wheel of a land vehicle is; 0..1, how */                          \
    /* far the engine of an aircraft is below its full power (spool.h) */                          \
    X(float, ease)          /* 0..1: share of its speed that it gives up for obstacles ahead */    \
    X(float, bump_heading)  /* [rad] away from the obstacle that it ran into */                    \
    X(uint32_t, order_arg)  /* its area (patrol), route, formation or script */                    \
    X(uint32_t, leg)        /* its next route point or step of its script */                       \
    X(uint32_t, owner_slot) /* a munition's shooter; a vehicle's smoke (smoke.h) */                \
    X(uint64_t, driver)     /* the one source of commands that drives it, until until_tick; 0 */   \
    X(uint32_t, owner_id)                                                                          \
    X(uint32_t, born_tick)                                                                         \
    X(uint32_t, rounds)                                                                            \
    X(float, climb)     /* -1..1, when driven: up (aircraft), hand brake (land, above 0) */        \
    X(float, brake)     /* 0..1, when driven */                                                    \
    X(float, traverse)  /* -1..1, when driven: turret to the right */                              \
    X(float, elevate)   /* -1..1, when driven: gun up */                                           \
    X(uint8_t, bumped)  /* 1: ran into something in this frame */                                  \
    X(uint8_t, trigger) /* of the mover: the row's requests in this frame */                       \
    X(uint8_t, stalled) /* how long it has driven and not got on (mover/agent/driving/progress.c)  \
                         */

/* clang-format off */
enum entity_field {
#define X(type, name) FIELD_##name,
    ENTITY_FIELDS(X)
#undef X
    ENTITY_FIELD_COUNT
};
/* clang-format on */

/* Sets of fields. */
#define FIELD_BIT(name) ((uint64_t)1 << FIELD_##name)
#define FIELDS_ALL      (UINT64_MAX >> (64 - ENTITY_FIELD_COUNT))
_Static_assert(ENTITY_FIELD_COUNT <= 64, "a set of fields is one word");

#define ENTITY_FLAG_FIRE_AT_WILL 1u /* engages all enemies that it sees */
#define ENTITY_FLAG_HOLD_FIRE    2u /* never fires */
#define ENTITY_FLAG_STAND        4u /* never flees or withdraws */
#define ENTITY_FLAG_BURST        8u /* a charge has burst near it; its agent clears the flag */
#define ENTITY_FLAG_BROKEN                                                                         \
    64u /* an aircraft's wreck that the ground has broken up (mover/motion/ground/wreck.h) */
#define ENTITY_FLAG_DISARMED                                                                       \
    64u /* the same bit while it is active: its gun is out of action (world/entity/disabled.h) */

#define ENTITY_FLAG_CHASSIS                                                                        \
    128u /* a land vehicle that moves as a body on its springs (mover/motion/chassis.h) */
#define ENTITY_FLAG_AGROUND                                                                        \
    128u /* the same bit of a ship: the shore holds it (mover/motion/ship.h) */

#define ENTITY_FLAG_LANDED                                                                         \
    128u /* and of an aircraft: it stands or slides on the ground (mover/motion/ground/landing.h)  \
          */

/* In jolt_tick of a vehicle with ENTITY_FLAG_CHASSIS: a contact keeps it from moving, and the mover
 * leaves it where it stands (mover/motion/chassis.h, collider/resting/held_rest.h). */
#define ENTITY_PINNED UINT32_MAX

/* How a driven vehicle's throttle acts on its wheels; a driver's choice, in flags. */
enum gearing {
    GEAR_AUTOMATIC, /* forwards, or backwards when the throttle is negative */
    GEAR_REVERSE,   /* the throttle drives backwards */
    GEAR_NEUTRAL,   /* not at all: the vehicle rolls */
    GEAR_LOW,       /* slow and strong */
    GEAR_COUNT
};
#define ENTITY_GEAR_SHIFT 4u
#define ENTITY_GEAR_MASK  0x30u

static inline enum gearing entity_gear(uint8_t flags)
{
    return (enum gearing)((flags & ENTITY_GEAR_MASK) >> ENTITY_GEAR_SHIFT);
}

/* A name that the scenario gave an entity; "" for none. */
struct entity_name {
    char text[ENTITY_NAME_MAX];
};

struct entity {
#define X(type, name) type name;
    ENTITY_FIELDS(X)
#undef X
    uint8_t unused; /* 0 */
};

/* Words of 8 bytes of a row: it has no byte that belongs to no field, so rows are compared and
 * hashed as they lie in memory. */
#define ENTITY_WORDS 36u
_Static_assert(sizeof(struct entity) == 8 * ENTITY_WORDS, "rows are hashed by words");

struct entities {
    uint32_t capacity;
    struct entity *row;
};

/* Bytes of a table of capacity rows, up to the next boundary of TABLE_ALIGN. */
size_t entities_bytes(uint32_t capacity);

/* Points the rows into base (aligned to TABLE_ALIGN, entities_bytes() long). */
void entities_bind(struct entities *entities, uint32_t capacity, void *base);

/* Copies rows first .. first + count - 1. */
void entities_copy(const struct entities *to, const struct entities *from, uint32_t first,
                   uint32_t count);

/* Sets row to zero in every field: a free slot. */
void entities_clear(const struct entities *entities, uint32_t row);

/* Row of the entity with this id among the first used rows, SLOT_NONE when it is gone. */
uint32_t entities_find(const struct entities *entities, uint32_t used, uint32_t id);

/* Asks the processor for a row that is read or written soon, or for what others ask of one: whoever
 * goes from row to row waits for memory otherwise. */
static inline void entity_prefetch(const struct entity *row)
{
    for (size_t at = 0; at < sizeof *row; at += 64)
        __builtin_prefetch((const unsigned char *)row + at);
}

static inline void entity_prefetch_pose(const struct entity *row)
{
    __builtin_prefetch(row);
    __builtin_prefetch((const unsigned char *)row + 64);
}

static inline bool entities_alive(const struct entities *e, uint32_t slot, uint32_t id)
{
    return slot < e->capacity && id != 0 && e->row[slot].id == id &&
           e->row[slot].state != ENTITY_FREE;
}

static inline struct vec3 entities_position(const struct entities *e, uint32_t i)
{
    return (struct vec3){e->row[i].x, e->row[i].y, e->row[i].z};
}

static inline struct vec3 entities_velocity(const struct entities *e, uint32_t i)
{
    return (struct vec3){e->row[i].vx, e->row[i].vy, e->row[i].vz};
}

/* Returns true if row i turns by its own spin. */
static inline bool entities_spins(const struct entities *e, uint32_t i)
{
    return e->row[i].spin_x != 0.0 || e->row[i].spin_y != 0.0 || e->row[i].spin_z != 0.0;
}

/* Returns true if row i neither moves nor turns. */
static inline bool entities_still(const struct entities *e, uint32_t i)
{
    return e->row[i].vx == 0.0 && e->row[i].vy == 0.0 && e->row[i].vz == 0.0 &&
           !entities_spins(e, i);
}

static inline void entities_set_position(const struct entities *e, uint32_t i, struct vec3 p)
{
    e->row[i].x = p.x;
    e->row[i].y = p.y;
    e->row[i].z = p.z;
}

static inline void entities_set_velocity(const struct entities *e, uint32_t i, struct vec3 v)
{
    e->row[i].vx = v.x;
    e->row[i].vy = v.y;
    e->row[i].vz = v.z;
}

#endif
