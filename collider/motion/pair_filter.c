/* What the methods of detection share: boxes, and who can never collide. */
#include "collider/motion/pair_filter.h"

#include "ipc/process/log.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

uint32_t pair_filter_pairs_first(const struct world *world)
{
    uint64_t rows = world->params->capacity, first = PAIRS_FIRST + PAIRS_A_ROW * rows;
    uint64_t most = rows * (rows - 1) / 2 + rows * world->counts.fixed;
    return (uint32_t)(most < first ? most : first);
}

int pair_list_init(struct pair_list *list, uint64_t count)
{
    *list = (struct pair_list){.capacity = count < PAIRS_MAX ? (uint32_t)count : PAIRS_MAX};
    list->pair = reserve_take(list->capacity, sizeof *list->pair);
    return list->pair ? 0 : -1;
}

void pair_list_free(struct pair_list *list)
{
    reserve_free(list->pair);
    *list = (struct pair_list){0};
}

static void grow_list(struct pair_list *list)
{
    CHECK(list->count < PAIRS_MAX);
    uint32_t more = 2 * list->capacity + 1;
    list->pair = reserve_grow(list->pair, list->count, more, sizeof *list->pair);
    list->capacity = more;
}

void pair_list_add(struct pair_list *list, uint32_t a, uint32_t b)
{
    if (list->count == list->capacity)
        grow_list(list);
    list->pair[list->count++] = (struct pair){a, b};
}

static double kind_reach(const struct world *world, const struct kind *kind)
{
    return world->params->collision.shape == SHAPE_MODEL ? kind->bound_m : kind->radius_m;
}

double pair_filter_row_reach(const struct method_input *input, uint32_t row)
{
    return kind_reach(input->world, &input->world->kinds[input->entities->kind[row]]);
}

double pair_filter_grow(const struct world *world, const struct kind *kind)
{
    return kind_reach(world, kind) + BOX_SLACK_M;
}

double pair_filter_fixed_reach(const struct world *world, const struct fixed_object *object)
{
    const struct kind *kind = &world->kinds[object->kind];
    if (world->params->collision.shape != SHAPE_MODEL)
        return (double)object->radius_m;
    return kind->level_m * fixed_scale(object, kind);
}

struct path_box pair_filter_box(const struct method_input *input, uint32_t row)
{
    const struct kind *kind = &input->world->kinds[input->entities->kind[row]];
    return pair_filter_way_box(&input->path[row], pair_filter_grow(input->world, kind));
}

bool pair_filter_ground(const struct method_input *input, const struct path *path, double *toi)
{
    if (input->heights &&
        square_bounds_clear(input->heights, input->craters, path->at, path_at(path, 1.0)))
        return false;
    return analytic_impact_ground(&input->world->terrain, input->craters, path, toi);
}

/* The way, lowered by the threshold, does not reach the ground. */
static bool above_threshold(const struct method_input *input, const struct path *path)
{
    struct path lowered = *path;
    double toi;
    lowered.at.y -= input->world->params->collision.threshold_height_m;
    return !pair_filter_ground(input, &lowered, &toi);
}

bool pair_filter_tests_fixed(const struct method_input *input, uint32_t row)
{
    const struct path *path = &input->path[row];
    const struct kind *kind = &input->world->kinds[input->entities->kind[row]];
    return input->world->counts.fixed > 0 && !pair_filter_rests(path) &&
           !(kind->domain == DOMAIN_AIR && above_threshold(input, path));
}

bool pair_same_shooter(const struct entities *e, uint32_t a, uint32_t b)
{
    bool round_a = e->behaviour[a] == BEHAVIOUR_FLIGHT,
         round_b = e->behaviour[b] == BEHAVIOUR_FLIGHT;
    if (round_a && e->owner_slot[a] == b && e->owner_id[a] == e->id[b])
        return true;
    if (round_b && e->owner_slot[b] == a && e->owner_id[b] == e->id[a])
        return true;
    return round_a && round_b && e->owner_id[a] != 0 && e->owner_id[a] == e->owner_id[b];
}

bool pair_excluded(const struct method_input *input, uint32_t a, uint32_t b)
{
    if (pair_same_shooter(input->entities, a, b))
        return true;
    return pair_filter_rests(&input->path[a]) && pair_filter_rests(&input->path[b]);
}

/* A fixed object's extent: from its position to each side, and from its foot down and up [m]. */
struct extent {
    double reach, low, high;
};

static struct extent extent_of(const struct world *world, const struct fixed_object *object)
{
    double reach = pair_filter_fixed_reach(world, object);
    if (world->params->collision.shape != SHAPE_MODEL)
        return (struct extent){reach, -reach, reach};
    const struct kind *kind = &world->kinds[object->kind];
    double scale = fixed_scale(object, kind);
    return (struct extent){reach, kind->low_m * scale, kind->high_m * scale};
}

bool pair_filter_box_meets_fixed(const struct method_input *input, const struct path_box *box,
                                 const struct fixed_object *object)
{
    struct extent e = extent_of(input->world, object);
    double y = (double)object->y;
    return (double)box->min_x <= object->x + e.reach && object->x - e.reach <= (double)box->max_x &&
           (double)box->min_z <= object->z + e.reach && object->z - e.reach <= (double)box->max_z &&
           (double)box->min_y <= y + e.high && y + e.low <= (double)box->max_y;
}

/* --- the methods -------------------------------------------------------------------------------*/

method_pairs_function *method_of(enum method method)
{
    static method_pairs_function *const methods[METHOD_COUNT] = {
        [METHOD_NPSNET2] = method_npsnet2_pairs,     [METHOD_MPS] = method_mps_pairs,
        [METHOD_OCCUPANCY] = method_occupancy_pairs, [METHOD_HOPCROFT] = method_hopcroft_pairs,
        [METHOD_BRUTE] = method_brute_pairs,
    };
    return methods[method];
}

struct method_workspace {
    void *block[PAIR_FILTER_BLOCKS];
    size_t bytes[PAIR_FILTER_BLOCKS];
};

struct method_workspace *method_workspace_create(const struct world *world)
{
    struct method_workspace *workspace = calloc(1, sizeof *workspace);
    uint64_t bodies = (uint64_t)world->params->capacity + world->counts.fixed;
    if (!workspace)
        return NULL;
    for (int i = 0; i < PAIR_FILTER_BLOCKS; i++) {
        workspace->bytes[i] = (size_t)bodies * PAIR_FILTER_BODY_BYTES + GRIDSQUARE_COUNT;
        workspace->block[i] = reserve_take(workspace->bytes[i], 1);
        if (!workspace->block[i]) {
            method_workspace_free(workspace);
            errno = ENOMEM;
            return NULL;
        }
    }
    return workspace;
}

void *pair_filter_block(struct method_workspace *workspace, uint32_t block, size_t count,
                        size_t size)
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
    for (int i = 0; workspace && i < PAIR_FILTER_BLOCKS; i++)
        reserve_free(workspace->block[i]);
    free(workspace);
}

/* --- bodies ------------------------------------------------------------------------------------*/

static struct path_box box_of_fixed(const struct world *world, const struct fixed_object *object)
{
    struct extent e = extent_of(world, object);
    double reach = e.reach + BOX_SLACK_M, y = (double)object->y;
    return (struct path_box){
        (float)(object->x - reach), (float)(y + e.low - BOX_SLACK_M),  (float)(object->z - reach),
        (float)(object->x + reach), (float)(y + e.high + BOX_SLACK_M), (float)(object->z + reach),
    };
}

/* Does the box touch a marked square? mark: marks them all. */
static bool squares_marked(uint8_t *marked, const struct path_box *box, bool mark)
{
    struct gridsquare_box squares = gridsquare_box_of((double)box->min_x, (double)box->min_z,
                                                      (double)box->max_x, (double)box->max_z);
    for (int32_t row = squares.z0; row <= squares.z1; row++) {
        for (int32_t column = squares.x0; column <= squares.x1; column++) {
            uint32_t square = gridsquare_index(column, row);
            if (mark)
                marked[square] = 1;
            else if (marked[square])
                return true;
        }
    }
    return false;
}

void pair_filter_bodies(const struct method_input *input, struct method_workspace *workspace,
                        struct pair_filter_bodies *bodies)
{
    const struct world *world = input->world;
    size_t most = (size_t)input->rows + world->counts.fixed;
    uint32_t *what = pair_filter_block(workspace, PAIR_FILTER_BODIES, most, sizeof *what);
    struct path_box *box = pair_filter_block(workspace, PAIR_FILTER_BODIES + 1, most, sizeof *box);
    uint8_t *tests_fixed = pair_filter_block(workspace, PAIR_FILTER_BODIES + 2, input->rows, 1);
    uint8_t *marked = pair_filter_block(workspace, PAIR_FILTER_BODIES + 3, GRIDSQUARE_COUNT, 1);
    uint32_t count = 0, moving;
    memset(marked, 0, GRIDSQUARE_COUNT);
    for (uint32_t row = 0; row < input->rows; row++) {
        if (!pair_filter_there(input, row))
            continue;
        what[count] = row;
        box[count] = pair_filter_box(input, row);
        tests_fixed[count] = pair_filter_tests_fixed(input, row);
        if (tests_fixed[count])
            squares_marked(marked, &box[count], true);
        count++;
    }
    moving = count;
    for (uint32_t object = 0; object < world->counts.fixed; object++) {
        box[count] = box_of_fixed(world, &world->fixed[object]);
        if (pair_filter_stands(input, object) && squares_marked(marked, &box[count], false))
            what[count++] = object | PAIR_FIXED;
    }
    *bodies = (struct pair_filter_bodies){count, moving, what, box, tests_fixed};
}

void pair_filter_meet(const struct method_input *input, const struct pair_filter_bodies *bodies,
                      uint32_t i, uint32_t j, struct pair_list *pairs)
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
