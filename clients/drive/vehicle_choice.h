/* Chooses vehicles and targets from the world's last data. Pure. */
#ifndef JOLON_CLIENTS_DRIVE_VEHICLE_CHOICE_H
#define JOLON_CLIENTS_DRIVE_VEHICLE_CHOICE_H

#include "ipc/topics/world_mirror.h"

/* The client that chooses, and what the vehicle must be. */
struct vehicle_choice {
    uint64_t source; /* of this client's commands: vehicles of other drivers are left out */
    uint32_t from;   /* id of the present vehicle, 0: none */
    int force;       /* enum force, -1: any */
    int kind;        /* index, -1: any */
};

/* Returns the vehicle with the next higher id (by 1) or the next lower one (by -1). The first
 * follows the last. 0: there is none. */
uint32_t vehicle_choice_next(const struct world_mirror *mirror, const struct vehicle_choice *choice,
                             int by);

/* Returns the vehicle nearest to the present one; without a present one, that with the lowest id.
 * 0: there is none. */
uint32_t vehicle_choice_nearest(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice);

/* Returns the vehicle of an id or a name, or the nearest of a kind or a force; 0, with the error,
 * if there is none. */
uint32_t vehicle_choice_by_text(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice, const char *text,
                                struct error_text *error);

/* Returns the next target: of the enemies within range_m and within cone_rad to either side of
 * bearing_rad, the next one beyond the present target, or else the nearest one. 0: none. */
uint32_t vehicle_choice_target(const struct world_mirror *mirror, const jolon_Entity *self,
                               uint32_t present, double bearing_rad, double cone_rad,
                               double range_m);

/* Returns the nearest vehicle or wreck of any force in that direction, or NULL. */
const jolon_Entity *vehicle_choice_seen(const struct world_mirror *mirror, const jolon_Entity *self,
                                        double bearing_rad, double cone_rad, double range_m);

/* Returns true if the entity is a vehicle that can be driven, whether or not a client drives it. */
bool vehicle_choice_drivable(const struct world_mirror *mirror, const jolon_Entity *entity);

/* Bearing [rad, clockwise from north], distance and height difference from one entity to another.
 */
struct relative_position {
    double bearing_rad, distance_m, up_m;
};
struct relative_position vehicle_choice_relative(const jolon_Entity *from, const jolon_Entity *to);

#endif
