/* The data shared by all functions that move one row, and the types by which they pass motion on.
 * Such a function reads the committed world and writes row i of the moved table only, so rows may
 * be moved in any order, by any thread. */
#ifndef JOLON_MOVER_CONTEXT_STEP_CONTEXT_H
#define JOLON_MOVER_CONTEXT_STEP_CONTEXT_H

#include "mover/query/line_of_sight.h"
#include "mover/query/neighbour_index.h"
#include "world/entity/cruise.h"
#include "world/entity/entity.h"
#include "world/entity/mass_properties.h"
#include "world/state.h"

struct avoidance;
struct crater_index;
struct firing_table;
struct ground_marks;
struct neighbour_lists;
struct square_bounds;
struct terrain_cache_entry;
struct world;

struct step_context {
    const struct world *world;
    const struct state *committed;
    struct entities *m; /* the moved table */
    /* Of the committed world. */
    const struct crater_index *craters;
    const struct neighbour_index *neighbours;
    const struct neighbour_lists *neighbour_lists;
    const struct line_of_sight *line_of_sight;
    const struct ground_marks *ground_marks;
    const struct square_bounds *slopes;
    const struct avoidance *avoidance;
    const struct firing_table *firing_tables; /* [kinds of files] */
    /* [capacity] Caches of the ground: about row i's position, and where an aircraft soon will be.
     * Written with row i. */
    struct terrain_cache_entry *terrain_entries, *terrain_entries_ahead;
    uint64_t tick;         /* of the frame being made */
    uint32_t think_frames; /* [frame] from one decision of an agent to the next */
    uint32_t
        look_frames;     /* [frame] from one of its looks to the next, a multiple of think_frames */
    uint32_t aim_frames; /* [frame] from one attempt to fire to the next */
    uint32_t cruise_frames; /* [frame] of the longest stretch; 1: no vehicle cruises */
    uint32_t cruise_short;  /* [frame] of a stretch of CRUISE_S, the longest at sea, and in the air
                               except in a crowd */
    uint32_t cruise_phase;  /* tick modulo cruise_frames */
    uint32_t cruise_group_bits; /* 2^this many rows begin their stretches together */
    double dt_s;
    struct vec3 wind; /* [m/s] */
};

/* Returns true if row i's agent decides in this frame. */
static inline bool step_context_thinks(const struct step_context *context, uint32_t i)
{
    return neighbour_index_divides(context->neighbours->think_divisor,
                                   (uint32_t)context->tick + context->m->row[i].id);
}

/* Returns the tick of a table: of the committed one, or of the moved one. */
static inline uint64_t step_context_tick(const struct step_context *context,
                                         const struct entities *e)
{
    return e == context->m ? context->tick : context->tick - 1;
}

/* Return where a row is that may cruise [m], how fast [m/s], and where it heads [rad]. */
static inline struct vec3 step_context_position(const struct step_context *context,
                                                const struct entities *e, uint32_t i)
{
    return cruise_position(e, i, step_context_tick(context, e), context->dt_s);
}

static inline struct vec3 step_context_velocity(const struct step_context *context,
                                                const struct entities *e, uint32_t i)
{
    return cruise_velocity(e, i, step_context_tick(context, e), context->dt_s);
}

static inline double step_context_heading(const struct step_context *context,
                                          const struct entities *e, uint32_t i)
{
    return cruise_heading(e, i, step_context_tick(context, e), context->dt_s);
}

/* The motion of a vehicle in this frame that an agent, a script or a driver has chosen. */
struct desired_motion {
    double heading_rad;
    double speed_mps;  /* negative: backwards */
    double altitude_m; /* aircraft: above the ground; not when driven */
    bool shunts;       /* it turns by driving to and fro (mover/agent/driving/shunting.h) */
    bool held;         /* by an agent's controls: `turn` says what heading_rad says */
    bool driven;       /* by a command; the members below are a driver's alone */
    enum gearing gear; /* land vehicles and ships */
    double turn;       /* -1..1 of the kind's turn rate, instead of heading_rad */
    double climb_mps;  /* aircraft, instead of altitude_m */
    double brake;      /* 0..1 of the hardest braking */
    double power;      /* aeroplanes: 0..1 of the thrust that the throttle allows */
    double hand_brake; /* 0..1: holds the wheels that do not steer, or the tracks */
};

#define BRAKES 2.0 /* the hardest braking, in multiples of the kind's acceleration */

/* The trigger field: a row's requests to the serial part of the step. */
#define TRIGGER_FIRE         1u
#define TRIGGER_FIRE_AT      2u        /* at its goal, a point on the ground */
#define TRIGGER_REASON_SHIFT 2u        /* above: enum agent_reason + 1 of a change of behaviour */
#define TRIGGER_BROKEN       UINT8_MAX /* alone: a wreck has broken up */
#define TRIGGER_AGROUND                                                                            \
    (UINT8_MAX - 2)                        /* alone: a ship has run aground, or an aircraft has    \
                                            * touched down hard */
#define TRIGGER_LEFT_WORLD (UINT8_MAX - 1) /* alone: it has crossed the edge of the world */

#endif
