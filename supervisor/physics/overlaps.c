/* Each pair of near bodies is tested again when one of the two has moved. */
#include "supervisor/physics/overlaps.h"

#include "supervisor/physics/hull_overlap.h"
#include "supervisor/physics/parting_distance.h"
#include "world/entity/entity.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

#define TOUCH_M    0.02 /* bodies nearer than this, and than a frame's way, may push each other */
#define ROUNDING_M 2e-5 /* a smaller overlap is none */

int overlaps_make(struct overlaps *overlaps, const struct world *world,
                  const struct hull_shape *shape)
{
    *overlaps = (struct overlaps){
        .world = world, .shape = shape, .spheres = world->params->collision.shape != SHAPE_MODEL};
    overlaps->ball = calloc(world->params->capacity, sizeof *overlaps->ball);
    overlaps->row = calloc(world->params->capacity, sizeof *overlaps->row);
    overlaps->listed = calloc(world->params->capacity, sizeof *overlaps->listed);
    if (overlaps->ball && overlaps->row && overlaps->listed &&
        wall_grid_make(&overlaps->walls, world) == 0)
        return 0;
    overlaps_free(overlaps);
    return -1;
}

void overlaps_free(struct overlaps *overlaps)
{
    for (int i = 0; i < 2; i++) {
        free(overlaps->pairs[i].item);
        free(overlaps->wall_pairs[i].item);
    }
    free(overlaps->ball);
    free(overlaps->row);
    free(overlaps->listed);
    neighbour_pairs_free(&overlaps->near);
    neighbour_pairs_free(&overlaps->touching);
    wall_grid_free(&overlaps->walls);
    *overlaps = (struct overlaps){0};
}

/* --- lists -------------------------------------------------------------------------------------*/

static int list_add(struct overlap_list *list, const struct overlap *overlap)
{
    if (list->count == list->capacity) {
        uint32_t capacity = 2 * list->capacity + 256;
        struct overlap *more = realloc(list->item, capacity * sizeof *more);
        if (!more)
            return -1;
        list->item = more;
        list->capacity = capacity;
    }
    list->item[list->count++] = *overlap;
    return 0;
}

static int by_key(const void *a, const void *b)
{
    const struct overlap *p = a, *q = b;
    return (p->key > q->key) - (p->key < q->key);
}

/* Returns the index of the first item whose key is not lower. */
static uint32_t list_from(const struct overlap_list *list, uint64_t key)
{
    uint32_t low = 0, high = list->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (list->item[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static const struct overlap *list_find(const struct overlap_list *list, uint64_t key)
{
    uint32_t at = list_from(list, key);
    return at < list->count && list->item[at].key == key ? &list->item[at] : NULL;
}

/* --- one pair ----------------------------------------------------------------------------------*/

/* A body or a wall in a pair. */
struct pair_side {
    const struct rigid_pose *pose;
    const struct kind *kind;
    double scale, radius_m;
    double turret, gun; /* [rad] */
};

/* Returns true if turret or gun are not where the model has them. */
static bool aims(const struct pair_side *side)
{
    return side->kind->part_count > 0 && (side->turret != 0.0 || side->gun != 0.0);
}

/* Finds the poses of body, turret and gun. */
static void find_parts(const struct pair_side *side, struct rigid_pose part[HULL_PART_COUNT])
{
    for (uint32_t i = 0; i < HULL_PART_COUNT; i++)
        part[i] = *side->pose;
    if (!aims(side))
        return;
    part[HULL_PART_TURRET] = rigid_pose_turned(side->pose, side->kind->turret_pivot, side->turret);
    part[HULL_PART_GUN] =
        rigid_pose_raised(&part[HULL_PART_TURRET], side->kind->gun_pivot, side->gun);
}

static uint32_t part_of(const struct overlaps *overlaps, uint32_t hull)
{
    return overlaps->world->hulls[hull].part;
}

/* Returns how far apart the pieces of both bodies are at least [m], enough when it is more; below 0
 * the greatest depth of two pieces. */
static double pieces_apart(const struct overlaps *overlaps, const struct pair_side *a,
                           const struct pair_side *b, double enough, struct vec3 *axis)
{
    struct rigid_pose part_a[HULL_PART_COUNT], part_b[HULL_PART_COUNT];
    struct relative_place places[HULL_PART_COUNT][HULL_PART_COUNT];
    double least = enough;
    const struct vec3 first = *axis;
    find_parts(a, part_a);
    find_parts(b, part_b);
    for (uint32_t i = 0; i < HULL_PART_COUNT; i++) {
        for (uint32_t j = 0; j < HULL_PART_COUNT; j++)
            places[i][j] = hull_overlap_place(&part_a[i], &part_b[j], b->scale);
    }
    for (uint32_t i = a->kind->first_hull; i < a->kind->first_hull + a->kind->hull_count; i++) {
        const struct hull_shape *p = &overlaps->shape[i];
        for (uint32_t j = b->kind->first_hull; j < b->kind->first_hull + b->kind->hull_count; j++) {
            const struct hull_shape *q = &overlaps->shape[j];
            const struct relative_place *place =
                &places[part_of(overlaps, i)][part_of(overlaps, j)];
            struct vec3 tried = first;
            if (hull_overlap_far(p, q, place, enough, &tried))
                continue;
            double apart = hull_overlap_find(p, q, place, enough, &tried);
            if (apart < least) {
                least = apart;
                *axis = tried;
            }
        }
    }
    return least;
}

static struct parting_pieces pieces_of(const struct overlaps *overlaps,
                                       const struct pair_side *side, struct rigid_pose *pose)
{
    struct rigid_pose part[HULL_PART_COUNT];
    const struct kind *kind = side->kind;
    find_parts(side, part);
    for (uint32_t i = 0; i < kind->hull_count; i++)
        pose[i] = part[part_of(overlaps, kind->first_hull + i)];
    return (struct parting_pieces){&overlaps->shape[kind->first_hull], pose, kind->hull_count,
                                   side->scale};
}

static double parting_distance(const struct overlaps *overlaps, const struct pair_side sides[2])
{
    struct rigid_pose pose_a[HULLS_A_MODEL], pose_b[HULLS_A_MODEL];
    const struct parting_pieces a = pieces_of(overlaps, &sides[0], pose_a);
    const struct parting_pieces b = pieces_of(overlaps, &sides[1], pose_b);
    return parting_distance_find(&a, &b);
}

static double bodies_apart(const struct overlaps *overlaps, const struct pair_side *a,
                           const struct pair_side *b, double enough, struct vec3 *axis)
{
    struct vec3 between = vec3_sub(b->pose->at, a->pose->at);
    double distance = vec3_length(between);
    if (overlaps->spheres)
        return distance - a->radius_m - b->radius_m;
    if (distance > a->kind->reach_m + b->kind->reach_m * b->scale + enough)
        return enough;
    const struct relative_place place = hull_overlap_place(a->pose, b->pose, b->scale);
    const struct hull_shape *outer = &overlaps->shape[a->kind->outer_hull];
    const struct hull_shape *other = &overlaps->shape[b->kind->outer_hull];
    if (!aims(a) && !aims(b) && hull_overlap_far(outer, other, &place, enough, axis))
        return enough;
    return pieces_apart(overlaps, a, b, enough, axis);
}

/* --- a frame -----------------------------------------------------------------------------------*/

/* Bodies that could push each other in this frame are so near [m]. */
static double touch_reach(const struct body_look *a, const struct vec3 other_mps, double dt_s)
{
    return TOUCH_M + dt_s * vec3_length(vec3_sub(a->now.velocity, other_mps));
}

/* What a frame's look works with. */
struct look {
    struct overlaps *overlaps;
    struct measures *measures;
    struct body_looks *looks;
    const uint8_t *fixed_damage;
    double dt_s;
    uint32_t overlapping;
};

/* Measures a pair. last: what was known of it, or NULL. fresh: one of the two is new. */
static void measure_pair(struct look *look, struct overlap *pair, const struct overlap *last,
                         bool fresh, const struct measured_body *a, const struct measured_body *b)
{
    bool overlaps = pair->depth_m > ROUNDING_M;
    pair->since_start = overlaps && (last ? last->since_start : fresh);
    look->overlapping += overlaps;
    enum measure_kind kind = b->fixed ? MEASURE_OF_WALL_OVERLAP : MEASURE_OF_OVERLAP;
    measure_take(look->measures, pair->since_start ? MEASURE_OF_START_OVERLAP : kind, pair->depth_m,
                 a, b);
}

/* Returns true if the body has to part from others than the one of this pair: they may push it. */
static bool parts_from_others(const struct body_look *body, const struct overlap *last)
{
    return body->parted > (last && last->since_start ? 1u : 0u);
}

/* Bodies that began in each other get deeper only if their way out gets longer, too. before: the
 * pair's sides at the end of the last frame. */
static void measure_growth(struct look *look, const struct overlap *pair,
                           const struct overlap *last, const struct pair_side before[2],
                           const struct pair_side now[2], const struct measured_body *a,
                           const struct measured_body *b)
{
    const struct overlaps *overlaps = look->overlaps;
    double growth = maths_max(0.0, pair->depth_m - (last ? last->depth_m : 0.0));
    if (growth > ROUNDING_M && pair->since_start && !overlaps->spheres)
        growth = maths_clamp(parting_distance(overlaps, now) - parting_distance(overlaps, before),
                             0.0, growth);
    measure_take(look->measures, MEASURE_OF_OVERLAP_GROWTH, growth, a, b);
}

static struct pair_side side_of(const struct body_look *body)
{
    return (struct pair_side){&body->now.pose,      body->kind,       1.0,
                              body->kind->radius_m, body->now.turret, body->now.gun};
}

/* The same at the end of the last frame. */
static struct pair_side side_before(const struct body_look *body)
{
    struct pair_side side = side_of(body);
    side.pose = &body->was->pose;
    side.turret = body->was->turret;
    side.gun = body->was->gun;
    return side;
}

static uint64_t key_of(uint32_t first, uint32_t second)
{
    return (uint64_t)first << 32 | second;
}

/* Looks at two bodies, of which a has the lower id. One of another simulator may be anywhere, so
 * the other one parts from it as from a body that was placed there. */
static int look_at_pair(struct look *look, struct body_look *a, struct body_look *b)
{
    struct overlaps *overlaps = look->overlaps;
    bool foreign = a->foreign || b->foreign;
    const struct overlap_list *before = &overlaps->pairs[!overlaps->current];
    struct overlap pair = {.key = key_of(a->named.id, b->named.id)};
    const struct overlap *last = list_find(before, pair.key);
    if (last && a->still && b->still) {
        pair = *last;
        a->parts += pair.since_start;
        b->parts += pair.since_start;
        look->overlapping += !foreign && pair.depth_m > ROUNDING_M;
    } else {
        const struct pair_side sides[2] = {side_of(a), side_of(b)};
        double enough = touch_reach(a, b->now.velocity, look->dt_s);
        if (last)
            pair.axis = last->axis;
        double apart = bodies_apart(overlaps, &sides[0], &sides[1], enough, &pair.axis);
        pair.depth_m = maths_max(0.0, -apart);
        pair.touch = apart < enough;
        if (foreign)
            pair.since_start = pair.depth_m > ROUNDING_M;
        else
            measure_pair(look, &pair, last, !a->known || !b->known, &a->named, &b->named);
        if (!foreign && a->known && b->known && !parts_from_others(a, last) &&
            !parts_from_others(b, last)) {
            const struct pair_side earlier[2] = {side_before(a), side_before(b)};
            measure_growth(look, &pair, last, earlier, sides, &a->named, &b->named);
        }
        a->parts += pair.since_start;
        b->parts += pair.since_start;
    }
    if (pair.touch)
        a->touches = b->touches = true;
    if (pair.touch || (last && last->touch)) { /* or did when the frame began */
        if (neighbour_pairs_add(&overlaps->touching, (uint32_t)(a - look->looks->body),
                                (uint32_t)(b - look->looks->body)) != 0)
            return -1;
    }
    return list_add(&overlaps->pairs[overlaps->current], &pair);
}

static int look_at_wall(struct look *look, struct body_look *body, uint32_t index)
{
    struct overlaps *overlaps = look->overlaps;
    const struct fixed_object *object = &overlaps->world->fixed[index];
    const struct kind *kind = &overlaps->world->kinds[object->kind];
    const struct vec3 at = {object->x, (double)object->y, object->z};
    const struct rigid_pose pose =
        rigid_pose_of(at, (double)object->turn * (TWO_PI / 65536.0), 0.0, 0.0);
    const struct measured_body named = {index + 1, true, object->kind, at};
    const struct pair_side sides[2] = {side_of(body),
                                       {&pose, kind, (double)object->radius_m / kind->radius_m,
                                        (double)object->radius_m, 0.0, 0.0}};
    struct overlap pair = {.key = key_of(body->named.id, index)};
    const struct overlap *last = list_find(&overlaps->wall_pairs[!overlaps->current], pair.key);
    double enough = touch_reach(body, (struct vec3){0.0, 0.0, 0.0}, look->dt_s);
    if (last)
        pair.axis = last->axis;
    double apart = bodies_apart(overlaps, &sides[0], &sides[1], enough, &pair.axis);
    pair.depth_m = maths_max(0.0, -apart);
    pair.touch = apart < enough;
    body->touches |= pair.touch;
    measure_pair(look, &pair, last, !body->known, &body->named, &named);
    if (body->known && !parts_from_others(body, last)) {
        const struct pair_side earlier[2] = {side_before(body), sides[1]};
        measure_growth(look, &pair, last, earlier, sides, &body->named, &named);
    }
    body->parts += pair.since_start;
    return list_add(&overlaps->wall_pairs[overlaps->current], &pair);
}

/* Keeps the walls of a body that has not moved. */
static int keep_walls(struct look *look, struct body_look *body)
{
    struct overlaps *overlaps = look->overlaps;
    const struct overlap_list *before = &overlaps->wall_pairs[!overlaps->current];
    uint32_t i = list_from(before, key_of(body->named.id, 0));
    for (; i < before->count && before->item[i].key >> 32 == body->named.id; i++) {
        const struct overlap *last = &before->item[i];
        if (look->fixed_damage[(uint32_t)last->key] >= DAMAGE_HIGH)
            continue;
        look->overlapping += last->depth_m > ROUNDING_M;
        body->touches |= last->touch;
        body->parts += last->since_start;
        if (list_add(&overlaps->wall_pairs[overlaps->current], last) != 0)
            return -1;
    }
    return 0;
}

static int look_at_walls(struct look *look, struct body_look *body,
                         const struct neighbour_ball *ball)
{
    struct overlaps *overlaps = look->overlaps;
    if (body->still)
        return keep_walls(look, body);
    overlaps->near.count = 0;
    if (wall_grid_find(&overlaps->walls, overlaps->world, ball, &overlaps->near) != 0)
        return -1;
    for (uint32_t i = 0; i < overlaps->near.count; i++) {
        uint32_t index = overlaps->near.pair[i].b;
        if (look->fixed_damage[index] < DAMAGE_HIGH && look_at_wall(look, body, index) != 0)
            return -1;
    }
    return 0;
}

static void put_ball(const struct look *look, uint32_t index)
{
    const struct body_look *body = &look->looks->body[index];
    struct overlaps *overlaps = look->overlaps;
    double reach = maths_max(body->kind->reach_m, body->kind->radius_m) + 0.5 * TOUCH_M +
                   look->dt_s * vec3_length(body->now.velocity);
    if (!body->finite || overlaps->listed[body->row])
        return;
    overlaps->listed[body->row] = true;
    overlaps->ball[overlaps->balls++] = (struct neighbour_ball){body->named.at, reach, index};
}

/* Puts the balls of the frame into the order of the last frame, and new ones behind them. */
static void put_balls(const struct look *look)
{
    struct overlaps *overlaps = look->overlaps;
    const struct body_looks *looks = look->looks;
    uint32_t before = overlaps->balls;
    overlaps->balls = 0;
    memset(overlaps->listed, 0, looks->rows * sizeof *overlaps->listed);
    for (uint32_t i = 0; i < before; i++) {
        uint32_t row = overlaps->row[i];
        if (row < looks->rows && looks->of_row[row] != NO_LOOK)
            put_ball(look, looks->of_row[row]);
    }
    for (uint32_t i = 0; i < looks->count; i++)
        put_ball(look, i);
}

static void keep_order(struct overlaps *overlaps, const struct body_looks *looks)
{
    for (uint32_t i = 0; i < overlaps->balls; i++)
        overlaps->row[i] = looks->body[overlaps->ball[i].body].row;
}

static int look_at_all(struct look *look)
{
    struct overlaps *overlaps = look->overlaps;
    struct body_look *body = look->looks->body;
    put_balls(look);
    for (uint32_t i = 0; i < overlaps->balls && overlaps->walls.side > 0; i++) {
        struct body_look *looked = &body[overlaps->ball[i].body];
        if (!looked->foreign && look_at_walls(look, looked, &overlaps->ball[i]) != 0)
            return -1;
    }
    if (neighbour_pairs_find(&overlaps->near, overlaps->ball, overlaps->balls) != 0)
        return -1;
    keep_order(overlaps, look->looks);
    for (uint32_t i = 0; i < overlaps->near.count; i++) {
        struct body_look *a = &body[overlaps->near.pair[i].a];
        struct body_look *b = &body[overlaps->near.pair[i].b];
        bool lower = a->named.id < b->named.id;
        if (a->foreign && b->foreign)
            continue;
        if (look_at_pair(look, lower ? a : b, lower ? b : a) != 0)
            return -1;
    }
    return 0;
}

int overlaps_look(struct overlaps *overlaps, struct measures *measures, struct body_looks *looks,
                  const uint8_t *fixed_damage, double dt_s)
{
    struct look look = {.overlaps = overlaps,
                        .measures = measures,
                        .looks = looks,
                        .fixed_damage = fixed_damage,
                        .dt_s = dt_s};
    overlaps->current = !overlaps->current;
    struct overlap_list *pairs = &overlaps->pairs[overlaps->current];
    struct overlap_list *walls = &overlaps->wall_pairs[overlaps->current];
    pairs->count = walls->count = overlaps->touching.count = 0;
    if (look_at_all(&look) != 0)
        return -1;
    if (pairs->count > 0)
        qsort(pairs->item, pairs->count, sizeof *pairs->item, by_key);
    if (walls->count > 0)
        qsort(walls->item, walls->count, sizeof *walls->item, by_key);
    measure_take(measures, MEASURE_OF_OVERLAPPING, look.overlapping, NULL, NULL);
    return 0;
}
