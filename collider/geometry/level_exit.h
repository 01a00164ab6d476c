/* The shortest way on the map of a body out of others: out of all hulls of all of them, so that it
 * does not lead from one hull into the next. On the way it rises as the ground does. Pure; any
 * thread, each with a search of its own.
 *
 * Two hulls overlap while no face of either separates them. Where a body moves along a line they do
 * so for one interval of its way. On the map, the displacements at which two hulls overlap are a
 * convex polygon, their outline. The nearest point outside all outlines is on the edge of one: from
 * the point of each edge that is nearest, one goes along it until no other outline covers it. So a
 * search takes at most as many steps as there are edges times outlines, and edges. Axes across two
 * edges of hulls are left out, so that the way is at most longer than needed. A body that has gone
 * a part of its way has exactly the rest of it before it: the way is the shortest, so that no way
 * from there is shorter than this rest. */
#ifndef JOLON_COLLIDER_GEOMETRY_LEVEL_EXIT_H
#define JOLON_COLLIDER_GEOMETRY_LEVEL_EXIT_H

#include "collider/geometry/time_of_impact.h"

#include <stdbool.h>
#include <stdint.h>

/* A line on the map, of displacements against the motion: those whose component along the normal is
 * far_m. An edge of an outline is a part of it. */
struct exit_edge {
    double x, z;     /* unit, outwards */
    double far_m;    /* from where the body is; below 0 the body is beyond the line */
    double from, to; /* [m] along the line, 0 at the point that is nearest to the body */
};

/* A corner of an outline. */
struct exit_corner {
    double x, z;     /* [m] */
    double beyond_m; /* a line that may cut it off */
    uint32_t line;   /* from here to the next corner: index into level_exit.plane */
};

/* The displacements at which two hulls overlap. */
struct exit_outline {
    uint32_t first, end; /* edges */
    uint32_t shadow_end; /* of one that bars the way: edges of its shadow, from end on; none of one
                            that the body is in, which bars all ways */
    bool overlaps;       /* the body is in it */
    bool bars;           /* no way leads through it */
};

/* A part of an edge [m]. */
struct exit_interval {
    double from, to;
};

/* How much the ground rises for each metre to the east and to the south. */
struct exit_slope {
    double east, south;
};

/* A search, which keeps its memory from one to the next. */
struct level_exit {
    struct exit_edge *plane;          /* of two hulls, and their square */
    struct exit_corner *corner, *cut; /* of their outline, and room for those that a cut leaves */
    struct exit_outline *outline;
    struct exit_interval *covered; /* by each outline, of an edge */
    struct exit_edge *edge;
    struct exit_slope slope;
    uint64_t plane_capacity, outline_capacity, edge_capacity;
    uint32_t outlines, edges;
};

/* Returns 0, or -1 with errno ENOMEM. */
int level_exit_init(struct level_exit *search);
void level_exit_free(struct level_exit *search);

/* Begins a search for a way along ground of this slope. */
void level_exit_begin(struct level_exit *search, struct exit_slope slope);

/* Adds another body; both stand as they do at the beginning of the frame. bars: the way must not
 * lead through it. */
void level_exit_add(struct level_exit *search, const struct swept_body *body,
                    const struct swept_body *other, bool bars);

/* Returns how far the body has to move to be out of all others [m]. *normal: unit, level, against
 * the motion. bars: heeds those that bar the way. INFINITY: the body overlaps no other, or all ways
 * are barred. A way is then one of those that end on an edge of what is to be left. */
double level_exit_find(struct level_exit *search, bool bars, struct vec3 *normal);

/* Returns how far the body has to move to be out of one other, as above; nothing bars the way. Only
 * hulls within reach of the way are looked at, which costs a fifth. Begins a search of its own. */
double level_exit_of(struct level_exit *search, struct exit_slope slope,
                     const struct swept_body *body, const struct swept_body *other,
                     struct vec3 *normal);

#endif
