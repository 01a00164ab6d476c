/* Which vehicle, and which target: choices among what the world said last. Pure. */
#ifndef JOLON_CLIENTS_DRIVE_VEHICLE_CHOICE_H
#define JOLON_CLIENTS_DRIVE_VEHICLE_CHOICE_H

#include "ipc/topics/world_mirror.h"

/* Whom a choice is for and what it must be. */
struct vehicle_choice {
    uint64_t source; /* ours: vehicles of other drivers are not offered */
    uint32_t from;   /* id of the present vehicle, 0: none */
    int force;       /* enum force, -1: any */
    int kind;        /* index, -1: any */
};

/* The vehicle with the next higher id (by 1) or the next lower (by -1), round and round; 0: none.
 */
uint32_t vehicle_choice_next(const struct world_mirror *mirror, const struct vehicle_choice *choice,
                             int by);

/* The nearest to the present one, which is not itself; without a present one the first. 0: none. */
uint32_t vehicle_choice_nearest(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice);

/* By what people write: an id, a name, a kind or a force. 0 with the reason when there is none. */
uint32_t vehicle_choice_by_text(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice, const char *text,
                                struct error_text *error);

/* The next target: of the enemies within cone_rad to either side of bearing_rad and within range_m,
 * the nearest, or the next further one after the present target; round and round. 0: none. */
uint32_t vehicle_choice_target(const struct world_mirror *mirror, const jolon_Entity *self,
                               uint32_t present, double bearing_rad, double cone_rad,
                               double range_m);

/* The nearest of whatever force in that direction, wrecks too; NULL: nothing. */
const jolon_Entity *vehicle_choice_seen(const struct world_mirror *mirror, const jolon_Entity *self,
                                        double bearing_rad, double cone_rad, double range_m);

/* Is it a vehicle that can be driven, of whomever? */
bool vehicle_choice_drivable(const struct world_mirror *mirror, const jolon_Entity *entity);

/* Bearing [rad, clockwise from north], distance and height difference from one to the other. */
struct relative_position {
    double bearing_rad, distance_m, up_m;
};
struct relative_position vehicle_choice_relative(const jolon_Entity *from, const jolon_Entity *to);

#endif
