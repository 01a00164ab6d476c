/* Batteries of howitzers: what each fires at, and how far its mission has come. A part of the head
 * of the state, so that a mission goes on after the mover was killed. */
#ifndef JOLON_WORLD_ENTITY_BATTERY_H
#define JOLON_WORLD_ENTITY_BATTERY_H

#include <stdint.h>

#define BATTERIES_MAX    8u /* that fire or cool down at one time */
#define BATTERY_GUNS_MAX 8u

enum battery_phase {
    BATTERY_DONE,    /* nothing more to fire; the entry remains until the guns have cooled */
    BATTERY_ADJUSTS, /* one gun fires, and an observer corrects it */
    BATTERY_FIRES    /* all guns fire */
};

struct battery {
    double x, z;              /* [m] the target */
    double aim_x, aim_z;      /* [m] the point at which the guns aim */
    float survey_x, survey_z; /* [m] the error of the target's place, less what was corrected */
    float mean_range;         /* the error of this mission's mean, as a share of the range */
    float mean_azimuth;       /* [rad] the same across the line of fire */
    float azimuth;            /* [rad] of the line of departure, clockwise from north */
    float elevation;          /* [rad] of the line of departure */
    float flight_s;           /* 0: these three are not known yet */
    float fell_x, fell_z;     /* [m] where the last round for adjustment falls, off the target */
    float step_m;             /* of the last correction along the range; positive: further */
    uint32_t volley_tick;     /* when the present volley began */
    uint32_t number;          /* of the mission, from 1 */
    uint32_t next_tick;       /* of the next volley, or when the next correction is due */
    uint32_t cold_tick;       /* until then the barrels bear no more rounds at the highest rate */
    uint32_t rounds;          /* that are left for effect */
    uint32_t gun_slot[BATTERY_GUNS_MAX];
    uint32_t gun_id[BATTERY_GUNS_MAX]; /* 0: none */
    uint32_t fired;                    /* bit i: gun i has fired in this volley */
    uint16_t munition;                 /* kind */
    uint8_t phase;                     /* enum battery_phase */
    uint8_t fuze;                      /* enum fuze */
    uint8_t force;                     /* enum force */
    uint8_t high;                      /* 1: the higher of the two arcs */
    uint8_t bracketed;                 /* 1: rounds have fallen beyond and short of the target */
    uint8_t guns;                      /* entries of gun_slot */
};

_Static_assert(sizeof(struct battery) % 8 == 0, "no padding at the end");

#endif
