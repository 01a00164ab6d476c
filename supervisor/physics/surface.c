/* Heights on the two triangles of each cell, and the shapes of craters and earthworks. */
#include "supervisor/physics/surface.h"

#include "world/terrain/crater.h"
#include "world/terrain/earthwork.h"
#include "world/terrain/terrain.h"

#include <stdlib.h>
#include <string.h>

/* A crater's rim: its outer radius over the bowl's, and its height over the depth. */
#define RIM_RADII  1.5
#define RIM_HEIGHT 0.2

#define DIAGONAL 1.4142135623730952 /* of a square */

static int from_west(const void *a, const void *b)
{
    const struct crater *p = a, *q = b;
    return (p->x > q->x) - (p->x < q->x);
}

int surface_update(struct surface *surface, const struct crater *craters, uint32_t count)
{
    if (count == surface->count)
        return 0;
    if (count > surface->capacity) {
        uint32_t capacity = 2 * count;
        struct crater *more = realloc(surface->crater, capacity * sizeof *more);
        if (!more)
            return -1;
        surface->crater = more;
        surface->capacity = capacity;
    }
    surface->count = count;
    surface->reach_m = surface->rim_m = 0.0;
    memcpy(surface->crater, craters, count * sizeof *craters);
    for (uint32_t i = 0; i < count; i++) {
        surface->reach_m = maths_max(surface->reach_m, RIM_RADII * (double)craters[i].radius_m);
        surface->rim_m = maths_max(surface->rim_m, RIM_HEIGHT * (double)craters[i].depth_m);
    }
    qsort(surface->crater, count, sizeof *surface->crater, from_west);
    return 0;
}

void surface_free(struct surface *surface)
{
    free(surface->crater);
    *surface = (struct surface){0};
}

/* Returns the first crater whose centre is not west of x. */
static uint32_t first_crater(const struct surface *surface, double x)
{
    uint32_t low = 0, high = surface->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (surface->crater[middle].x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* What one crater adds to the ground at this distance [m]: a bowl of parabolic section, and a rim
 * that falls off as the square of the way to its outer edge. */
static double crater_shape(const struct crater *crater, double distance)
{
    double depth = (double)crater->depth_m, radii = distance / (double)crater->radius_m;
    double rim = RIM_HEIGHT * depth, outwards = (RIM_RADII - radii) / (RIM_RADII - 1.0);
    if (radii < 1.0)
        return rim * radii * radii - depth * (1.0 - radii * radii);
    return radii < RIM_RADII ? rim * outwards * outwards : 0.0;
}

/* Where craters meet, the deepest bowl counts, and without a bowl the highest rim. */
static double craters_at(const struct surface *surface, double x, double z)
{
    double deepest = 0.0, highest = 0.0;
    for (uint32_t i = first_crater(surface, x - surface->reach_m); i < surface->count; i++) {
        const struct crater *crater = &surface->crater[i];
        double east = x - crater->x, south = z - crater->z;
        if (east < -surface->reach_m)
            break;
        if (!(crater->radius_m > 0.0f))
            continue;
        double offset = crater_shape(crater, sqrt(east * east + south * south));
        deepest = maths_min(deepest, offset);
        highest = maths_max(highest, offset);
    }
    return deepest < 0.0 ? deepest : highest;
}

/* --- earthworks --------------------------------------------------------------------------------*/

/* What one earthwork adds to the ground: a frustum with a slope on each of its four sides, and the
 * waves of a washboard. */
static double work_shape(const struct earthwork *work, double x, double z)
{
    double east = x - work->x, south = z - work->z;
    double forward = east * work->sine - south * work->cosine;
    double right = east * work->cosine + south * work->sine;
    double rise = 1.0;
    rise = maths_min(rise, (work->half_length + forward) / work->back_m);
    rise = maths_min(rise, (work->half_length - forward) / work->front_m);
    rise = maths_min(rise, (work->half_width - right) / work->side_m);
    rise = maths_min(rise, (work->half_width + right) / work->side_m);
    if (work->wave_m > 0.0) {
        double crest = maths_sin(PI * (work->half_length + forward) / work->wave_m);
        rise *= crest * crest;
    }
    return work->height_m * maths_max(rise, 0.0);
}

static double works_at(const struct surface *surface, double x, double z)
{
    const struct earthworks *all = &surface->terrain->earthworks;
    double deepest = 0.0, highest = 0.0;
    for (uint32_t i = 0; i < all->count; i++) {
        double offset = work_shape(&all->works[i], x, z);
        deepest = maths_min(deepest, offset);
        highest = maths_max(highest, offset);
    }
    return deepest + highest;
}

/* What craters and earthworks add to the ground. */
static double uneven_at(const struct surface *surface, double x, double z)
{
    return (surface->count > 0 ? craters_at(surface, x, z) : 0.0) + works_at(surface, x, z);
}

/* Returns true if a work may be that near, with its height in rim_m if that is higher. */
static bool work_near(const struct surface *surface, double x, double z, double distance,
                      double *rim_m)
{
    const struct earthworks *all = &surface->terrain->earthworks;
    bool near = false;
    for (uint32_t i = 0; i < all->count; i++) {
        const struct earthwork *work = &all->works[i];
        double reach = work->half_length + work->half_width + distance;
        if (fabs(work->x - x) > reach || fabs(work->z - z) > reach)
            continue;
        near = true;
        *rim_m = maths_max(*rim_m, work->height_m);
    }
    return near;
}

/* --- the triangles -----------------------------------------------------------------------------*/

/* A place in the grid: the cell's first post, and the share of the cell to the east and south. */
struct cell {
    uint32_t column, row;
    double east, south;
};

static inline struct cell cell_at(const struct terrain *terrain, double x, double z)
{
    double edge = (double)(terrain->side - 1);
    double column = maths_clamp(x / terrain->spacing_m, 0.0, edge);
    double row = maths_clamp(z / terrain->spacing_m, 0.0, edge);
    uint32_t last = terrain->side - 2, west = (uint32_t)column, north = (uint32_t)row;
    west = west < last ? west : last;
    north = north < last ? north : last;
    return (struct cell){west, north, column - west, row - north};
}

static inline double post(const struct terrain *terrain, uint32_t column, uint32_t row)
{
    return (double)terrain->posts[(uint64_t)row * terrain->side + column];
}

/* The ground's height as the mean of a triangle's corners, weighted with barycentric weights. The
 * diagonal of a cell goes from its north-west to its south-east corner. */
static inline double triangle_height(const struct terrain *terrain, const struct cell *cell)
{
    double u = cell->east, v = cell->south;
    double north_west = post(terrain, cell->column, cell->row);
    double south_east = post(terrain, cell->column + 1, cell->row + 1);
    if (u >= v)
        return (1.0 - u) * north_west + (u - v) * post(terrain, cell->column + 1, cell->row) +
               v * south_east;
    return (1.0 - v) * north_west + (v - u) * post(terrain, cell->column, cell->row + 1) +
           u * south_east;
}

double surface_height(const struct surface *surface, double x, double z)
{
    const struct cell cell = cell_at(surface->terrain, x, z);
    double height = triangle_height(surface->terrain, &cell);
    return height + uneven_at(surface, x, z);
}

double surface_clearance(const struct surface *surface, const struct surface_rectangle *under)
{
    double dug[3][3], highest = 0.0;
    bool uneven = surface->count > 0 || surface->terrain->earthworks.count > 0;
    for (int i = 0; i < 9 && uneven; i++) {
        const struct vec3 to =
            vec3_add(vec3_scale(under->forward, i / 3 - 1), vec3_scale(under->right, i % 3 - 1));
        dug[i / 3][i % 3] = uneven_at(surface, under->middle.x + to.x, under->middle.z + to.z);
    }
    for (int i = 0; i < 9 && uneven; i++) {
        double plane = dug[1][1] + 0.5 * (i / 3 - 1) * (dug[2][1] - dug[0][1]) +
                       0.5 * (i % 3 - 1) * (dug[1][2] - dug[1][0]);
        highest = maths_max(highest, dug[i / 3][i % 3] - plane);
    }
    return highest;
}

double surface_ford(const struct surface *surface, double x, double z)
{
    const struct earthworks *all = &surface->terrain->earthworks;
    double depth = 0.0;
    for (uint32_t i = 0; i < all->count; i++) {
        const struct earthwork *work = &all->works[i];
        if (work->shape == EARTHWORK_FORD && work_shape(work, x, z) < 0.0)
            depth = maths_max(depth, -works_at(surface, x, z) - work->freeboard_m);
    }
    return depth;
}

bool surface_is_water(const struct surface *surface, double x, double z)
{
    const struct terrain *terrain = surface->terrain;
    const struct cell cell = cell_at(terrain, x, z);
    uint64_t row = cell.row + (cell.south >= 0.5), column = cell.column + (cell.east >= 0.5);
    uint8_t cover = terrain->cover[row * terrain->side + column];
    return cover == COVER_SEA || cover == COVER_LAKE;
}

/* --- parts of the ground -----------------------------------------------------------------------*/

static bool crater_near(const struct surface *surface, double x, double z, double distance)
{
    double reach = surface->reach_m + distance;
    for (uint32_t i = first_crater(surface, x - reach); i < surface->count; i++) {
        const struct crater *crater = &surface->crater[i];
        double own = RIM_RADII * (double)crater->radius_m + distance;
        if (crater->x > x + reach)
            return false;
        if (fabs(crater->x - x) <= own && fabs(crater->z - z) <= own)
            return true;
    }
    return false;
}

/* The plane of a cell's triangle. */
static struct surface_part plane_of(const struct terrain *terrain, uint32_t column, uint32_t row,
                                    bool north_east)
{
    double north_west = post(terrain, column, row);
    double south_east = post(terrain, column + 1, row + 1);
    double third = north_east ? post(terrain, column + 1, row) : post(terrain, column, row + 1);
    double east = north_east ? third - north_west : south_east - third;
    double south = north_east ? south_east - third : third - north_west;
    return (struct surface_part){
        .flat = true, .east_m = east / terrain->spacing_m, .south_m = south / terrain->spacing_m};
}

/* Takes the steepest slopes of both triangles of a cell. */
static void add_cell(struct surface_part *part, const struct terrain *terrain, uint32_t column,
                     uint32_t row)
{
    for (int i = 0; i < 2; i++) {
        const struct surface_part plane = plane_of(terrain, column, row, i != 0);
        part->east_m = maths_max(part->east_m, fabs(plane.east_m));
        part->south_m = maths_max(part->south_m, fabs(plane.south_m));
    }
}

struct surface_part surface_around(const struct surface *surface, double x, double z,
                                   double distance)
{
    const struct terrain *terrain = surface->terrain;
    const struct cell middle = cell_at(terrain, x, z);
    double share = distance / terrain->spacing_m;
    bool one_cell = middle.east > share && middle.east < 1.0 - share && middle.south > share &&
                    middle.south < 1.0 - share;
    bool crater = surface->count > 0 && crater_near(surface, x, z, distance);
    double works_m = 0.0;
    bool worked = work_near(surface, x, z, distance, &works_m);
    struct surface_part part = {.flat = false};
    if (one_cell && fabs(middle.east - middle.south) > DIAGONAL * share && !crater && !worked) {
        part = plane_of(terrain, middle.column, middle.row, middle.east >= middle.south);
    } else {
        const struct cell from = cell_at(terrain, x - distance, z - distance);
        const struct cell to = cell_at(terrain, x + distance, z + distance);
        for (uint32_t row = from.row; row <= to.row; row++) {
            for (uint32_t column = from.column; column <= to.column; column++)
                add_cell(&part, terrain, column, row);
        }
    }
    part.at_m = triangle_height(terrain, &middle);
    part.rim_m = (crater ? surface->rim_m : 0.0) + works_m;
    return part;
}
