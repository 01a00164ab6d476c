/* The shape of earthworks, and their index by gridsquare. */
#include "world/terrain/earthwork.h"

#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Cells of points: so many along a gridsquare at most, and so many in all. */
#define SPLIT_MOST 16u
#define CELLS_MOST 262144u

double earthwork_reach_x(const struct earthwork *work)
{
    return fabs(work->sine) * work->half_length + fabs(work->cosine) * work->half_width;
}

double earthwork_reach_z(const struct earthwork *work)
{
    return fabs(work->cosine) * work->half_length + fabs(work->sine) * work->half_width;
}

/* --- the index ---------------------------------------------------------------------------------*/

static struct gridsquare_box box_of(const struct gridsquares *squares, const struct earthwork *work)
{
    double x = earthwork_reach_x(work), z = earthwork_reach_z(work);
    return gridsquare_box_of(squares, work->x - x, work->z - z, work->x + x, work->z + z);
}

static struct gridsquare_box box_of_all(const struct gridsquares *squares,
                                        const struct earthwork *works, uint32_t count)
{
    struct gridsquare_box all = box_of(squares, &works[0]);
    for (uint32_t i = 1; i < count; i++) {
        struct gridsquare_box box = box_of(squares, &works[i]);
        all.x0 = box.x0 < all.x0 ? box.x0 : all.x0;
        all.z0 = box.z0 < all.z0 ? box.z0 : all.z0;
        all.x1 = box.x1 > all.x1 ? box.x1 : all.x1;
        all.z1 = box.z1 > all.z1 ? box.z1 : all.z1;
    }
    return all;
}

/* How an index divides the ground. */
struct division {
    int32_t column, row;    /* its first cell, in cells from the corner of the world */
    uint32_t columns, rows; /* cells */
    double side_m;          /* of a cell */
};

static uint32_t cells_of(const struct division *division)
{
    return division->columns * division->rows;
}

/* The cells that a work may reach into, as columns and rows of the division. */
static struct gridsquare_box cells_under(const struct division *division,
                                         const struct gridsquares *squares,
                                         const struct earthwork *work)
{
    const double x = earthwork_reach_x(work), z = earthwork_reach_z(work);
    const double side = division->side_m, most = squares->world_m;
    const int32_t right = (int32_t)division->columns - 1, down = (int32_t)division->rows - 1;
    struct gridsquare_box box = {(int32_t)(maths_clamp(work->x - x, 0.0, most) / side),
                                 (int32_t)(maths_clamp(work->z - z, 0.0, most) / side),
                                 (int32_t)(maths_clamp(work->x + x, 0.0, most) / side),
                                 (int32_t)(maths_clamp(work->z + z, 0.0, most) / side)};
    box.x0 -= division->column, box.x1 -= division->column;
    box.z0 -= division->row, box.z1 -= division->row;
    /* the far edge of the world belongs to the last cell */
    box.x0 = box.x0 < right ? box.x0 : right, box.x1 = box.x1 < right ? box.x1 : right;
    box.z0 = box.z0 < down ? box.z0 : down, box.z1 = box.z1 < down ? box.z1 : down;
    return box;
}

/* Lists the works of each cell: starts[0..cells], then the works' numbers, ascending in each cell.
 * words NULL: only counts. Returns the number of words. */
static size_t list_cells(const struct division *division, const struct gridsquares *squares,
                         const struct earthwork *works, uint32_t count, uint32_t *words)
{
    size_t entries = 0, cells = cells_of(division);
    if (words)
        memset(words, 0, (cells + 1) * sizeof *words);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < count; i++) {
            const struct gridsquare_box box = cells_under(division, squares, &works[i]);
            for (int32_t row = box.z0; row <= box.z1; row++) {
                for (int32_t column = box.x0; column <= box.x1; column++) {
                    size_t cell = (size_t)row * division->columns + (size_t)column;
                    if (pass == 0 && words)
                        words[cell + 1]++;
                    else if (pass == 1)
                        words[cells + 1 + words[cell]++] = i;
                    entries += pass == 0;
                }
            }
        }
        if (!words)
            break;
        for (size_t cell = 0; pass == 0 && cell < cells; cell++)
            words[cell + 1] += words[cell];
    }
    /* Each start has moved to its end, which is the start of the next. */
    for (size_t cell = cells; words && cell > 0; cell--)
        words[cell] = words[cell - 1];
    if (words)
        words[0] = 0;
    return cells + 1 + entries;
}

/* Divides the squares into cells, as fine as CELLS_MOST allows. */
static struct division divide(const struct gridsquares *squares, const struct gridsquare_box *all,
                              uint32_t split)
{
    return (struct division){.column = all->x0 * (int32_t)split,
                             .row = all->z0 * (int32_t)split,
                             .columns = (uint32_t)(all->x1 - all->x0 + 1) * split,
                             .rows = (uint32_t)(all->z1 - all->z0 + 1) * split,
                             .side_m = squares->side_m / split};
}

int earthwork_index_build(const struct earthwork *works, uint32_t count,
                          const struct gridsquares *squares, uint32_t **index, uint32_t *words)
{
    *index = NULL;
    *words = 0;
    if (count == 0)
        return 0;
    struct gridsquare_box all = box_of_all(squares, works, count);
    struct division whole = divide(squares, &all, 1), fine = whole;
    uint32_t split = 1;
    while (split < SPLIT_MOST && 4 * cells_of(&fine) <= CELLS_MOST)
        fine = divide(squares, &all, split *= 2);
    size_t first = EARTHWORK_INDEX_HEAD + list_cells(&whole, squares, works, count, NULL);
    size_t length = first + list_cells(&fine, squares, works, count, NULL);
    uint32_t *list = malloc(length * sizeof *list);
    if (list == NULL)
        return -1;
    const uint32_t head[EARTHWORK_INDEX_HEAD] = {
        (uint32_t)all.x0, (uint32_t)all.z0, whole.columns, whole.rows, split, (uint32_t)first};
    memcpy(list, head, sizeof head);
    list_cells(&whole, squares, works, count, list + EARTHWORK_INDEX_HEAD);
    list_cells(&fine, squares, works, count, list + first);
    *index = list;
    *words = (uint32_t)length;
    return 0;
}

/* The works of the square in this column and row of the world. */
static inline const uint32_t *in_square(const struct earthworks *works, int32_t column, int32_t row,
                                        uint32_t *count)
{
    const uint32_t *index = works->index, *start = index + EARTHWORK_INDEX_HEAD;
    uint32_t right = (uint32_t)column - index[EARTHWORK_COLUMN];
    uint32_t down = (uint32_t)row - index[EARTHWORK_ROW];
    uint32_t columns = index[EARTHWORK_COLUMNS], rows = index[EARTHWORK_ROWS];
    *count = 0;
    if (right >= columns || down >= rows)
        return NULL;
    uint32_t square = down * columns + right;
    *count = start[square + 1] - start[square];
    return start + (size_t)columns * rows + 1 + start[square];
}

const uint32_t *earthwork_in_square(const struct earthworks *works, uint32_t square,
                                    uint32_t *count)
{
    *count = 0;
    return works->count == 0 ? NULL
                             : in_square(works, gridsquare_column(&works->squares, square),
                                         gridsquare_row(&works->squares, square), count);
}

/* The column or the row of a cell, as gridsquare_axis() finds that of a square. */
static inline uint32_t cell_axis(const struct earthworks *works, double metres, uint32_t first,
                                 uint32_t split)
{
    int32_t square = gridsquare_axis(&works->squares, metres);
    double within = maths_min(metres, works->squares.world_m) - square * works->squares.side_m;
    double cell = within / (works->squares.side_m / split);
    cell = cell > 0.0 ? cell : 0.0;
    uint32_t most = split - 1;
    return ((uint32_t)square - first) * split + ((uint32_t)cell < most ? (uint32_t)cell : most);
}

/* The works that may reach to a point. */
static inline const uint32_t *works_at(const struct earthworks *works, double x, double z,
                                       uint32_t *count)
{
    const uint32_t *index = works->index;
    *count = 0;
    if (works->count == 0)
        return NULL;
    const uint32_t split = index[EARTHWORK_SPLIT];
    const uint32_t right = cell_axis(works, x, index[EARTHWORK_COLUMN], split);
    const uint32_t down = cell_axis(works, z, index[EARTHWORK_ROW], split);
    const uint32_t columns = index[EARTHWORK_COLUMNS] * split;
    const uint32_t rows = index[EARTHWORK_ROWS] * split;
    if (right >= columns || down >= rows)
        return NULL;
    const uint32_t *start = index + index[EARTHWORK_CELLS] + (size_t)down * columns + right;
    *count = start[1] - start[0];
    return index + index[EARTHWORK_CELLS] + (size_t)columns * rows + 1 + start[0];
}

/* --- the shape ---------------------------------------------------------------------------------*/

/* A point in the work's own axes [m]: from its back end, from its front end, from its nearer
 * side. */
struct work_point {
    double from_back, from_front, from_side;
};

static inline struct work_point point_of(const struct earthwork *work, double x, double z)
{
    double dx = x - work->x, dz = z - work->z;
    double along = dx * work->sine - dz * work->cosine;
    double across = dx * work->cosine + dz * work->sine;
    return (struct work_point){work->half_length + along, work->half_length - along,
                               work->half_width - fabs(across)};
}

bool earthwork_holds(const struct earthwork *work, double x, double z)
{
    struct work_point at = point_of(work, x, z);
    return at.from_back > 0.0 && at.from_front > 0.0 && at.from_side > 0.0;
}

double earthwork_height(const struct earthwork *work, double x, double z)
{
    struct work_point at = point_of(work, x, z);
    double share = maths_min(maths_min(at.from_back / work->back_m, at.from_front / work->front_m),
                             maths_min(at.from_side / work->side_m, 1.0));
    if (!(share > 0.0))
        return 0.0;
    if (work->wave_m > 0.0) {
        double sine, cosine;
        maths_sincos(maths_wrap_turn(at.from_back / work->wave_m * TWO_PI), &sine, &cosine);
        share *= 0.5 - 0.5 * cosine;
    }
    return work->height_m * share;
}

double earthwork_offset(const struct earthworks *works, double x, double z)
{
    uint32_t count;
    const uint32_t *items = works_at(works, x, z, &count);
    double highest = 0.0, deepest = 0.0;
    for (uint32_t n = 0; n < count; n++) {
        double height = earthwork_height(&works->works[items[n]], x, z);
        highest = maths_max(highest, height);
        deepest = maths_min(deepest, height);
    }
    return highest + deepest;
}

bool earthwork_covers(const struct earthworks *works, double x, double z)
{
    uint32_t count;
    const uint32_t *items = works_at(works, x, z, &count);
    for (uint32_t n = 0; n < count; n++) {
        if (earthwork_holds(&works->works[items[n]], x, z))
            return true;
    }
    return false;
}

bool earthwork_near(const struct earthworks *works, double x, double z, double reach_m)
{
    if (works->count == 0)
        return false;
    const struct gridsquare_box box =
        gridsquare_box_of(&works->squares, x - reach_m, z - reach_m, x + reach_m, z + reach_m);
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint32_t count;
            const uint32_t *items = in_square(works, column, row, &count);
            for (uint32_t n = 0; n < count; n++) {
                const struct work_point at = point_of(&works->works[items[n]], x, z);
                if (at.from_back > -reach_m && at.from_front > -reach_m && at.from_side > -reach_m)
                    return true;
            }
        }
    }
    return false;
}

double earthwork_water(const struct earthworks *works, double x, double z)
{
    uint32_t count;
    const uint32_t *items = works_at(works, x, z, &count);
    double depth = 0.0;
    for (uint32_t n = 0; n < count; n++) {
        const struct earthwork *work = &works->works[items[n]];
        if (work->shape == EARTHWORK_FORD && earthwork_holds(work, x, z))
            depth = maths_max(depth, -earthwork_offset(works, x, z) - work->freeboard_m);
    }
    return depth;
}

double earthwork_grip(const struct earthworks *works, double x, double z)
{
    uint32_t count;
    const uint32_t *items = works_at(works, x, z, &count);
    double grip = 1.0;
    for (uint32_t n = 0; n < count; n++) {
        const struct earthwork *work = &works->works[items[n]];
        if (work->grip < grip && earthwork_holds(work, x, z))
            grip = work->grip;
    }
    return grip;
}

bool earthwork_range(const struct earthworks *works, const struct gridsquare_box *box,
                     double *highest_m, double *lowest_m)
{
    bool any = false;
    *highest_m = *lowest_m = 0.0;
    for (int32_t row = box->z0; row <= box->z1 && works->count > 0; row++) {
        for (int32_t column = box->x0; column <= box->x1; column++) {
            uint32_t count;
            const uint32_t *items = in_square(works, column, row, &count);
            for (uint32_t n = 0; n < count; n++) {
                double height = works->works[items[n]].height_m;
                *highest_m = maths_max(*highest_m, height);
                *lowest_m = maths_min(*lowest_m, height);
                any = any || height != 0.0;
            }
        }
    }
    return any;
}
