/* The tables of behaviour, one for each doctrine. A row is {from these behaviours, when there are
 * all of these percepts, unless there is one of those, to this behaviour, for this reason, for this
 * time}. The first row that applies wins, and a change of behaviour is an event. Behaviour changes
 * only by a row. Constant data; any thread. */
#ifndef JOLON_MOVER_AGENT_BEHAVIOUR_TABLE_H
#define JOLON_MOVER_AGENT_BEHAVIOUR_TABLE_H

#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"

#include <stdbool.h>
#include <stdint.h>

/* What an agent perceives (perception.c). Events last for one frame, states as long as they are
 * true. Percepts marked * are found only when the agent looks. */
enum perceived {
    PERCEPT_NO_FUEL,      /* its tank is empty */
    PERCEPT_SHOT,         /* event: an active vehicle has fired at it */
    PERCEPT_BUMP,         /* event: it ran into something */
    PERCEPT_HURT,         /* event: its damage grew, to med or more */
    PERCEPT_TIME_OVER,    /* the time of its behaviour is over */
    PERCEPT_TARGET,       /* the vehicle that it attacks or flees from is active */
    PERCEPT_TARGET_GONE,  /* that vehicle was destroyed or removed */
    PERCEPT_ARRIVED,      /* it withdraws and is at its base */
    PERCEPT_LEASE_OVER,   /* event: its driver has sent no command in time */
    PERCEPT_ENEMY,        /* *event: it sees an enemy */
    PERCEPT_OUTNUMBERED,  /* *event: many more enemies than friends are near */
    PERCEPT_NO_ROUNDS,    /* it has no rounds left, or none for a target so far away */
    PERCEPT_LOW_FUEL,     /* *its fuel is only just enough for the path to its base */
    PERCEPT_ARMED,        /* it can fire, and its orders are not to hold fire */
    PERCEPT_AT_WILL,      /* its orders are to attack enemies on sight */
    PERCEPT_STAND,        /* its orders are never to flee or withdraw, or it cannot drive */
    PERCEPT_SUPPRESSED,   /* event: a charge has burst near it, or air defence fires at it */
    PERCEPT_STALLED,      /* event: it has driven for some time and not got on */
    PERCEPT_STUCK_FAST,   /* event: and has tried for minutes */
    PERCEPT_ROUNDS_FIRED, /* its salvo or its pass is over */
    PERCEPT_LOSSES,       /* it is fired upon, and half of its group, or its gun, is lost */
    PERCEPT_OUTGUNNED,    /* *its rounds cannot harm the enemy that fires at it or that it sees */
    PERCEPT_COVER,        /* it is fired upon, and a place near by hides it from the shooter */
    PERCEPT_BRAVE,        /* its courage holds: drawn at random when an event tests it */
    PERCEPT_COUNT
};

#define BEHAVIOUR_TABLE_FIGHT_S 45 /* an attack ends so long after the target was last seen */

/* As the behaviour of a row: the agent's order. */
#define BEHAVIOUR_TABLE_ORDER BEHAVIOUR_COUNT

struct behaviour_table_row {
    uint32_t from;   /* bits 1 << enum behaviour */
    uint32_t when;   /* bits 1 << enum perceived: all of them */
    uint32_t unless; /* none of them */
    uint8_t to;      /* enum behaviour, or BEHAVIOUR_TABLE_ORDER */
    uint8_t because; /* enum agent_reason */
    uint16_t time_s; /* how long; 0: until another row applies */
};

/* How an agent fights (attack.c). */
enum manner {
    MANNER_STAND_OFF, /* drives up to its distance, stops, and fires */
    MANNER_HOVER,     /* the same in the air, changing sides now and then */
    MANNER_PASS,      /* flies over its target and away, and turns for the next pass */
    MANNER_CHARGE,    /* drives straight into its target */
    MANNER_COUNT
};

struct behaviour_table {
    const struct behaviour_table_row *row;
    uint32_t rows;
    enum manner manner;
    double stand_off;  /* share of its range at which it fights */
    double resupply_s; /* fills an empty tank and empty racks */
};

extern const struct behaviour_table behaviour_tables[DOCTRINE_COUNT];

/* The row that applies to a behaviour and percepts; NULL: none does. */
const struct behaviour_table_row *behaviour_table_next(const struct behaviour_table *table,
                                                       enum behaviour behaviour, uint32_t percepts);

/* Returns true if another row applies with the percepts `also` added. */
bool behaviour_table_differs(const struct behaviour_table *table, enum behaviour behaviour,
                             uint32_t percepts, uint32_t also);

#endif
