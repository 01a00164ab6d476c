/* How long two hulls that move and turn surely stay apart: what conservative advancement asks at
 * each step. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_HULL_SEPARATION_H
#define JOLON_COLLIDER_GEOMETRY_HULL_SEPARATION_H

#include "collider/geometry/time_of_impact.h"
#include "collider/geometry/gjk.h"

#include <stdbool.h>

/* How a body turns in the frame. */
struct rotation_path {
    const struct swept_body *body;
    double share;     /* of the way from its from to its to, a frame */
    double rate;      /* [rad a frame] at most */
    struct vec3 axis; /* unit, body axes: it stands still; 0 when there is no turning */
    struct mat3 turn; /* at path.since */
};

/* Two hulls of two bodies. */
struct hull_pair {
    const struct rotation_path *a, *b;
    const struct hull *hull_a, *hull_b;
    struct vec3 velocity; /* of b's position from a's [m a frame] */
    double radii_m;       /* of the hulls' spheres */
    /* Of the hulls' points, and of their spheres' centres alone, from their bodies' axes: */
    double speed;              /* that turning gives them, together [m a frame] at most */
    double bend, bend_spheres; /* likewise their acceleration [m a frame^2] */
};

/* The pair at a time. Positions are relative to a's. */
struct relative_pose {
    double time;
    struct convex a, b;
    struct vec3 spin_a, spin_b;     /* [rad a frame] */
    struct vec3 centre_a, centre_b; /* of the hulls' spheres, from their bodies' positions */
    struct vec3 towards;            /* unit, from centre to centre */
    double centres_m;               /* between them */
};

/* A plane between the hulls, by its unit normal from a to b, which changes by its swing a frame:
 * one that turns with what it lies on keeps them apart for longer. */
struct plane {
    struct vec3 normal, swing;
};

struct rotation_path rotation_path_of(const struct swept_body *body);
struct hull_pair hull_pair_of(const struct rotation_path *a, const struct rotation_path *b,
                              const struct hull *hull_a, const struct hull *hull_b);
struct relative_pose relative_pose_at(const struct hull_pair *pair, double time);

/* How far the plane keeps the hulls apart now [m]; below 0 they overlap it by that together. */
double hull_separation_now(const struct relative_pose *now, struct vec3 normal);

/* How fast a point comes nearer that both bodies have, or nearly [m a frame]: negative where they
 * part. */
double hull_separation_nearing(const struct hull_pair *pair, const struct relative_pose *now,
                               struct vec3 normal, struct vec3 point);

/* How long, at most `most` frames, the hulls surely stay more than a gap apart across the plane,
 * which keeps them so now. */
double hull_separation_for(const struct hull_pair *pair, const struct relative_pose *now,
                           const struct plane *plane, double gap, double most);

/* The swing of the plane across the normal of the nearest points, between which these vertices
 * are, that keeps it on all of them. */
struct vec3 hull_separation_swing(const struct hull_pair *pair, const struct relative_pose *now,
                                  struct vec3 normal, const struct gjk_start *nearest);

/* Are the hulls' spheres far apart? Then *h is how long they stay TOUCH_M apart: without a look at
 * vertices. */
bool hull_separation_by_spheres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most, double *h);

/* Does the plane across the line of their centres keep the hulls TOUCH_M apart all the while? */
bool hull_separation_by_centres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most);

/* Where b is from a at a time: 50 km cost no digits of what changes. */
struct vec3 hull_separation_at(const struct path *a, const struct path *b, double time);

#endif
