/* Sort and sweep, and a grid of walls. */
#include "supervisor/physics/neighbour_pairs.h"

#include "world/entity/kind.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdlib.h>

#define CELL_M         32.0
#define WORLD_EDGE_M   50000.0
#define WALL_RIGIDITY  0.1 /* less rigid objects bend aside (docs/collisions.md) */
#define MOVES_A_BALL   4   /* with more a whole sort is faster */
#define CELLS_PER_SIDE ((uint32_t)(WORLD_EDGE_M / CELL_M) + 1)

int neighbour_pairs_add(struct neighbour_pairs *pairs, uint32_t a, uint32_t b)
{
    if (pairs->count == pairs->capacity) {
        uint32_t capacity = 2 * pairs->capacity + 256;
        struct neighbour_pair *more = realloc(pairs->pair, capacity * sizeof *more);
        if (!more)
            return -1;
        pairs->pair = more;
        pairs->capacity = capacity;
    }
    pairs->pair[pairs->count++] = (struct neighbour_pair){a, b};
    return 0;
}

void neighbour_pairs_free(struct neighbour_pairs *pairs)
{
    free(pairs->pair);
    *pairs = (struct neighbour_pairs){0};
}

static double west_of(const struct neighbour_ball *ball)
{
    return ball->at.x - ball->reach_m;
}

/* Moves balls to their places. Gives up when they are far from them. */
static bool sort_nearly(struct neighbour_ball *ball, uint32_t count)
{
    uint64_t moves = 0;
    for (uint32_t i = 1; i < count && moves <= MOVES_A_BALL * (uint64_t)count; i++) {
        const struct neighbour_ball taken = ball[i];
        uint32_t place = i;
        for (; place > 0 && west_of(&ball[place - 1]) > west_of(&taken); place--, moves++)
            ball[place] = ball[place - 1];
        ball[place] = taken;
    }
    return moves <= MOVES_A_BALL * (uint64_t)count;
}

static int from_west(const void *a, const void *b)
{
    double p = west_of(a), q = west_of(b);
    return (p > q) - (p < q);
}

int neighbour_pairs_find(struct neighbour_pairs *pairs, struct neighbour_ball *ball, uint32_t count)
{
    pairs->count = 0;
    if (!sort_nearly(ball, count))
        qsort(ball, count, sizeof *ball, from_west);
    for (uint32_t i = 0; i < count; i++) {
        const struct neighbour_ball *a = &ball[i];
        for (uint32_t j = i + 1; j < count && west_of(&ball[j]) <= a->at.x + a->reach_m; j++) {
            const struct neighbour_ball *b = &ball[j];
            double reach = a->reach_m + b->reach_m;
            if (fabs(a->at.z - b->at.z) <= reach && fabs(a->at.y - b->at.y) <= reach &&
                neighbour_pairs_add(pairs, a->body, b->body) != 0)
                return -1;
        }
    }
    return 0;
}

/* --- walls -------------------------------------------------------------------------------------*/

struct cells {
    uint32_t west, north, east, south;
};

static uint32_t cell_of(double metres)
{
    return (uint32_t)(maths_clamp(metres, 0.0, WORLD_EDGE_M) / CELL_M);
}

static struct cells cells_around(double x, double z, double reach)
{
    return (struct cells){cell_of(x - reach), cell_of(z - reach), cell_of(x + reach),
                          cell_of(z + reach)};
}

static double wall_reach(const struct world *world, const struct fixed_object *object)
{
    const struct kind *kind = &world->kinds[object->kind];
    return kind->bound_m * (double)object->radius_m / kind->radius_m;
}

static bool is_wall(const struct world *world, const struct fixed_object *object)
{
    return world->kinds[object->kind].rigidity >= WALL_RIGIDITY;
}

static struct cells cells_of_wall(const struct world *world, const struct fixed_object *object)
{
    return cells_around(object->x, object->z, wall_reach(world, object));
}

/* Counts the entries of each cell in start[cell + 1], or, with items, writes them and moves
 * start[cell] on. */
static void walk(struct wall_grid *grid, const struct world *world, uint32_t *item)
{
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        if (!is_wall(world, &world->fixed[i]))
            continue;
        const struct cells cells = cells_of_wall(world, &world->fixed[i]);
        for (uint32_t row = cells.north; row <= cells.south; row++) {
            for (uint32_t column = cells.west; column <= cells.east; column++) {
                uint32_t cell = row * grid->side + column;
                if (item)
                    item[grid->start[cell]++] = i;
                else
                    grid->start[cell + 1]++;
            }
        }
    }
}

int wall_grid_make(struct wall_grid *grid, const struct world *world)
{
    *grid = (struct wall_grid){0};
    if (world->counts.fixed == 0)
        return 0;
    grid->side = CELLS_PER_SIDE;
    size_t cells = (size_t)grid->side * grid->side;
    grid->start = calloc(cells + 1, sizeof *grid->start);
    if (!grid->start)
        return -1;
    walk(grid, world, NULL);
    for (size_t i = 0; i < cells; i++)
        grid->start[i + 1] += grid->start[i];
    grid->item = calloc((size_t)grid->start[cells] + 1, sizeof *grid->item);
    if (!grid->item) {
        wall_grid_free(grid);
        return -1;
    }
    walk(grid, world, grid->item);
    for (size_t i = cells; i > 0; i--) /* each start has moved to the next cell's */
        grid->start[i] = grid->start[i - 1];
    grid->start[0] = 0;
    return 0;
}

void wall_grid_free(struct wall_grid *grid)
{
    free(grid->start);
    free(grid->item);
    *grid = (struct wall_grid){0};
}

static bool cubes_meet(const struct neighbour_ball *ball, const struct fixed_object *object,
                       double reach_m)
{
    double reach = ball->reach_m + reach_m;
    return fabs(ball->at.x - object->x) <= reach && fabs(ball->at.z - object->z) <= reach &&
           fabs(ball->at.y - (double)object->y) <= reach;
}

int wall_grid_find(const struct wall_grid *grid, const struct world *world,
                   const struct neighbour_ball *ball, struct neighbour_pairs *pairs)
{
    if (grid->side == 0)
        return 0;
    const struct cells mine = cells_around(ball->at.x, ball->at.z, ball->reach_m);
    for (uint32_t row = mine.north; row <= mine.south; row++) {
        for (uint32_t column = mine.west; column <= mine.east; column++) {
            uint32_t cell = row * grid->side + column;
            for (uint32_t i = grid->start[cell]; i < grid->start[cell + 1]; i++) {
                const struct fixed_object *object = &world->fixed[grid->item[i]];
                const struct cells its = cells_of_wall(world, object);
                /* Of the cells that both are in, the north-western one tells the pair. */
                bool first = row == (its.north > mine.north ? its.north : mine.north) &&
                             column == (its.west > mine.west ? its.west : mine.west);
                if (first && cubes_meet(ball, object, wall_reach(world, object)) &&
                    neighbour_pairs_add(pairs, ball->body, grid->item[i]) != 0)
                    return -1;
            }
        }
    }
    return 0;
}
