/* Space occupancy (Uchiki, Ohashi and Tokoro 1983, as cited by Osborne 1991, p. 5): every body
 * claims the cells of space that it needs in the frame. A body that claims an occupied cell is told
 * which bodies hold it.
 *
 * Here a body claims the cells that its swept box touches. The cells are entries of a hash table;
 * their side is such that half of all bodies fit into one. A body that would need more than
 * CLAIMS_MAX cells claims cells of twice the side, four times the side and so on, so the number of
 * claims is bounded for any size and speed. The coarsest claims come first, and each body also
 * looks at every coarser level in use, so that all pairs meet. */
#include "collider/method/method.h"

#include "world/maths/random.h"
#include "world/runtime/work_done.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <string.h>

#define FINEST_M   0.25 /* side of a cell at level 0 */
#define LEVELS     19
#define CLAIMS_MAX 64
#define AXIS_BITS  19 /* bits of a cell's number along one axis: 65 km each way at level 0 */
#define AXIS_HALF  262144
#define NO_CLAIM   UINT32_MAX

enum { BLOCK_LEVEL, BLOCK_ORDER, BLOCK_CLAIM, BLOCK_HEAD };

/* A cell claimed by a body. */
struct claim {
    uint64_t cell;
    uint32_t body;
    uint32_t next; /* next claim of the same hash; NO_CLAIM: none */
};

struct space {
    const struct method_input *input;
    struct method_bodies bodies;
    uint8_t *level;  /* [bodies] of the cells that the body claims */
    uint32_t *order; /* bodies, the coarsest level first */
    struct claim *claim;
    uint32_t claims;
    uint32_t *head; /* [mask + 1] first claim of a hash */
    uint32_t mask;
    bool used[LEVELS];
};

static double side_of(uint32_t level)
{
    return FINEST_M * (double)(1u << level);
}

/* The outermost cells contain everything beyond them. */
static int32_t axis_cell(float metres, double side)
{
    double cell = maths_clamp((double)metres / side, -AXIS_HALF, AXIS_HALF - 1);
    int32_t whole = (int32_t)cell; /* floor() is a function call on processors without SSE 4 */
    return (double)whole > cell ? whole - 1 : whole;
}

static uint64_t pack(uint32_t level, int32_t x, int32_t y, int32_t z)
{
    uint64_t cell = level;
    cell = cell << AXIS_BITS | (uint32_t)(x + AXIS_HALF);
    cell = cell << AXIS_BITS | (uint32_t)(y + AXIS_HALF);
    return cell << AXIS_BITS | (uint32_t)(z + AXIS_HALF);
}

/* A box of cells of one level; all bounds are inclusive. */
struct cells {
    int32_t x0, y0, z0, x1, y1, z1;
};

static struct cells cells_of(const struct path_box *box, uint32_t level)
{
    double side = side_of(level);
    return (struct cells){axis_cell(box->min_x, side), axis_cell(box->min_y, side),
                          axis_cell(box->min_z, side), axis_cell(box->max_x, side),
                          axis_cell(box->max_y, side), axis_cell(box->max_z, side)};
}

static double cell_count(const struct cells *cells)
{
    return (double)(cells->x1 - cells->x0 + 1) * (double)(cells->y1 - cells->y0 + 1) *
           (double)(cells->z1 - cells->z0 + 1);
}

/* --- levels ------------------------------------------------------------------------------------*/

/* Returns the first level whose cells are as wide as the body without its path. */
static uint32_t own_level(const struct space *space, uint32_t body)
{
    uint32_t what = space->bodies.what[body], level = 0;
    double reach = what & PAIR_FIXED
                       ? pair_filter_fixed_reach(space->input->world,
                                                 &space->input->world->fixed[what & ~PAIR_FIXED])
                       : pair_filter_row_reach(space->input, what);
    while (level < LEVELS - 1 && side_of(level) < 2.0 * reach)
        level++;
    return level;
}

/* Returns the least level at which half of all bodies fit into a cell. */
static uint32_t median_level(const struct space *space)
{
    uint32_t count[LEVELS] = {0}, below = 0, level = 0;
    for (uint32_t i = 0; i < space->bodies.count; i++)
        count[own_level(space, i)]++;
    for (below = count[0]; 2 * (uint64_t)below < space->bodies.count; below += count[level])
        level++;
    return level;
}

/* Gives every body its level, and returns the number of claims. */
static uint32_t choose_levels(struct space *space)
{
    uint32_t finest = median_level(space), claims = 0;
    for (uint32_t i = 0; i < space->bodies.count; i++) {
        uint32_t level = finest;
        struct cells cells = cells_of(&space->bodies.box[i], level);
        while (level < LEVELS - 1 && cell_count(&cells) > CLAIMS_MAX)
            cells = cells_of(&space->bodies.box[i], ++level);
        space->level[i] = (uint8_t)level;
        space->used[level] = true;
        claims += (uint32_t)cell_count(&cells);
    }
    return claims;
}

static void put_in_order(struct space *space)
{
    uint32_t start[LEVELS + 1] = {0};
    for (uint32_t i = 0; i < space->bodies.count; i++)
        start[LEVELS - space->level[i]]++;
    for (uint32_t n = 0; n < LEVELS; n++)
        start[n + 1] += start[n];
    for (uint32_t i = 0; i < space->bodies.count; i++)
        space->order[start[LEVELS - 1 - space->level[i]]++] = i;
}

/* --- claims ------------------------------------------------------------------------------------*/

/* Returns true for the first cell that two bodies share: a pair that shares several cells of a
 * level is added once. */
static bool first_shared(const struct space *space, uint32_t i, uint32_t j, uint64_t cell,
                         uint32_t level)
{
    const struct path_box *a = &space->bodies.box[i], *b = &space->bodies.box[j];
    double side = side_of(level);
    return cell == pack(level, axis_cell(a->min_x > b->min_x ? a->min_x : b->min_x, side),
                        axis_cell(a->min_y > b->min_y ? a->min_y : b->min_y, side),
                        axis_cell(a->min_z > b->min_z ? a->min_z : b->min_z, side));
}

/* Pairs the body with the bodies that hold the cell and, if the cell is of the body's level, claims
 * it. */
static void visit_cell(struct space *space, uint32_t body, uint64_t cell, uint32_t level,
                       struct pair_list *pairs)
{
    uint32_t *head = &space->head[random_mix(cell) & space->mask];
    for (uint32_t n = *head; n != NO_CLAIM; n = space->claim[n].next) {
        const struct claim *claim = &space->claim[n];
        if (claim->cell == cell && first_shared(space, body, claim->body, cell, level))
            method_meet(space->input, &space->bodies, body, claim->body, pairs);
    }
    if (level == space->level[body]) {
        space->claim[space->claims] = (struct claim){cell, body, *head};
        *head = space->claims++;
    }
}

static void visit_level(struct space *space, uint32_t body, uint32_t level, struct pair_list *pairs)
{
    struct cells cells = cells_of(&space->bodies.box[body], level);
    for (int32_t x = cells.x0; x <= cells.x1; x++) {
        for (int32_t y = cells.y0; y <= cells.y1; y++) {
            for (int32_t z = cells.z0; z <= cells.z1; z++)
                visit_cell(space, body, pack(level, x, y, z), level, pairs);
        }
    }
}

static void claim_all(struct space *space, struct pair_list *pairs)
{
    for (uint32_t n = 0; n < space->bodies.count; n++) {
        uint32_t body = space->order[n];
        work_done();
        for (uint32_t level = space->level[body]; level < LEVELS; level++) {
            if (space->used[level])
                visit_level(space, body, level, pairs);
        }
    }
}

void method_occupancy_pairs(const struct method_input *input, struct method_workspace *workspace,
                            struct pair_list *pairs)
{
    struct space space = {.input = input};
    method_bodies(input, workspace, &space.bodies);
    space.level = method_block(workspace, BLOCK_LEVEL, space.bodies.count, sizeof *space.level);
    space.order = method_block(workspace, BLOCK_ORDER, space.bodies.count, sizeof *space.order);
    uint32_t claims = choose_levels(&space);
    while (space.mask < claims)
        space.mask = 2 * space.mask + 1;
    space.claim = method_block(workspace, BLOCK_CLAIM, claims, sizeof *space.claim);
    space.head = method_block(workspace, BLOCK_HEAD, (size_t)space.mask + 1, sizeof *space.head);
    memset(space.head, 0xff, ((size_t)space.mask + 1) * sizeof *space.head);
    put_in_order(&space);
    claim_all(&space, pairs);
}
