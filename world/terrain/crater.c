/* The private index over the shared list of craters, and the shape of the ground in them. */
#include "world/terrain/crater.h"

#include "world/maths/maths.h"
#include "world/runtime/reserve.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

int crater_index_init(struct crater_index *index, const struct gridsquares *squares,
                      const struct crater *craters)
{
    *index = (struct crater_index){.craters = craters, .squares = *squares};
    index->head = calloc(squares->count, sizeof *index->head);
    index->links = reserve_take(CRATER_SLOTS_MAX * CRATER_SQUARES, sizeof *index->links);
    if (index->head && index->links)
        return 0;
    crater_index_free(index);
    errno = ENOMEM;
    return -1;
}

void crater_index_free(struct crater_index *index)
{
    free(index->head);
    reserve_free(index->links);
    *index = (struct crater_index){0};
}

static struct gridsquare_box reach_of(const struct gridsquares *squares,
                                      const struct crater *crater)
{
    double reach = maths_min((double)crater->radius_m, CRATER_RADIUS_MAX) * CRATER_RIM;
    return gridsquare_box_of(squares, crater->x - reach, crater->z - reach, crater->x + reach,
                             crater->z + reach);
}

void crater_index_update(struct crater_index *index, uint32_t count)
{
    if (count < index->count) {
        memset(index->head, 0, index->squares.count * sizeof *index->head);
        index->link_count = 0;
        index->count = 0;
        index->rim_m = 0.0;
    }
    while (index->count < count) {
        struct gridsquare_box box = reach_of(&index->squares, &index->craters[index->count]);
        for (int32_t row = box.z0; row <= box.z1; row++) {
            for (int32_t column = box.x0; column <= box.x1; column++) {
                uint32_t *head = &index->head[gridsquare_index(&index->squares, column, row)];
                index->links[index->link_count] = (struct crater_link){index->count, *head};
                *head = ++index->link_count;
            }
        }
        index->rim_m = maths_max(index->rim_m,
                                 (double)index->craters[index->count].depth_m * CRATER_RIM_HEIGHT);
        index->count++;
    }
}

/* A paraboloid bowl, then a rim that rises and falls off to CRATER_RIM radii. */
static double profile(const struct crater *crater, double x, double z)
{
    double radius = (double)crater->radius_m;
    double depth = (double)crater->depth_m;
    if (!(radius > 0.0))
        return 0.0;
    double dx = (x - crater->x) / radius;
    double dz = (z - crater->z) / radius;
    double square = dx * dx + dz * dz;
    if (square >= CRATER_RIM * CRATER_RIM)
        return 0.0;
    double rim = depth * CRATER_RIM_HEIGHT;
    if (square < 1.0)
        return -depth + (depth + rim) * square;
    double t = (CRATER_RIM - sqrt(square)) / (CRATER_RIM - 1.0);
    return rim * t * t;
}

double crater_offset(const struct crater_index *index, double x, double z)
{
    double deepest = 0.0;
    double highest = 0.0;
    if (index->count == 0)
        return 0.0;
    uint32_t link = index->head[gridsquare_of(&index->squares, x, z)];
    while (link != 0) {
        const struct crater_link *entry = &index->links[link - 1];
        double offset = profile(&index->craters[entry->crater], x, z);
        deepest = maths_min(deepest, offset);
        highest = maths_max(highest, offset);
        link = entry->next;
    }
    return deepest < 0.0 ? deepest : highest;
}

struct crater_walk crater_walk_begin(const struct crater_index *index, double x, double z,
                                     double reach_m)
{
    struct crater_walk walk = {.index = index, .box = {.z1 = -1}};
    if (index->count == 0)
        return walk;
    walk.box =
        gridsquare_box_of(&index->squares, x - reach_m, z - reach_m, x + reach_m, z + reach_m);
    walk.column = walk.box.x0;
    walk.row = walk.box.z0;
    return walk;
}

const struct crater *crater_walk_next(struct crater_walk *walk)
{
    const struct crater_index *index = walk->index;
    while (walk->link == 0 && walk->row <= walk->box.z1) {
        walk->link = index->head[gridsquare_index(&index->squares, walk->column, walk->row)];
        if (++walk->column > walk->box.x1) {
            walk->column = walk->box.x0;
            walk->row++;
        }
    }
    if (walk->link == 0)
        return NULL;
    const struct crater_link *entry = &index->links[walk->link - 1];
    walk->link = entry->next;
    return &index->craters[entry->crater];
}

bool crater_index_near(const struct crater_index *index, double x, double z, double reach_m)
{
    struct crater_walk walk = crater_walk_begin(index, x, z, reach_m);
    const struct crater *crater;
    while ((crater = crater_walk_next(&walk)) != NULL) {
        double own = (double)crater->radius_m * CRATER_RIM + reach_m;
        if (fabs(crater->x - x) < own && fabs(crater->z - z) < own)
            return true;
    }
    return false;
}

double crater_footing_lift(double offset[3][3])
{
    double middle = offset[1][1], front = offset[2][1], back = offset[0][1];
    double right = offset[1][2], left = offset[1][0];
    double pitch = 0.5 * (front - back), roll = 0.5 * (right - left);
    double lift = maths_max(0.0, maths_max(0.5 * (front + back), 0.5 * (right + left)) - middle);
    for (int corner = 0; corner < 4; corner++) {
        double along = corner & 1 ? 1.0 : -1.0, across = corner & 2 ? 1.0 : -1.0;
        double plane = middle + along * pitch + across * roll;
        lift = maths_max(lift, offset[corner & 1 ? 2 : 0][corner & 2 ? 2 : 0] - plane);
    }
    return lift;
}

double crater_lift(const struct crater_index *index, const struct crater_footing *footing)
{
    double offset[3][3];
    if (index->count == 0)
        return 0.0;
    for (int i = 0; i < 9; i++) {
        double x, z;
        crater_footing_point(footing, i / 3 - 1, i % 3 - 1, &x, &z);
        offset[i / 3][i % 3] = crater_offset(index, x, z);
    }
    return crater_footing_lift(offset);
}
