/* How long two moving and turning hulls certainly stay separate: the bound that each step of
 * conservative advancement needs. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_HULL_SEPARATION_H
#define JOLON_COLLIDER_GEOMETRY_HULL_SEPARATION_H

#include "collider/geometry/time_of_impact.h"
#include "collider/geometry/gjk.h"

#include <stdbool.h>

/* How a body turns within the frame. */
struct rotation_path {
    const struct swept_body *body;
    double share;     /* share of the rotation from its start to its end, a frame */
    double rate;      /* [rad a frame] at most */
    double bend;      /* acceleration of a point 1 m from the axis [m a frame^2] at most */
    struct vec3 axis; /* unit, body axes: the fixed axis; 0 without rotation and in a free one */
    bool free;        /* a free rotation has no fixed axis */
    struct mat3 turn; /* at path.since */
};

/* Two hulls of two bodies. */
struct hull_pair {
    const struct rotation_path *a, *b;
    const struct hull *hull_a, *hull_b;
    struct vec3 velocity; /* of b's position relative to a's [m a frame] */
    double radii_m;       /* of the hulls' spheres */
    /* Of the hulls' points, and of the centres of their spheres, relative to their bodies' axes: */
    double speed;              /* by rotation, the sum of both [m a frame] at most */
    double bend, bend_spheres; /* their acceleration, the sum of both [m a frame^2] at most */
};

/* A body's rotation at one time. */
struct body_pose {
    const struct swept_body *body;
    struct mat3 turn;
    struct vec3 spin; /* [rad a frame] */
};

/* The pair at one time. Positions are relative to that of a's body. The hull of a turret or a gun
 * has an origin of its own, and that moves relative to the body's position. */
struct relative_pose {
    double time;
    struct convex a, b;
    struct vec3 spin_a, spin_b;     /* [rad a frame] */
    struct vec3 between;            /* from a's origin to b's */
    struct vec3 velocity;           /* of b's origin relative to a's [m a frame] */
    struct vec3 centre_a, centre_b; /* of the hulls' spheres, relative to their origins */
    struct vec3 towards;            /* unit, from centre to centre */
    double centres_m;               /* between them */
};

/* A plane between the hulls: its unit normal from a to b, and how that changes a frame. A plane
 * that turns with the surfaces separates them for longer. */
struct plane {
    struct vec3 normal, swing;
};

struct rotation_path rotation_path_of(const struct swept_body *body);
struct hull_pair hull_pair_of(const struct rotation_path *a, const struct rotation_path *b,
                              const struct hull *hull_a, const struct hull *hull_b);

/* Returns the pair of the first bit in a set, which must not be empty (box_view_near). */
struct hull_pair hull_pair_first(const struct rotation_path *a, const struct rotation_path *b,
                                 uint64_t pairs);

struct body_pose body_pose_at(const struct rotation_path *rotation, double time);
struct relative_pose relative_pose_at(const struct hull_pair *pair, double time);

/* The same for two hulls of bodies whose poses at this time are known. */
struct relative_pose relative_pose_of(const struct body_pose *a, const struct hull *hull_a,
                                      const struct body_pose *b, const struct hull *hull_b,
                                      double time);

/* Returns the separation of the hulls along the plane's normal [m]; below 0 they overlap. */
double hull_separation_now(const struct relative_pose *now, struct vec3 normal);

/* Returns the same if it is above a length, and no more than the length if not. gjk: what was found
 * for the two; mostly it shows that without a look at the vertices. */
double hull_separation_above(const struct relative_pose *now, const struct gjk *gjk,
                             struct vec3 normal, double length_m);

/* Returns the approach speed of a point that belongs to both bodies, or nearly [m a frame];
 * negative where they part. */
double hull_separation_nearing(const struct relative_pose *now, struct vec3 normal,
                               struct vec3 point);

/* Returns how long, at most `most` frames, the hulls certainly stay more than a gap apart across
 * the plane. They must be so now. */
double hull_separation_for(const struct hull_pair *pair, const struct relative_pose *now,
                           const struct plane *plane, double gap, double most);

/* Returns the swing of the normal of the nearest points that keeps the plane on the vertices
 * between which those points lie. */
struct vec3 hull_separation_swing(const struct hull_pair *pair, const struct relative_pose *now,
                                  struct vec3 normal, const struct gjk_start *nearest);

/* Returns true if the hulls' spheres are far apart; *h is then how long the hulls stay SKIN_M
 * apart. Looks at no vertex. */
bool hull_separation_by_spheres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most, double *h);

/* Returns true if the plane across the line of the centres keeps the hulls SKIN_M apart for the
 * whole time. */
bool hull_separation_by_centres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most);

/* Returns the position of b relative to a at a time. The difference keeps its digits 50 km from the
 * origin. */
struct vec3 hull_separation_at(const struct path *a, const struct path *b, double time);

#endif
