/* Scripts: the actions of a vehicle, written before the run. Part of the static world: one struct
 * script for each vehicle that has one; its points are moved to the vehicle's place. */
#ifndef JOLON_WORLD_ENTITY_SCRIPT_H
#define JOLON_WORLD_ENTITY_SCRIPT_H

#include "world/entity/entity.h"

#include <stdint.h>

#define SCRIPT_FILE_MAX 64 /* [byte] of a waypoint file's name, with the NUL */

enum step_type {
    STEP_GO,        /* to a point, at its speed */
    STEP_ARRIVE,    /* to a point, reached at its time */
    STEP_FACE,      /* turns on the spot, aircraft in flight */
    STEP_STOP,      /* brakes to a halt */
    STEP_WAIT,      /* does nothing for a while */
    STEP_FIRE,      /* one shot at a vehicle */
    STEP_FIRE_AT,   /* one shot at a point on the ground */
    STEP_CONTROLS,  /* holds throttle, steer and climb, as a driver does */
    STEP_ALTITUDE,  /* climbs or descends to its height */
    STEP_BEHAVIOUR, /* back to its agent */
    STEP_TYPE_COUNT
};

#define STEP_AT_ONCE       (-1.0) /* when the step before it has ended */
#define STEP_SAME_ALTITUDE (-1.0) /* of the step before it; used in scenarios only */

struct script_step {
    double at_s;       /* [s] from the script's beginning: when arrive ends, and when any other step
                          begins, even if the step before it has not ended; or STEP_AT_ONCE */
    double x, z;       /* [m] go, arrive, fire at */
    double amount;     /* go: [m/s], 0: its agent's own; face: [rad]; wait, controls: [s] */
    double altitude_m; /* aircraft: above the ground, in this step */
    float throttle, steer, climb; /* controls: -1..1 */
    uint32_t type;                /* enum step_type */
    uint32_t target_slot;         /* fire: initial slot */
    uint32_t behaviour;           /* enum behaviour, its new order */
    uint32_t order_arg;           /* argument of that order */
    uint32_t halt;     /* go, arrive: 1: it halts at the point, since the next step needs it */
    uint32_t next_due; /* the script's next step with a begin time, which cuts off all before it;
                          UINT32_MAX: none */
    uint32_t reserved;
};

struct script {
    char name[ENTITY_NAME_MAX]; /* the scenario's name, for people */
    uint32_t first, count;      /* steps; at least one */
    uint32_t reacts;            /* 1: fights or flees when fired upon, then goes on */
    uint32_t repeats;           /* 1: begins again after its last step */
    double period_s; /* [s] if it repeats by the clock: pass n begins n times this later; else 0 */
};

_Static_assert(sizeof(struct script_step) == 80, "shared layout");
_Static_assert(sizeof(struct script) == 48, "shared layout");

#endif
