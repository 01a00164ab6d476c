/* Bounds of gridsquares, each computed once. */
#include "world/terrain/square_bounds.h"

#include <math.h>
#include <stdlib.h>

#define SLACK_M      0.01 /* more than rounding adds to a height or moves a path */
#define SQUARES_MOST 9    /* of a box; for a larger one the ground itself is tested */

int square_bounds_init(struct square_bounds *bounds, const struct gridsquares *squares,
                       square_bounds_function *compute, const void *context)
{
    *bounds = (struct square_bounds){.compute = compute, .context = context, .squares = *squares};
    bounds->bound = calloc(squares->count, sizeof *bounds->bound);
    return bounds->bound ? 0 : -1;
}

void square_bounds_free(struct square_bounds *bounds)
{
    free(bounds->bound);
    *bounds = (struct square_bounds){0};
}

uint16_t square_bounds_compute(const struct square_bounds *bounds, uint32_t square)
{
    uint16_t bound = bounds->compute(bounds->context, square);
    atomic_store_explicit(&bounds->bound[square], bound, memory_order_relaxed);
    return bound;
}

bool square_bounds_within(const struct square_bounds *bounds, struct gridsquare_box box,
                          uint16_t most)
{
    if ((box.x1 - box.x0 + 1) * (box.z1 - box.z0 + 1) > SQUARES_MOST)
        return false;
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            if (square_bounds_of(bounds, gridsquare_index(&bounds->squares, column, row)) > most)
                return false;
        }
    }
    return true;
}

/* --- steps -------------------------------------------------------------------------------------*/

static uint16_t below(double steps)
{
    if (!(steps > 0.0))
        return 0;
    return steps < (double)SQUARE_BOUNDS_NONE ? (uint16_t)steps : SQUARE_BOUNDS_NONE - 1;
}

static uint16_t above(double steps)
{
    return steps + 1.0 < (double)SQUARE_BOUNDS_NONE ? (uint16_t)(below(steps) + 1)
                                                    : SQUARE_BOUNDS_NONE;
}

uint16_t square_bounds_below_height(double height_m)
{
    return below((height_m - SQUARE_BOUNDS_LOWEST_M) / SQUARE_BOUNDS_HEIGHT_M);
}

uint16_t square_bounds_below_slope(double slope)
{
    return below(slope / SQUARE_BOUNDS_SLOPE_STEP);
}

uint16_t square_bounds_above_height(double height_m)
{
    return above((height_m + SLACK_M - SQUARE_BOUNDS_LOWEST_M) / SQUARE_BOUNDS_HEIGHT_M);
}

/* --- the ground --------------------------------------------------------------------------------*/

/* The posts of a square row by row, those of its borders included. */
struct posts {
    struct terrain_posts across, down;
};

static struct gridsquare_box square_box(const struct gridsquares *squares, uint32_t square)
{
    int32_t column = gridsquare_column(squares, square), row = gridsquare_row(squares, square);
    return (struct gridsquare_box){column, row, column, row};
}

static struct posts posts_of(const struct terrain *terrain, uint32_t square)
{
    const struct gridsquares *squares = &terrain->squares;
    double west_m = squares->side_m * gridsquare_column(squares, square);
    double north_m = squares->side_m * gridsquare_row(squares, square);
    return (struct posts){terrain_posts(terrain, west_m, squares->side_m),
                          terrain_posts(terrain, north_m, squares->side_m)};
}

uint16_t square_bounds_height(const void *context, uint32_t square)
{
    const struct terrain *terrain = context;
    const struct posts posts = posts_of(terrain, square);
    float top = -INFINITY;
    for (uint32_t z = posts.down.first; z <= posts.down.last; z++) {
        for (uint32_t x = posts.across.first; x <= posts.across.last; x++) {
            float post = terrain->posts[(size_t)z * terrain->side + x];
            top = post > top ? post : top;
        }
    }
    const struct gridsquare_box box = square_box(&terrain->squares, square);
    double highest, lowest;
    earthwork_range(&terrain->earthworks, &box, &highest, &lowest);
    return square_bounds_above_height((double)top + highest);
}

/* Returns the square of the steeper slope of a cell's two triangles; post is the north-west one. */
static double steepness(const struct terrain *terrain, const float *post)
{
    double nw = (double)post[0], ne = (double)post[1];
    double sw = (double)post[terrain->side], se = (double)post[terrain->side + 1];
    double north = (ne - nw) * (ne - nw) + (se - ne) * (se - ne);
    double south = (se - sw) * (se - sw) + (sw - nw) * (sw - nw);
    return maths_max(north, south) / (terrain->spacing_m * terrain->spacing_m);
}

uint16_t square_bounds_slope(const void *context, uint32_t square)
{
    const struct terrain *terrain = context;
    const struct posts posts = posts_of(terrain, square);
    const struct gridsquare_box box = square_box(&terrain->squares, square);
    double most = 0.0, highest, lowest;
    if (earthwork_range(&terrain->earthworks, &box, &highest, &lowest))
        return SQUARE_BOUNDS_NONE;
    for (uint32_t z = posts.down.first; z <= posts.down.last; z++) {
        for (uint32_t x = posts.across.first; x <= posts.across.last; x++) {
            size_t post = (size_t)z * terrain->side + x;
            if (cover_is_water((enum cover)terrain->cover[post]))
                return SQUARE_BOUNDS_NONE;
            if (z < posts.down.last && x < posts.across.last)
                most = maths_max(most, steepness(terrain, terrain->posts + post));
        }
    }
    return above(sqrt(most) / SQUARE_BOUNDS_SLOPE_STEP + 1.0);
}

bool square_bounds_clear(const struct square_bounds *heights, const struct crater_index *craters,
                         struct vec3 p, struct vec3 q)
{
    double low_m = maths_min(p.y, q.y) - (craters ? craters->rim_m : 0.0);
    return square_bounds_within(heights,
                                gridsquare_box_of(&heights->squares, maths_min(p.x, q.x),
                                                  maths_min(p.z, q.z), maths_max(p.x, q.x),
                                                  maths_max(p.z, q.z)),
                                square_bounds_below_height(low_m));
}
