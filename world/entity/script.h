/* Scripts: what a vehicle does when, written before the run. Part of the static world: one struct
 * script for each vehicle that has one, its points moved to the vehicle's own place. */
#ifndef JOLON_WORLD_ENTITY_SCRIPT_H
#define JOLON_WORLD_ENTITY_SCRIPT_H

#include "world/entity/entity.h"

#include <stdint.h>

#define SCRIPT_FILE_MAX 64 /* [byte] of a waypoint file's name, with the NUL */

enum step_type {
    STEP_GO,        /* to a point, at its speed */
    STEP_ARRIVE,    /* to a point, there at its time */
    STEP_FACE,      /* turns on the spot, aircraft as they fly */
    STEP_STOP,      /* brakes until it stands */
    STEP_WAIT,      /* does nothing for a while */
    STEP_FIRE,      /* one shot at a vehicle */
    STEP_FIRE_AT,   /* one shot at a point on the ground */
    STEP_CONTROLS,  /* throttle, steer and climb as a driver would hold them */
    STEP_ALTITUDE,  /* climbs or sinks to its height */
    STEP_BEHAVIOUR, /* back to its agent */
    STEP_TYPE_COUNT
};

#define STEP_AT_ONCE       (-1.0) /* when the step before it has ended */
#define STEP_SAME_ALTITUDE (-1.0) /* of the step before it; in scenarios, not in worlds */

struct script_step {
    double at_s;   /* [s] from the script's beginning: of arrive when it ends, of all others when
                      it begins, whatever the step before it has come to; or STEP_AT_ONCE */
    double x, z;   /* [m] go, arrive, fire at */
    double amount; /* go: [m/s], 0: its agent's own; face: [rad]; wait, controls: [s] */
    double altitude_m;            /* aircraft: above the ground, in this step */
    float throttle, steer, climb; /* controls: -1..1 */
    uint32_t type;                /* enum step_type */
    uint32_t target_slot;         /* fire: initial slot */
    uint32_t behaviour;           /* enum behaviour, its new order */
    uint32_t order_arg;           /* that order's own */
    uint32_t halt;     /* go, arrive: 1: it stands at the point, what comes next needs it */
    uint32_t next_due; /* of the script's: the next step that begins at its time, whatever is before
                          it; UINT32_MAX: none */
    uint32_t reserved;
};

struct script {
    char name[ENTITY_NAME_MAX]; /* the scenario's, for people */
    uint32_t first, count;      /* steps; at least one */
    uint32_t reacts;            /* 1: fights or flees when fired upon, then goes on */
    uint32_t repeats;           /* 1: begins again after its last step */
    double period_s; /* [s] where it repeats by the clock: pass n begins n times as late; else 0 */
};

_Static_assert(sizeof(struct script_step) == 80, "shared layout");
_Static_assert(sizeof(struct script) == 48, "shared layout");

#endif
