/* Firing data for arcs: at which elevation a howitzer's shell meets a point, on the lower or the
 * higher of the two arcs. A table of ranges by elevation, made when the mover starts, begins the
 * search; the shell's whole flight is then computed until it meets the point. Pure; any thread. */
#ifndef JOLON_MOVER_WEAPON_FIRING_ARC_H
#define JOLON_MOVER_WEAPON_FIRING_ARC_H

#include "world/maths/maths.h"

#include <stdbool.h>

#define FIRING_ARC_ROWS    35u /* elevations of 0 to 85 degrees */
#define FIRING_ARC_ROW_RAD (2.5 * RAD_PER_DEG)
#define FIRING_ARC_MISS_M  1.0 /* a solution passes so near to its point */
#define FIRING_ARC_BURST_M 8.0 /* height over the point of a burst in the air */

struct kind;

struct firing_arc {
    const struct kind *munition;
    double range_m[FIRING_ARC_ROWS];  /* at the height of the muzzle, at sea level, without wind */
    double by_speed[FIRING_ARC_ROWS]; /* relative growth of the range by that of the speed */
    unsigned furthest;                /* the row of the greatest range */
};

/* What a solution is for. */
struct firing_arc_aim {
    struct vec3 muzzle, point; /* [m, world] */
    struct vec3 wind;          /* [m/s] */
    bool high;                 /* the higher arc */
};

struct firing_arc_solution {
    double azimuth_rad;   /* of the line of departure, clockwise from north */
    double elevation_rad; /* of it, above the level */
    double flight_s;
    double by_speed;  /* relative growth of the range by that of the muzzle's speed */
    struct vec3 fall; /* [m/s] the velocity at the point */
};

/* munition: must outlive the table. Only a kind with DELIVERY_ARC has one. */
void firing_arc_make(struct firing_arc *arc, const struct kind *munition);

/* Finds the solution. Returns false if the point is out of range. About 0.1 ms. */
bool firing_arc_solve(const struct firing_arc *arc, const struct firing_arc_aim *aim,
                      struct firing_arc_solution *solution);

/* Returns about the direction (unit) of the solution, by the table alone: within 10 mrad. Beyond
 * the range it is that of the furthest shot. */
struct vec3 firing_arc_direction(const struct firing_arc *arc, struct vec3 muzzle,
                                 struct vec3 point);

/* Returns the unit vector of an azimuth and an elevation. */
struct vec3 firing_arc_unit(double azimuth_rad, double elevation_rad);

/* Where a round of the kind is that left `at` with this velocity frames of dt_s ago. */
void firing_arc_follow(const struct kind *munition, struct vec3 wind, unsigned frames, double dt_s,
                       struct vec3 *at, struct vec3 *velocity);

/* Finds where a round of the kind that begins with this position and velocity falls to a height
 * [m]: a bomb that is released, or a shell. Returns its time of flight [s], at most 300. */
double firing_arc_fall(const struct kind *munition, struct vec3 wind, double height_m,
                       struct vec3 *at, struct vec3 *velocity);

#endif
