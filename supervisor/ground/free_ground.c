/* Legs and discs by the cells of a grid. */
#include "supervisor/ground/free_ground.h"

#include "world/maths/maths.h"

#include <stdlib.h>

#define CELLS_MAX 1000.0
#define CELL_M    50.0
#define PLANT_M   4.0 /* no plant has a larger radius */

/* All within radius_m of a line. */
struct taken {
    double a[2], b[2], radius_m;
};

struct free_ground {
    double cell_m;
    uint32_t side; /* cells along one edge */
    struct taken *taken;
    uint32_t used;
    uint32_t *start; /* [side * side + 1] into item */
    uint32_t *item;
};

static uint32_t cell_of(const struct free_ground *ground, double metres)
{
    double cell = maths_clamp(metres / ground->cell_m, 0.0, (double)(ground->side - 1));
    return (uint32_t)cell;
}

/* Counts the cells of each line, or fills them in. */
static void go_over(const struct free_ground *ground, uint32_t *count, bool fill)
{
    for (uint32_t i = 0; i < ground->used; i++) {
        const struct taken *t = &ground->taken[i];
        double reach = t->radius_m + PLANT_M;
        uint32_t x0 = cell_of(ground, maths_min(t->a[0], t->b[0]) - reach);
        uint32_t x1 = cell_of(ground, maths_max(t->a[0], t->b[0]) + reach);
        uint32_t z0 = cell_of(ground, maths_min(t->a[1], t->b[1]) - reach);
        uint32_t z1 = cell_of(ground, maths_max(t->a[1], t->b[1]) + reach);
        for (uint32_t row = z0; row <= z1; row++) {
            for (uint32_t column = x0; column <= x1; column++) {
                uint32_t cell = row * ground->side + column;
                if (fill)
                    ground->item[ground->start[cell] + count[cell]] = i;
                count[cell]++;
            }
        }
    }
}

static bool index_lines(struct free_ground *ground)
{
    size_t cells = (size_t)ground->side * ground->side;
    uint32_t *count = calloc(cells + 1, sizeof *count);
    ground->start = calloc(cells + 1, sizeof *ground->start);
    if (count && ground->start) {
        go_over(ground, count, false);
        for (size_t i = 0; i < cells; i++) {
            ground->start[i + 1] = ground->start[i] + count[i];
            count[i] = 0;
        }
        ground->item = calloc((size_t)ground->start[cells] + 1, sizeof *ground->item);
        if (ground->item)
            go_over(ground, count, true);
    }
    free(count);
    return ground->item != NULL;
}

struct free_ground *free_ground_make(double side_m, const struct ground_road_point *roads,
                                     uint32_t road_points, double (*disc)[3], uint32_t discs)
{
    struct free_ground *ground = calloc(1, sizeof *ground);
    if (!ground)
        return NULL;
    ground->cell_m = maths_max(CELL_M, side_m / CELLS_MAX);
    ground->side = (uint32_t)(side_m / ground->cell_m) + 1;
    ground->taken = calloc((size_t)road_points + discs + 1, sizeof *ground->taken);
    for (uint32_t i = 0; i + 1 < road_points && ground->taken; i++) {
        const struct ground_road_point *p = &roads[i], *q = p + 1;
        if (p->road == q->road)
            ground->taken[ground->used++] = (struct taken){{p->x_mm / 1000.0, p->z_mm / 1000.0},
                                                           {q->x_mm / 1000.0, q->z_mm / 1000.0},
                                                           FREE_GROUND_ROAD_M};
    }
    for (uint32_t i = 0; i < discs && ground->taken; i++)
        ground->taken[ground->used++] =
            (struct taken){{disc[i][0], disc[i][1]}, {disc[i][0], disc[i][1]}, disc[i][2]};
    if (!ground->taken || !index_lines(ground)) {
        free_ground_free(ground);
        return NULL;
    }
    return ground;
}

void free_ground_free(struct free_ground *ground)
{
    if (!ground)
        return;
    free(ground->taken);
    free(ground->start);
    free(ground->item);
    free(ground);
}

static bool is_near(const struct taken *t, double x, double z, double radius_m)
{
    double dx = t->b[0] - t->a[0], dz = t->b[1] - t->a[1], square = dx * dx + dz * dz;
    double share = square > 0.0 ? ((x - t->a[0]) * dx + (z - t->a[1]) * dz) / square : 0.0;
    share = maths_clamp(share, 0.0, 1.0);
    double ox = x - t->a[0] - share * dx, oz = z - t->a[1] - share * dz;
    double reach = t->radius_m + radius_m;
    return ox * ox + oz * oz < reach * reach;
}

bool free_ground_is(const struct free_ground *ground, double x, double z, double radius_m)
{
    uint32_t cell = cell_of(ground, z) * ground->side + cell_of(ground, x);
    for (uint32_t i = ground->start[cell]; i < ground->start[cell + 1]; i++) {
        if (is_near(&ground->taken[ground->item[i]], x, z, radius_m))
            return false;
    }
    return true;
}
