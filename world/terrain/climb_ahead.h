/* The rate of climb that a way over the ground needs, and the speed that the ground allows.
 *
 * A way begins at an aircraft, turns, and goes straight on. For each place on it the ground there,
 * as high as the body reaches to its sides, gives a height, and so do the tops of fixed objects
 * beside it. The aircraft has to be so high when its nose comes there. It changes its climb at a
 * bounded acceleration, so a descent has to end first. Where its climb does not suffice it has to
 * come later: from the speed that the result allows it comes late enough if it brakes all the way.
 * Craters do not count. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_CLIMB_AHEAD_H
#define JOLON_WORLD_TERRAIN_CLIMB_AHEAD_H

#include "world/terrain/terrain.h"

struct fixed_object;
struct kind;
struct square_bounds;

/* The fixed objects of a world, as in struct world and struct state. */
struct climb_objects {
    const struct fixed_object *fixed;
    const uint32_t *reach_start, *reach;
    const struct kind *kinds;
    const uint8_t *damage;
};

struct climb_ahead {
    const struct square_bounds *tops; /* of all that stands in each gridsquare; NULL: not known */
    const struct climb_objects *objects; /* NULL: it minds the ground alone */
    /* The aircraft. */
    struct vec3 at;                     /* [m, world] its position */
    double up_mps, speed_mps;           /* its climb, and its speed on the map */
    double half_length_m, half_width_m; /* how far it reaches ahead and to its sides */
    double climb_mps;                   /* its greatest rate of climb */
    double pull_mps2, brake_mps2;       /* by which it changes its climb, and slows down */
    double late_s;                      /* until it does either */
    /* The way. */
    double heading_rad;       /* where it begins */
    double off_rad, radius_m; /* by how much it turns to the right, and how wide */
    double length_m;
    /* The heights over the ground that it wants, and that it must have, which is no more. Over an
     * object it wants little more than it must have. */
    double clear_m, least_m;
};

struct climb_need {
    double climb_mps; /* the least rate that suffices at its present speed; -INFINITY: any */
    double speed_mps; /* the greatest speed that allows enough time; INFINITY: any */
};

struct climb_need climb_ahead_need(const struct terrain *terrain, const struct climb_ahead *ahead);

/* Returns how much faster [m/s] than now an aircraft must climb to come as high in t seconds as
 * with an even rate. up_mps: now; pull_mps2: by which the rate changes. Where that has no solution
 * the pull is too weak, and the result is a change for which there is no time. */
double climb_ahead_change(double up_mps, double even_mps, double pull_mps2, double t);

#endif
