/* Craters: an append-only list in shared memory and a private index over it by gridsquare.
 *
 * The list is part of the world (written by the collider, committed by its count). The index is a
 * cache that each process builds for itself from the committed entries, so it is never shared, and
 * a kill cannot damage it. */
#ifndef JOLON_WORLD_TERRAIN_CRATER_H
#define JOLON_WORLD_TERRAIN_CRATER_H

#include "world/terrain/gridsquare.h"

#include <stdbool.h>
#include <stdint.h>

struct crater {
    double x, z;    /* [m] centre */
    float radius_m; /* of the bowl; the rim reaches CRATER_RIM times as far */
    float depth_m;  /* below the original ground */
    uint64_t frame; /* in which it was made */
};

_Static_assert(sizeof(struct crater) == 32, "shared layout");

/* The rim's outer radius over the bowl's; its height over the depth. Ejecta profiles of small
 * explosion craters: rim about a fifth of the depth, blanket to about 1.5 radii (Cooper 1996). */
#define CRATER_RIM        1.5
#define CRATER_RIM_HEIGHT 0.2

/* [m] More than the bowl of the largest charge that a kind can have
 * (collider/response/explosion.c). So a crater reaches into CRATER_SQUARES gridsquares at most. */
#define CRATER_RADIUS_MAX 60.0
#define CRATER_SQUARES    9u

#define CRATER_SLOTS_MAX (1u << 20)

struct crater_link {
    uint32_t crater; /* index into the list */
    uint32_t next;   /* link + 1, 0 ends */
};

struct crater_index {
    const struct crater *craters;
    uint32_t count; /* craters indexed so far */
    struct gridsquares squares;
    uint32_t *head;            /* [squares.count] link + 1, 0 for none */
    struct crater_link *links; /* CRATER_SQUARES for each of CRATER_SLOTS_MAX craters */
    uint32_t link_count;
    double rim_m; /* the greatest height of a rim over the ground [m] */
};

/* 0, or -1 with errno ENOMEM. The list must outlive the index. */
int crater_index_init(struct crater_index *index, const struct gridsquares *squares,
                      const struct crater *craters);
void crater_index_free(struct crater_index *index);

/* Indexes the list's entries up to count, at most CRATER_SLOTS_MAX. A count below what was indexed
 * (the world was set back) rebuilds the index from the start. Takes no memory. */
void crater_index_update(struct crater_index *index, uint32_t count);

/* Returns what craters add to the height at (x, z) [m]: the deepest bowl, else the highest rim,
 * else 0. Does not depend on the order of the craters. */
double crater_offset(const struct crater_index *index, double x, double z);

/* The craters of the gridsquares within a distance of a point. Those that reach into several of
 * these squares come as often. */
struct crater_walk {
    const struct crater_index *index;
    struct gridsquare_box box;
    int32_t column, row; /* the next square */
    uint32_t link;       /* + 1 of the next crater of the square before; 0: none */
};

struct crater_walk crater_walk_begin(const struct crater_index *index, double x, double z,
                                     double reach_m);

/* Returns the next crater, or NULL after the last one. */
const struct crater *crater_walk_next(struct crater_walk *walk);

/* Returns true if a crater or its rim may reach within a distance of (x, z) [m]. */
bool crater_index_near(const struct crater_index *index, double x, double z, double reach_m);

/* The rectangle on which a vehicle stands. */
struct crater_footing {
    double x, z;                    /* [m] its middle */
    double half_length, half_width; /* [m] */
    double sine, cosine;            /* of its heading, clockwise from north */
};

/* The point of the rectangle so many halves along and across from its middle: -1, 0 or 1. */
static inline void crater_footing_point(const struct crater_footing *footing, double along,
                                        double across, double *x, double *z)
{
    double length = along * footing->half_length, width = across * footing->half_width;
    *x = footing->x + footing->sine * length + footing->cosine * width;
    *z = footing->z - footing->cosine * length + footing->sine * width;
}

/* Returns by how much a vehicle is lifted [m] if the ground under the points of its rectangle is
 * this much higher than it would be. The first index is along: back, middle, front. */
double crater_footing_lift(double offset[3][3]);

/* Returns by how much craters lift a vehicle over the ground under its middle [m], at least 0. The
 * vehicle has the pitch and roll of the middles of its sides; it is lifted until no corner and no
 * middle of a side is in the bowl or the rim of a crater. */
double crater_lift(const struct crater_index *index, const struct crater_footing *footing);

#endif
