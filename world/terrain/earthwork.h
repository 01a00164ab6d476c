/* Earthworks: ramps, banks, trenches, washboards, fords and skid pans that a scenario puts on the
 * ground, finer than its posts. Each is a rectangle on the map and adds to the height of the ground
 * in it. They never change; the index by gridsquare is made with the world. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_EARTHWORK_H
#define JOLON_WORLD_TERRAIN_EARTHWORK_H

#include "world/terrain/gridsquare.h"

#include <stdbool.h>
#include <stdint.h>

enum earthwork_shape {
    EARTHWORK_RAMP,      /* rises all along its length and ends in a lip */
    EARTHWORK_TABLE,     /* rises, is level, and falls again */
    EARTHWORK_TRENCH,    /* the same, dug into the ground */
    EARTHWORK_WASHBOARD, /* waves across the way */
    EARTHWORK_FORD,      /* a trench with water in it */
    EARTHWORK_SKID_PAN,  /* slippery ground that is not raised */
    EARTHWORK_SHAPE_COUNT
};

/* What the work adds to the height is height_m times the least of four shares: how far the point is
 * from each end and from the sides, over the length of that slope, and 1. With waves this is
 * multiplied by a share between 0 and 1 that oscillates. */
struct earthwork {
    double x, z;                    /* [m] the middle */
    double sine, cosine;            /* of the heading, clockwise from north */
    double half_length, half_width; /* [m] slopes included */
    double height_m;                /* over the ground; negative: dug into it */
    double back_m, front_m, side_m; /* length of the slope at each end and at the sides, over 0 */
    double wave_m;                  /* length of a wave; 0: no waves */
    double freeboard_m;             /* from the ground down to the water of a ford */
    double grip;                    /* share of the ground's own grip, 0..1 */
    uint32_t shape;                 /* enum earthwork_shape */
    uint32_t reserved;
};

_Static_assert(sizeof(struct earthwork) == 112, "shared layout");

#define EARTHWORKS_MAX 4096u

/* The steepest slope of a work, as a tangent. A vertical face would have two heights. */
#define EARTHWORK_STEEPEST 8.0

/* The works of a world. The index lists the works of each gridsquare that they reach into. */
struct earthworks {
    const struct earthwork *works;
    const uint32_t *index; /* EARTHWORK_INDEX_HEAD words; starts; numbers of works */
    uint32_t count;        /* 0: no work, and no index */
    struct gridsquares squares;
};

/* The index covers one rectangle of gridsquares. Its first words say which, into how many cells the
 * side of a square is divided for points, a power of two, and at which word the list of cells
 * begins: as that of squares, starts and then numbers of works. */
enum {
    EARTHWORK_COLUMN,
    EARTHWORK_ROW,
    EARTHWORK_COLUMNS,
    EARTHWORK_ROWS,
    EARTHWORK_SPLIT,
    EARTHWORK_CELLS,
    EARTHWORK_INDEX_HEAD
};

/* Builds the index on the heap, `words` long; the caller frees it. Without works it is NULL and 0
 * words long. Returns 0, or -1 with errno ENOMEM. */
int earthwork_index_build(const struct earthwork *works, uint32_t count,
                          const struct gridsquares *squares, uint32_t **index, uint32_t *words);

/* Returns the numbers of the works that may reach into a gridsquare, ascending, and their count. */
const uint32_t *earthwork_in_square(const struct earthworks *works, uint32_t square,
                                    uint32_t *count);

/* Returns the work's own share of the height at (x, z) [m], 0 outside of it. */
double earthwork_height(const struct earthwork *work, double x, double z);

/* Returns true if (x, z) is in the work's rectangle. */
bool earthwork_holds(const struct earthwork *work, double x, double z);

/* Returns true if (x, z) is in the rectangle of any work. */
bool earthwork_covers(const struct earthworks *works, double x, double z);

/* Returns true if the rectangle of a work may reach within a distance of (x, z) [m]. */
bool earthwork_near(const struct earthworks *works, double x, double z, double reach_m);

/* Returns how far the work reaches from its middle to the east and to the south at most [m]. */
double earthwork_reach_x(const struct earthwork *work);
double earthwork_reach_z(const struct earthwork *work);

/* Returns what all works add to the height at (x, z) [m]: the highest rise and the deepest dig
 * together. It is continuous, and does not depend on the order of the works. */
double earthwork_offset(const struct earthworks *works, double x, double z);

/* Returns the depth of a ford's water at (x, z) [m], 0 where there is none. The water of seas and
 * lakes is in the terrain's cover. */
double earthwork_water(const struct earthworks *works, double x, double z);

/* Returns the share of the ground's grip that is left at (x, z): 1, or less on a skid pan. */
double earthwork_grip(const struct earthworks *works, double x, double z);

/* The highest and the lowest share of the height by the works that may reach into the squares, at
 * least 0 and at most 0 [m]. Returns false if no work reaches there that changes the height. */
bool earthwork_range(const struct earthworks *works, const struct gridsquare_box *box,
                     double *highest_m, double *lowest_m);

#endif
