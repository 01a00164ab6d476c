/* Times of impact in closed form. Pure; any thread. Time runs over the frame from 0 to 1. */
#ifndef JOLON_COLLIDER_GEOMETRY_ANALYTIC_IMPACT_H
#define JOLON_COLLIDER_GEOMETRY_ANALYTIC_IMPACT_H

#include "world/maths/maths.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>

/* A body's motion in the frame: at `at` from time `since` on, `along` a whole frame. */
struct path {
    struct vec3 at;
    struct vec3 along;
    double since;
    bool turns; /* where it stands: along is 0 and yet its shape moves */
};

static inline struct vec3 path_at(const struct path *path, double time)
{
    return vec3_add(path->at, vec3_scale(path->along, time - path->since));
}

/* First time in [from, 1] at which spheres of the two paths touch while coming nearer, with
 * reach the sum of their radii: the smaller root of |s + w t|^2 = reach^2 (Osborne 1991, p. 24,
 * asks for this "time interpolation"). Spheres that overlap at from touch at from if they are
 * coming nearer. False when they do not touch. from must not be before either path's since. */
bool analytic_impact_spheres(const struct path *a, const struct path *b, double reach, double from,
                             double *toi);

/* First time in [path->since, 1] at which the point goes below the ground; exact on the terrain's
 * triangles; where craters are near it looks every half metre, and from there to 1e-6 of the frame.
 * Below at the start: path->since. */
bool analytic_impact_ground(const struct terrain *terrain, const struct crater_index *craters,
                            const struct path *path, double *toi);

#endif
