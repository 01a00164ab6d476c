/* Functions shared by the methods of detection: boxes, and pairs that can never collide. */
#include "collider/motion/pair_filter.h"

#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define SLACK_M 0.01 /* in a world of up to 50 km */

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

void pair_list_append(struct pair_list *list, const struct pair_list *from)
{
    while (list->capacity - list->count < from->count)
        grow_list(list);
    if (from->count > 0)
        memcpy(list->pair + list->count, from->pair, from->count * sizeof *from->pair);
    list->count += from->count;
}

static double kind_reach(const struct world *world, const struct kind *kind)
{
    return world->params->collision.shape == SHAPE_MODEL ? kind->bound_m : kind->radius_m;
}

double pair_filter_row_reach(const struct method_input *input, uint32_t row)
{
    return kind_reach(input->world, &input->world->kinds[input->entities->row[row].kind]);
}

double pair_filter_slack(const struct world *world)
{
    return SLACK_M * maths_max(1.0, world->terrain.squares.world_m / WORLD_SIDE_DEFAULT_M);
}

double pair_filter_margin(const struct world *world, const struct kind *kind)
{
    bool models = world->params->collision.shape == SHAPE_MODEL;
    return (models ? kind->reach_m : kind->radius_m) + pair_filter_slack(world);
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
    const struct kind *kind = &input->world->kinds[input->entities->row[row].kind];
    return pair_filter_path_box(&input->path[row], pair_filter_margin(input->world, kind));
}

bool pair_filter_ground(const struct method_input *input, const struct path *path, double *toi)
{
    if (input->heights &&
        square_bounds_clear(input->heights, input->craters, path->at, path_at(path, 1.0)))
        return false;
    return analytic_impact_ground(&input->world->terrain, input->craters, path, toi);
}

/* Returns true if the path lowered by the threshold does not reach the ground. */
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
    const struct kind *kind = &input->world->kinds[input->entities->row[row].kind];
    return input->world->counts.fixed > 0 && !pair_filter_rests(path) &&
           !remote_is_munition(input->entities, row) &&
           !(kind->domain == DOMAIN_AIR && above_threshold(input, path));
}

bool pair_same_shooter(const struct entities *e, uint32_t a, uint32_t b)
{
    bool round_a = e->row[a].behaviour == BEHAVIOUR_FLIGHT,
         round_b = e->row[b].behaviour == BEHAVIOUR_FLIGHT;
    if (round_a && e->row[a].owner_slot == b && e->row[a].owner_id == e->row[b].id)
        return true;
    if (round_b && e->row[b].owner_slot == a && e->row[b].owner_id == e->row[a].id)
        return true;
    return round_a && round_b && e->row[a].owner_id != 0 &&
           e->row[a].owner_id == e->row[b].owner_id;
}

bool pair_never_meets(const struct entities *e, uint32_t a, uint32_t b)
{
    return pair_same_shooter(e, a, b) || (remote_is(e, a) && remote_is(e, b)) ||
           remote_is_munition(e, a) || remote_is_munition(e, b);
}

bool pair_excluded(const struct method_input *input, uint32_t a, uint32_t b)
{
    if (pair_never_meets(input->entities, a, b))
        return true;
    return pair_filter_rests(&input->path[a]) && pair_filter_rests(&input->path[b]);
}

/* A fixed object's extent: from its position to each side, down and up [m]. */
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

struct path_box pair_filter_fixed_box(const struct world *world, const struct fixed_object *object)
{
    struct extent e = extent_of(world, object);
    double slack = pair_filter_slack(world), reach = e.reach + slack, y = (double)object->y;
    return (struct path_box){
        (float)(object->x - reach), (float)(y + e.low - slack),  (float)(object->z - reach),
        (float)(object->x + reach), (float)(y + e.high + slack), (float)(object->z + reach),
    };
}
