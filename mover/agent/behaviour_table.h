/* Doctrines: what each sort of vehicle does about what it notices. A doctrine is a table of rows
 * {from these behaviours, when all of this is noticed, unless any of that is, to this behaviour,
 * for this reason, for so long}; the first row that applies wins, and is an event when the
 * behaviour changes. What is not in a table does not happen. Pure data; any thread. */
#ifndef JOLON_MOVER_AGENT_BEHAVIOUR_TABLE_H
#define JOLON_MOVER_AGENT_BEHAVIOUR_TABLE_H

#include "world/entity/entity.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"

#include <stdint.h>

/* What an agent notices: perception.c says when. Events last for one frame, states as long as they
 * hold; those marked * are looked for in its turn only. */
enum percept {
    PERCEPT_NO_FUEL,     /* its tank is empty */
    PERCEPT_SHOT,        /* event: somebody who still lives has fired at it */
    PERCEPT_BUMP,        /* event: it ran into something */
    PERCEPT_HURT,        /* event: its damage grew, to med or more */
    PERCEPT_TIME_OVER,   /* its behaviour's time is up */
    PERCEPT_TARGET,      /* who it attacks or flees is alive */
    PERCEPT_TARGET_GONE, /* it is not: destroyed, or removed */
    PERCEPT_ARRIVED,     /* where it withdraws to */
    PERCEPT_LEASE_OVER,  /* event: its driver was not heard from any more */
    PERCEPT_ENEMY,       /* *event: it sees an enemy */
    PERCEPT_OUTNUMBERED, /* *event: many more enemies than friends are near */
    PERCEPT_NO_ROUNDS,   /* it has fired all that it had */
    PERCEPT_LOW_FUEL,    /* *just enough is left to get home */
    PERCEPT_ARMED,       /* it can fire, and may: not under orders to hold its fire */
    PERCEPT_AT_WILL,     /* its orders are to engage whom it sees */
    PERCEPT_STAND,       /* its orders are never to flee or withdraw */
    PERCEPT_BRAVE,       /* its courage holds this time: drawn when one of the events needs it */
    PERCEPT_COUNT
};

#define BEHAVIOUR_TABLE_FIGHT_S    45 /* without a sight of the target or another shot at it */
#define BEHAVIOUR_TABLE_RESUPPLY_S 20 /* in which an empty tank and empty racks are filled */

/* A row's goal that is no behaviour: what it was ordered to do. */
#define BEHAVIOUR_TABLE_ORDER BEHAVIOUR_COUNT

struct behaviour_table_row {
    uint32_t from;   /* bits 1 << enum behaviour */
    uint32_t when;   /* bits 1 << enum percept: all of them */
    uint32_t unless; /* none of them */
    uint8_t to;      /* enum behaviour, or BEHAVIOUR_TABLE_ORDER */
    uint8_t because; /* enum agent_reason */
    uint16_t time_s; /* how long, 0: until something ends it */
};

/* How it fights: attack.c. */
enum manner {
    MANNER_STAND_OFF, /* drives up to its distance, stops, and fires */
    MANNER_HOVER,     /* the same in the air, and to another side now and then */
    MANNER_PASS,      /* flies at its target, over it and away, and turns for the next pass */
    MANNER_CHARGE,    /* straight into it */
    MANNER_COUNT
};

struct behaviour_table {
    const struct behaviour_table_row *row;
    uint32_t rows;
    enum manner manner;
    double stand_off; /* share of its range at which it fights */
};

extern const struct behaviour_table behaviour_tables[DOCTRINE_COUNT];

/* The row that applies to a behaviour and what is noticed, NULL when none does. */
const struct behaviour_table_row *behaviour_table_next(const struct behaviour_table *table,
                                                       enum behaviour behaviour, uint32_t percepts);

#endif
