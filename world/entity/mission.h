/* Missions: what groups of vehicles are to do, phase by phase, and what has become of it. The
 * structs of the first part are the static world; those of the second are in the head of a world
 * buffer, and only the mover changes them (mover/mission.h). */
#ifndef JOLON_WORLD_ENTITY_MISSION_H
#define JOLON_WORLD_ENTITY_MISSION_H

#include "world/entity/entity.h"

#include <stdint.h>

#define MISSIONS_MAX          48u
#define MISSION_PHASES_MAX    64u /* of one mission; reactions are phases, too */
#define MISSION_REACTIONS_MAX 32u
#define OBJECTIVES_MAX        16u
#define MISSION_NONE          UINT32_MAX /* no objective, no mission, no area, no route */
#define MISSION_KEEP_FIRE     UINT32_MAX /* as a phase's engage: by its order */

/* What a group does in a phase. */
enum mission_order {
    MISSION_HOLD,     /* it stays where it is */
    MISSION_RESERVE,  /* the same, until it is called */
    MISSION_MOVE,     /* along a route, and stays at its end */
    MISSION_BOUND,    /* the same; one vehicle of a pair moves while the other one watches */
    MISSION_ATTACK,   /* into an area, firing at will */
    MISSION_DEFEND,   /* the same, to stay there */
    MISSION_WITHDRAW, /* along a route or into an area at once, even out of a fight */
    MISSION_PATROL,   /* from goal to random goal of an area */
    MISSION_STRIKE,   /* the same in the air, against all that is there */
    MISSION_BARRAGE,  /* rounds on random points of an area */
    MISSION_RESUPPLY, /* into an area, where rounds and fuel fill up */
    MISSION_ORDER_COUNT
};

/* The conditions of a phase, as bits of mission_conditions.logic. */
enum mission_condition {
    MISSION_IF_FOR,
    MISSION_IF_AT,
    MISSION_IF_ARRIVED,
    MISSION_IF_TAKEN,
    MISSION_IF_LOST,
    MISSION_IF_BELOW,
    MISSION_IF_ENEMY_IN,
    MISSION_IF_AFTER,
    MISSION_CONDITION_COUNT
};
#define MISSION_ALL 256u /* of logic: all conditions that are given must hold */

/* Each member is one condition. One that holds is enough, unless logic has MISSION_ALL. */
struct mission_conditions {
    double for_s;           /* [s] since the phase began; negative: none */
    double at_s;            /* [s] since the battle began; negative: none */
    double arrived;         /* share of the group at the end of its route or in its area; 0: none */
    double below;           /* its strength is below this share; 0: none */
    uint32_t taken;         /* objective that its force holds; MISSION_NONE */
    uint32_t lost;          /* objective that its force does not hold */
    uint32_t enemy_in;      /* objective with enemies in it */
    uint32_t after_mission; /* whose phase ... */
    uint32_t after_phase;   /* ... has ended */
    uint32_t logic;         /* bit n: condition n must not hold; and MISSION_ALL */
};

struct battle_phase {
    char name[ENTITY_NAME_MAX];
    struct mission_conditions until; /* of its end */
    struct mission_conditions when;  /* of the beginning of a reaction */
    double at_least_s;               /* [s] it does not end before */
    double rounds_a_minute;          /* barrage */
    double bearing_rad;              /* barrage from off the map: where the battery stands */
    uint32_t order;                  /* enum mission_order */
    uint32_t engage;                 /* ENTITY_FLAG_FIRE_AT_WILL, _HOLD_FIRE or 0 */
    uint32_t route, area;            /* MISSION_NONE: none */
    uint32_t munition;               /* of a barrage; KIND_NONE: that of the group's own guns */
    uint32_t adjusted;               /* 1: an observer corrects the barrage */
};

struct mission {
    char name[ENTITY_NAME_MAX];
    uint32_t force;
    uint32_t first_phase, phase_count;
    uint32_t reaction_count; /* they stand behind the phases */
    uint32_t first_member, member_count;
};

struct objective {
    char name[ENTITY_NAME_MAX];
    double x0, z0, x1, z1;
    uint32_t owner; /* enum force, when a battle begins */
    uint32_t reserved;
};

/* --- state -------------------------------------------------------------------------------------*/

struct mission_state {
    uint32_t since_tick; /* when its phase began */
    uint32_t reacted;    /* bit n: reaction n has happened in this battle */
    uint16_t phase;      /* of the mission: from phase_count on a reaction */
    uint16_t resume;     /* 1 + the phase that a reaction interrupted; 0: none */
    uint16_t able;       /* vehicles that are active */
    uint16_t begun;      /* the same when the battle began */
};

struct objective_state {
    uint32_t since_tick;           /* when it was taken */
    uint16_t present[FORCE_COUNT]; /* active vehicles on the ground and on the water in it */
    uint8_t owner;                 /* enum force */
    uint8_t reserved;
};

struct battle_state {
    uint32_t round; /* the battle: 1, 2, ...; 0: it has not begun */
    uint32_t round_tick;
    uint32_t ended_tick;         /* 0: it goes on */
    uint32_t winner;             /* enum force; FORCE_NEUTRAL: nobody */
    uint32_t begun[FORCE_COUNT]; /* active vehicles when it began ... */
    uint32_t able[FORCE_COUNT];  /* ... and when it ended */
    struct mission_state mission[MISSIONS_MAX];
    struct objective_state objective[OBJECTIVES_MAX];
};

_Static_assert(sizeof(struct mission_state) == 16, "shared layout");
_Static_assert(sizeof(struct objective_state) == 12, "shared layout");
_Static_assert(sizeof(struct mission_conditions) == 56, "shared layout");

#endif
