/* The shape of earthworks, and their index by gridsquare. */
#include "world/terrain/earthwork.h"

#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

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

static bool overlap(const struct gridsquare_box *box, int32_t column, int32_t row)
{
    return column >= box->x0 && column <= box->x1 && row >= box->z0 && row <= box->z1;
}

/* Returns the number of entries that the boxes of all works have together. */
static size_t entries_of(const struct gridsquares *squares, const struct earthwork *works,
                         uint32_t count)
{
    size_t entries = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct gridsquare_box box = box_of(squares, &works[i]);
        entries += (size_t)(box.x1 - box.x0 + 1) * (size_t)(box.z1 - box.z0 + 1);
    }
    return entries;
}

int earthwork_index_build(const struct earthwork *works, uint32_t count,
                          const struct gridsquares *squares, uint32_t **index, uint32_t *words)
{
    *index = NULL;
    *words = 0;
    if (count == 0)
        return 0;
    struct gridsquare_box all = box_of_all(squares, works, count);
    uint32_t columns = (uint32_t)(all.x1 - all.x0 + 1), rows = (uint32_t)(all.z1 - all.z0 + 1);
    uint32_t cells = columns * rows, used = 0;
    size_t length = EARTHWORK_INDEX_HEAD + cells + 1 + entries_of(squares, works, count);
    uint32_t *list = malloc(length * sizeof *list);
    if (list == NULL)
        return -1;
    const uint32_t head[] = {(uint32_t)all.x0, (uint32_t)all.z0, columns, rows};
    memcpy(list, head, sizeof head);
    uint32_t *start = list + EARTHWORK_INDEX_HEAD, *items = start + cells + 1;
    for (uint32_t s = 0; s < cells; s++) {
        start[s] = used;
        for (uint32_t i = 0; i < count; i++) {
            struct gridsquare_box box = box_of(squares, &works[i]);
            if (overlap(&box, all.x0 + (int32_t)(s % columns), all.z0 + (int32_t)(s / columns)))
                items[used++] = i;
        }
    }
    start[cells] = used;
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

static inline const uint32_t *works_at(const struct earthworks *works, double x, double z,
                                       uint32_t *count)
{
    *count = 0;
    return works->count == 0 ? NULL
                             : in_square(works, gridsquare_axis(&works->squares, x),
                                         gridsquare_axis(&works->squares, z), count);
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
