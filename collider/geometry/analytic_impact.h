/* Times of impact in closed form. Pure; any thread. Time runs over the frame from 0 to 1. */
#ifndef JOLON_COLLIDER_GEOMETRY_ANALYTIC_IMPACT_H
#define JOLON_COLLIDER_GEOMETRY_ANALYTIC_IMPACT_H

#include "world/maths/maths.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>

/* A body's motion in the frame: it is at `at` until `since`, then moves by `along` a whole
 * frame. */
struct path {
    struct vec3 at;
    struct vec3 along;
    double since;
    bool rotates; /* the shape moves although along is 0 */
};

static inline struct vec3 path_at(const struct path *path, double time)
{
    return vec3_add(path->at, vec3_scale(path->along, time - path->since));
}

/* Finds the first time in [from, 1] at which the spheres of two paths touch while they approach;
 * reach is the sum of their radii. This is the smaller root of |s + w t|^2 = reach^2 (Osborne 1991,
 * p. 24, asks for this "time interpolation"). Spheres that overlap at from touch at from if they
 * approach. Returns false if they do not touch. from must not be before either path's since. */
bool analytic_impact_spheres(const struct path *a, const struct path *b, double reach, double from,
                             double *toi);

/* Finds the first time in [path->since, 1] at which the point is below the ground, or path->since
 * if it is below at the start. Exact on the terrain's triangles. Near craters it samples every half
 * metre and bisects to 1e-6 of the frame. */
bool analytic_impact_ground(const struct terrain *terrain, const struct crater_index *craters,
                            const struct path *path, double *toi);

#endif
