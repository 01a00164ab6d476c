/* The registry of methods, and what their files share. */
#include "collider/method/method.h"

#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

const struct method_functions *method_of(enum method method)
{
#define X(name, value, word, test, text) [METHOD_##name] = {method_##word##_pairs, test},
    static const struct method_functions functions[] = {METHODS(X)};
#undef X
    _Static_assert(sizeof functions / sizeof functions[0] == METHOD_COUNT, "a row each");
    return &functions[method];
}

bool method_discrete(enum method method)
{
    return method_of(method)->test == METHOD_TESTS_END;
}

struct method_workspace {
    const struct broad_phase *broad;
    void *block[METHOD_BLOCKS];
    size_t bytes[METHOD_BLOCKS];
};

struct method_workspace *method_workspace_create(const struct world *world,
                                                 const struct broad_phase *broad)
{
    struct method_workspace *workspace = calloc(1, sizeof *workspace);
    uint64_t bodies = (uint64_t)world->params->capacity + world->counts.fixed;
    if (!workspace)
        return NULL;
    workspace->broad = broad;
    for (int i = 0; i < METHOD_BLOCKS; i++) {
        workspace->bytes[i] = (size_t)bodies * METHOD_BODY_BYTES + world->terrain.squares.count;
        workspace->block[i] = reserve_take(workspace->bytes[i], 1);
        if (!workspace->block[i]) {
            method_workspace_free(workspace);
            errno = ENOMEM;
            return NULL;
        }
    }
    return workspace;
}

const struct broad_phase *method_broad_phase(const struct method_workspace *workspace)
{
    return workspace->broad;
}

void *method_block(struct method_workspace *workspace, uint32_t block, size_t count, size_t size)
{
    if (count > workspace->bytes[block] / size) {
        workspace->bytes[block] = 2 * count * size;
        workspace->block[block] =
            reserve_grow(workspace->block[block], 0, workspace->bytes[block], 1);
    }
    return workspace->block[block];
}

void method_workspace_free(struct method_workspace *workspace)
{
    for (int i = 0; workspace && i < METHOD_BLOCKS; i++)
        reserve_free(workspace->block[i]);
    free(workspace);
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Returns true if the box touches a marked square. With mark it marks all of the box's squares
 * instead. */
static bool squares_marked(const struct gridsquares *division, uint8_t *marked,
                           const struct path_box *box, bool mark)
{
    struct gridsquare_box squares = gridsquare_box_of(
        division, (double)box->min_x, (double)box->min_z, (double)box->max_x, (double)box->max_z);
    for (int32_t row = squares.z0; row <= squares.z1; row++) {
        for (int32_t column = squares.x0; column <= squares.x1; column++) {
            uint32_t square = gridsquare_index(division, column, row);
            if (mark)
                marked[square] = 1;
            else if (marked[square])
                return true;
        }
    }
    return false;
}

void method_bodies(const struct method_input *input, struct method_workspace *workspace,
                   struct method_bodies *bodies)
{
    const struct world *world = input->world;
    const struct gridsquares *division = &world->terrain.squares;
    size_t most = (size_t)input->rows + world->counts.fixed;
    uint32_t *what = method_block(workspace, METHOD_BODIES, most, sizeof *what);
    struct path_box *box = method_block(workspace, METHOD_BODIES + 1, most, sizeof *box);
    uint8_t *tests_fixed = method_block(workspace, METHOD_BODIES + 2, input->rows, 1);
    uint8_t *marked = method_block(workspace, METHOD_BODIES + 3, division->count, 1);
    uint32_t count = 0, moving;
    memset(marked, 0, division->count);
    for (uint32_t row = 0; row < input->rows; row++) {
        if (!pair_filter_there(input, row))
            continue;
        what[count] = row;
        box[count] = pair_filter_box(input, row);
        tests_fixed[count] = pair_filter_tests_fixed(input, row);
        if (tests_fixed[count])
            squares_marked(division, marked, &box[count], true);
        count++;
    }
    moving = count;
    for (uint32_t object = 0; object < world->counts.fixed; object++) {
        box[count] = pair_filter_fixed_box(world, &world->fixed[object]);
        if (pair_filter_stands(input, object) &&
            squares_marked(division, marked, &box[count], false))
            what[count++] = object | PAIR_FIXED;
    }
    *bodies = (struct method_bodies){count, moving, what, box, tests_fixed};
}

void method_meet(const struct method_input *input, const struct method_bodies *bodies, uint32_t i,
                 uint32_t j, struct pair_list *pairs)
{
    uint32_t first = i < j ? i : j, second = i < j ? j : i;
    uint32_t a = bodies->what[first], b = bodies->what[second];
    bool meet = false;
    if (second < bodies->moving)
        meet = pair_filter_boxes_meet(&bodies->box[first], &bodies->box[second]) &&
               !pair_excluded(input, a, b);
    else if (first < bodies->moving)
        meet = bodies->tests_fixed[first] &&
               pair_filter_box_meets_fixed(input, &bodies->box[first],
                                           &input->world->fixed[b & ~PAIR_FIXED]);
    if (meet)
        pair_list_add(pairs, a, b);
}
