/* Upper bounds of a quantity, such as the height of the ground, in each gridsquare.
 *
 * The bound of a square is computed on its first use: computing those of a whole world would delay
 * a process's start. Bounds follow from the static world, so the results do not depend on earlier
 * calls. Any thread. */
#ifndef JOLON_WORLD_TERRAIN_SQUARE_BOUNDS_H
#define JOLON_WORLD_TERRAIN_SQUARE_BOUNDS_H

#include "world/terrain/crater.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define SQUARE_BOUNDS_NONE       UINT16_MAX /* the square has no bound */
#define SQUARE_BOUNDS_LOWEST_M   (-1000.0)  /* heights are in steps above this */
#define SQUARE_BOUNDS_HEIGHT_M   0.25       /* a step of a height */
#define SQUARE_BOUNDS_SLOPE_STEP 0.02       /* a step of a slope's tangent */

/* Computes the bound of a square in whole steps: at least 1, or SQUARE_BOUNDS_NONE. */
typedef uint16_t square_bounds_function(const void *context, uint32_t square);

struct square_bounds {
    square_bounds_function *compute;
    const void *context;
    struct gridsquares squares;
    _Atomic uint16_t *bound; /* [squares.count] 0: not computed yet */
};

/* Returns 0, or -1 with errno ENOMEM. The context stays the caller's. */
int square_bounds_init(struct square_bounds *bounds, const struct gridsquares *squares,
                       square_bounds_function *compute, const void *context);
void square_bounds_free(struct square_bounds *bounds);

/* Computes and keeps a bound. Only square_bounds_of() calls it. */
uint16_t square_bounds_compute(const struct square_bounds *bounds, uint32_t square);

static inline uint16_t square_bounds_of(const struct square_bounds *bounds, uint32_t square)
{
    uint16_t bound = atomic_load_explicit(&bounds->bound[square], memory_order_relaxed);
    return bound != 0 ? bound : square_bounds_compute(bounds, square);
}

/* Returns true if the bounds of all squares that the box touches are at most `most`. Returns false,
 * too, if the box touches more than nine squares. */
bool square_bounds_within(const struct square_bounds *bounds, struct gridsquare_box box,
                          uint16_t most);

/* Return the greatest bound that is at most this height [m] or this slope (a tangent). 0: none
 * is. */
uint16_t square_bounds_below_height(double height_m);
uint16_t square_bounds_below_slope(double slope);

/* Returns the least bound that is certainly above this height [m], rounding included. */
uint16_t square_bounds_above_height(double height_m);

/* The height of the ground without its craters; the context is a struct terrain. */
square_bounds_function square_bounds_height;

/* The slope of the ground without its craters, at least half a step above the steepest one; the
 * context is a struct terrain. A square with water or with an earthwork that changes the height has
 * no bound. */
square_bounds_function square_bounds_slope;

/* Returns true if the straight path from p to q is above the ground and its craters (NULL: none)
 * by the square_bounds_height of the squares. True is certain. False may also be returned for a
 * path above the ground. */
bool square_bounds_clear(const struct square_bounds *heights, const struct crater_index *craters,
                         struct vec3 p, struct vec3 q);

#endif
