/* A grid with lists of stretches, made by counting. */
#include "world/road_index.h"

#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

#define SIDE_MAX 512u /* cells: 98 m at the most */

/* Cells from column0, row0 to column1, row1, all included. */
struct cells {
    uint32_t column0, row0, column1, row1;
};

static uint32_t cell_of(const struct road_index *index, double place_m)
{
    return (uint32_t)maths_clamp(place_m * index->cells_a_m, 0.0, (double)(index->side - 1));
}

static struct cells cells_of(const struct road_index *index, double x0, double z0, double x1,
                             double z1)
{
    return (struct cells){cell_of(index, x0), cell_of(index, z0), cell_of(index, x1),
                          cell_of(index, z1)};
}

bool road_index_is_stretch(const struct road_point *points, uint32_t count, uint32_t i)
{
    return i + 1 < count && points[i].road == points[i + 1].road;
}

struct bounds {
    double x0, z0, x1, z1;
};

static struct bounds bounds_of(const struct road_index *index, uint32_t stretch)
{
    const struct road_point *a = &index->points[stretch], *b = a + 1;
    return (struct bounds){.x0 = maths_min(a->x, b->x),
                           .z0 = maths_min(a->z, b->z),
                           .x1 = maths_max(a->x, b->x),
                           .z1 = maths_max(a->z, b->z)};
}

static struct cells cells_of_stretch(const struct road_index *index, uint32_t stretch)
{
    struct bounds b = bounds_of(index, stretch);
    return cells_of(index, b.x0, b.z0, b.x1, b.z1);
}

/* Counts the stretches of each cell into first[cell], or puts them there, from the end of each
 * list. */
static void each_cell(struct road_index *index, uint32_t stretch, bool put)
{
    struct cells cells = cells_of_stretch(index, stretch);
    for (uint32_t row = cells.row0; row <= cells.row1; row++)
        for (uint32_t column = cells.column0; column <= cells.column1; column++) {
            uint32_t *first = &index->first[row * index->side + column];
            if (put)
                index->stretches[--*first] = stretch;
            else
                ++*first;
        }
}

int road_index_make(struct road_index *index, const struct road_point *points, uint32_t count,
                    double side_m)
{
    double side = ceil(sqrt(0.5 * (double)count));
    *index = (struct road_index){.points = points,
                                 .side = (uint32_t)maths_clamp(side, 1.0, (double)SIDE_MAX)};
    index->cells_a_m = (double)index->side / side_m;
    uint32_t cells = index->side * index->side;
    index->first = calloc((size_t)cells + 1, sizeof *index->first);
    if (!index->first)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        if (road_index_is_stretch(points, count, i))
            each_cell(index, i, false);
    for (uint32_t cell = 0; cell < cells; cell++)
        index->first[cell + 1] += index->first[cell];
    index->stretches = malloc(((size_t)index->first[cells] + 1) * sizeof *index->stretches);
    if (!index->stretches) {
        road_index_free(index);
        errno = ENOMEM;
        return -1;
    }
    for (uint32_t i = count; i-- > 0;)
        if (road_index_is_stretch(points, count, i))
            each_cell(index, i, true);
    return 0;
}

void road_index_free(struct road_index *index)
{
    free(index->first);
    free(index->stretches);
    *index = (struct road_index){0};
}

struct road_walk road_index_walk(const struct road_index *index, double x0, double z0, double x1,
                                 double z1)
{
    struct cells cells = cells_of(index, x0, z0, x1, z1);
    return (struct road_walk){.index = index,
                              .x0 = x0,
                              .z0 = z0,
                              .x1 = x1,
                              .z1 = z1,
                              .column0 = cells.column0,
                              .row0 = cells.row0,
                              .column1 = cells.column1,
                              .row1 = cells.row1,
                              .column = cells.column0,
                              .row = cells.row0,
                              .at = index->first[cells.row0 * index->side + cells.column0]};
}

/* Whether the stretch touches the walk's rectangle and was not found in an earlier cell: it is told
 * in the first cell that it shares with the walk. */
static bool is_found(const struct road_walk *walk, uint32_t stretch)
{
    const struct road_index *index = walk->index;
    struct bounds b = bounds_of(index, stretch);
    if (!(b.x0 <= walk->x1 && b.x1 >= walk->x0 && b.z0 <= walk->z1 && b.z1 >= walk->z0))
        return false;
    return (walk->column == walk->column0 || cell_of(index, b.x0) == walk->column) &&
           (walk->row == walk->row0 || cell_of(index, b.z0) == walk->row);
}

bool road_walk_next(struct road_walk *walk, uint32_t *stretch)
{
    const struct road_index *index = walk->index;
    while (walk->row <= walk->row1) {
        uint32_t cell = walk->row * index->side + walk->column;
        while (walk->at < index->first[cell + 1]) {
            *stretch = index->stretches[walk->at++];
            if (is_found(walk, *stretch))
                return true;
        }
        if (walk->column++ == walk->column1) {
            walk->column = walk->column0;
            walk->row++;
        }
        if (walk->row <= walk->row1)
            walk->at = index->first[walk->row * index->side + walk->column];
    }
    return false;
}
