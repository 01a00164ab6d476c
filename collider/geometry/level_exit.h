/* The shortest level way of a body out of others: out of all hulls of all of them, so that it does
 * not lead from one hull into the next. Pure; any thread, each with a search of its own.
 *
 * Two hulls overlap while no face of either separates them. Where a body moves along a line they do
 * so for one interval of its way, and the way out ends with the intervals that follow on each other
 * from its beginning. On the map, the displacements at which two hulls overlap are a convex
 * polygon. The nearest point outside all polygons is the nearest point of an edge, or a corner in
 * which the edges of two polygons cross. Axes across two edges of hulls are left out, so that the
 * way is at most longer than needed. A body that has gone a part of its way has exactly the rest of
 * it before it: the way is the shortest, so that no way from there is shorter than this rest. */
#ifndef JOLON_COLLIDER_GEOMETRY_LEVEL_EXIT_H
#define JOLON_COLLIDER_GEOMETRY_LEVEL_EXIT_H

#include "collider/geometry/time_of_impact.h"

#include <stdbool.h>
#include <stdint.h>

/* A face between two hulls. */
struct exit_plane {
    double x, z;         /* level part of its unit normal, from the body to the other */
    double separation_m; /* of the hulls along the normal, less what the way is to keep clear */
};

/* Two hulls that may overlap on a level way. */
struct exit_hulls {
    uint32_t first, end; /* planes */
    bool overlaps;       /* at the beginning */
    bool bars;           /* no way leads through them */
};

/* An edge of the outline of two hulls: the line of all displacements, against the motion, whose
 * component along the normal is far_m. */
struct exit_edge {
    uint32_t hulls;  /* whose outline it is part of */
    double x, z;     /* unit, outwards */
    double far_m;    /* from where the body is; below 0 the body is beyond the line */
    double from, to; /* [m] along the line, 0 at the point that is nearest to the body */
};

/* A search, which keeps its memory from one to the next. */
struct level_exit {
    struct exit_plane *plane;
    struct exit_hulls *hulls;
    struct exit_edge *edge;
    uint64_t plane_capacity, hulls_capacity, edge_capacity;
    uint32_t planes, hulls_count, edges;
};

/* Returns 0, or -1 with errno ENOMEM. */
int level_exit_init(struct level_exit *search);
void level_exit_free(struct level_exit *search);

/* Begins a search. */
void level_exit_begin(struct level_exit *search);

/* Adds another body; both stand as they do at the beginning of the frame. bars: the way must not
 * lead through it. */
void level_exit_add(struct level_exit *search, const struct swept_body *body,
                    const struct swept_body *other, bool bars);

/* Returns how far the body has to move to be out of all others [m]. *normal: unit, level, against
 * the motion. bars: heeds those that bar the way. INFINITY: the body overlaps no other, or all ways
 * are barred. Only ways across faces, or to where two faces meet, are tried; where nothing bars
 * the way, the shortest is one of them. */
double level_exit_find(struct level_exit *search, bool bars, struct vec3 *normal);

/* Returns how far the body has to move to be out of one other, as above; nothing bars the way. Only
 * hulls within reach of the way are looked at, which costs a fifth. Begins a search of its own. */
double level_exit_of(struct level_exit *search, const struct swept_body *body,
                     const struct swept_body *other, struct vec3 *normal);

#endif
