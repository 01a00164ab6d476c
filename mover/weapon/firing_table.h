/* Firing tables: how long a round flies to a range, and how far it drops on the way. One for each
 * kind of munition, made from the kinds when the mover starts and read-only afterwards; any thread.
 * The tables hold for flat fire in air of sea level: the line of departure is inclined by less than
 * about 20 degrees. For arcs there is firing_arc.h. */
#ifndef JOLON_MOVER_WEAPON_FIRING_TABLE_H
#define JOLON_MOVER_WEAPON_FIRING_TABLE_H

#include "mover/weapon/firing_arc.h"

#define FIRING_TABLE_STEP_M 50.0
#define FIRING_TABLE_ROWS   256u /* to 12,750 m */

struct kind;

struct firing_table {
    const struct kind *munition;
    double flight_s[FIRING_TABLE_ROWS];
    double drop_m[FIRING_TABLE_ROWS];
    struct firing_arc arc; /* of a munition with DELIVERY_ARC */
};

/* A point of a trajectory. */
struct firing_data {
    double flight_s; /* time since the muzzle */
    double drop_m;   /* below the line of departure */
};

/* munition: must outlive the table. */
void firing_table_make(struct firing_table *table, const struct kind *munition);

/* Returns the data for a range along the line of departure [m] from a muzzle at a height over the
 * sea [m]. Beyond the table, or where the round has stopped, the last interval goes on. A homing
 * munition flies straight at full speed; neither it nor a kind without drag needs the table. */
struct firing_data firing_table_at(const struct firing_table *table, double range_m,
                                   double height_m);

#endif
