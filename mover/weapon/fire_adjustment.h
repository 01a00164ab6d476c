/* Adjustment of a battery's fire by observers (fire_mission.h). */
#ifndef JOLON_MOVER_WEAPON_FIRE_ADJUSTMENT_H
#define JOLON_MOVER_WEAPON_FIRE_ADJUSTMENT_H

#include "mover/context/serial_context.h"
#include "mover/weapon/fire.h"
#include "world/entity/battery.h"

/* Returns the unit vector on the map along which the battery's rounds come. */
struct vec3 fire_adjustment_line(const struct battery *battery);

/* Notes where a round for adjustment with this error falls, off the target. */
void fire_adjustment_note(const struct serial_context *context, struct battery *battery,
                          struct fire_error error);

/* Corrects the aim by what an observer sees of that round: its side along the range, and how far it
 * is aside. Begins the fire for effect after the last correction, or if nobody sees the target. */
void fire_adjustment_correct(const struct serial_context *context, struct battery *battery);

#endif
