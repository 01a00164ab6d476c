/* Fire missions: batteries of howitzers that fire many rounds at a point. A battery is a howitzer
 * and those of its force within FIRE_MISSION_BATTERY_M of it, or six guns that are off the map. All
 * in the serial part of the step; the state is in the head (world/entity/battery.h).
 *
 * With adjustment, one gun fires first. The target's place is known with a survey error only. An
 * observer, which is any vehicle of the force that sees the target, tells whether a round falls
 * beyond or short of it, and how far aside. The range is bracketed: the first correction is 200 m,
 * and corrections halve once rounds have fallen on both sides. After a correction of 50 m all guns
 * fire for effect. Without an observer they do so at once.
 *
 * Each gun fires 12 rounds at its kind's reload_s and then one a minute; a barrel that rests
 * recovers at the same rate. */
#ifndef JOLON_MOVER_WEAPON_FIRE_MISSION_H
#define JOLON_MOVER_WEAPON_FIRE_MISSION_H

#include "mover/context/serial_context.h"

#define FIRE_MISSION_BATTERY_M 300.0
#define FIRE_MISSION_AFAR_GUNS 6u /* of a battery that is off the map */

/* What a battery shall fire. Scenarios and missions give such orders. */
struct fire_mission_order {
    double x, z;        /* [m] the target */
    double bearing_rad; /* of a battery off the map: from the target to it */
    double left_s;      /* the same: from the appearance of a shell to its impact */
    uint32_t gun;       /* row of a howitzer; SLOT_NONE: a battery off the map */
    uint32_t rounds;    /* for effect, of all guns together */
    uint16_t munition;  /* kind; KIND_NONE: the gun's own */
    uint8_t force;      /* of a battery off the map: whose observers adjust it */
    uint8_t fuze;       /* enum fuze; FUZE_COUNT: the munition's own */
    bool adjusted;
    bool high; /* along the higher arc */
};

/* Gives a battery its mission, in place of the one that it has. Returns false, with nothing
 * changed, if the row is no howitzer that can fire, or BATTERIES_MAX others fire or cool. A point
 * that turns out to be out of range ends the mission. */
bool fire_mission_begin(struct serial_context *context, const struct fire_mission_order *order);

/* Returns true if the row is a howitzer that has rounds, has no mission and whose range contains
 * the point. */
bool fire_mission_can(const struct serial_context *context, uint32_t row, double x, double z);

/* Returns the first row of a howitzer of the force that has rounds, has no mission and whose range
 * contains the point, or SLOT_NONE. */
uint32_t fire_mission_gun(const struct serial_context *context, uint8_t force, double x, double z);

/* Lays the guns of all batteries, fires and corrects. Once a frame. */
void fire_mission_run(struct serial_context *context);

#endif
