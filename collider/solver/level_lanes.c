/* Each body's motion is one vector. Those of four bodies become lanes, and vectors again. */
#include "collider/solver/level_lanes.h"

#include "collider/solver/level_solver.h"
#include "world/maths/cpu_dispatch.h"
#include "world/maths/maths.h"
#include "world/runtime/reserve.h"

#include <errno.h>
#include <string.h>

int level_lanes_init(struct level_lanes *lanes, uint64_t bodies, uint64_t points)
{
    *lanes = (struct level_lanes){.body_capacity = bodies, .point_capacity = points};
    lanes->motion = reserve_take(bodies + 4, sizeof *lanes->motion);
    lanes->held = reserve_take(bodies / 4 + 1, sizeof *lanes->held);
    lanes->depth = reserve_take(bodies, sizeof *lanes->depth);
    lanes->four = reserve_take(points, sizeof *lanes->four);
    lanes->place = reserve_take(points, sizeof *lanes->place);
    lanes->next = reserve_take(points, sizeof *lanes->next);
    if (lanes->motion && lanes->held && lanes->depth && lanes->four && lanes->place && lanes->next)
        return 0;
    level_lanes_free(lanes);
    errno = ENOMEM;
    return -1;
}

void level_lanes_free(struct level_lanes *lanes)
{
    reserve_free(lanes->motion);
    reserve_free(lanes->held);
    reserve_free(lanes->depth);
    reserve_free(lanes->four);
    reserve_free(lanes->place);
    reserve_free(lanes->next);
    *lanes = (struct level_lanes){0};
}

/* Makes room for the frame's bodies and points. What the arrays held is lost. */
static void make_room(struct level_lanes *lanes, uint32_t bodies, uint32_t points)
{
    if (bodies > lanes->body_capacity) {
        uint64_t more = lanes->body_capacity = 2 * (uint64_t)bodies;
        lanes->motion = reserve_grow(lanes->motion, 0, more + 4, sizeof *lanes->motion);
        lanes->held = reserve_grow(lanes->held, 0, more / 4 + 1, sizeof *lanes->held);
        lanes->depth = reserve_grow(lanes->depth, 0, more, sizeof *lanes->depth);
    }
    if (points > lanes->point_capacity) {
        uint64_t more = lanes->point_capacity = 2 * (uint64_t)points;
        lanes->four = reserve_grow(lanes->four, 0, more, sizeof *lanes->four);
        lanes->place = reserve_grow(lanes->place, 0, more, sizeof *lanes->place);
        lanes->next = reserve_grow(lanes->next, 0, more, sizeof *lanes->next);
    }
}

/* --- places ------------------------------------------------------------------------------------*/

/* Finds how many points have to be swept before each one, because they share bodies, and counts the
 * points of each depth. Returns how many depths there are. */
static uint32_t find_depths(struct level_lanes *lanes, const struct level_contact *contact,
                            uint32_t contacts)
{
    uint32_t *depth = lanes->depth, depths = 0;
    memset(depth, 0, lanes->bodies * sizeof *depth);
    for (uint32_t i = 0; i < contacts; i++) {
        uint32_t a = contact[i].a, b = contact[i].b;
        uint32_t own = depth[a] > depth[b] ? depth[a] : depth[b];
        depth[a] = depth[b] = own + 1;
        lanes->place[i] = own;
        if (own == depths)
            lanes->next[depths++] = 0;
        lanes->next[own]++;
    }
    return depths;
}

/* Gives each depth its fours, of which the last one may have lanes without a point. */
static void find_fours(struct level_lanes *lanes, uint32_t depths)
{
    lanes->fours = 0;
    for (uint32_t d = 0; d < depths; d++) {
        uint32_t points = lanes->next[d];
        lanes->next[d] = 4 * lanes->fours;
        lanes->fours += (points + 3) / 4;
        if (points % 4 != 0) {
            struct level_four *last = &lanes->four[lanes->fours - 1];
            *last = (struct level_four){.normal_x = {0.0}};
            for (uint32_t lane = 0; lane < 4; lane++)
                last->a[lane] = last->b[lane] = lanes->bodies;
        }
    }
}

void level_lanes_arrange(struct level_lanes *lanes, uint32_t bodies,
                         const struct level_contact *contact, uint32_t contacts)
{
    make_room(lanes, bodies, contacts);
    lanes->bodies = bodies;
    find_fours(lanes, find_depths(lanes, contact, contacts));
    for (uint32_t i = 0; i < contacts; i++)
        lanes->place[i] = lanes->next[lanes->place[i]]++;
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* The motions of four bodies: the first or the second ones of four points, or four in turn. */
struct lane_bodies {
    f64x4 x, z, spin, inverse_mass;
};

/* Makes columns of rows, and the other way round. */
static void turn(const f64x4 in[4], f64x4 out[4])
{
    f64x4 even = __builtin_shufflevector(in[0], in[1], 0, 4, 2, 6);
    f64x4 odd = __builtin_shufflevector(in[0], in[1], 1, 5, 3, 7);
    f64x4 even_too = __builtin_shufflevector(in[2], in[3], 0, 4, 2, 6);
    f64x4 odd_too = __builtin_shufflevector(in[2], in[3], 1, 5, 3, 7);
    out[0] = __builtin_shufflevector(even, even_too, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(odd, odd_too, 0, 1, 4, 5);
    out[2] = __builtin_shufflevector(even, even_too, 2, 3, 6, 7);
    out[3] = __builtin_shufflevector(odd, odd_too, 2, 3, 6, 7);
}

static void take(const f64x4 *motion, const uint32_t body[4], struct lane_bodies *bodies)
{
    const f64x4 in[4] = {motion[body[0]], motion[body[1]], motion[body[2]], motion[body[3]]};
    f64x4 out[4];
    turn(in, out);
    *bodies = (struct lane_bodies){out[0], out[1], out[2], out[3]};
}

static void put(f64x4 *motion, const uint32_t body[4], const struct lane_bodies *bodies)
{
    const f64x4 in[4] = {bodies->x, bodies->z, bodies->spin, bodies->inverse_mass};
    f64x4 out[4];
    turn(in, out);
    for (uint32_t lane = 0; lane < 4; lane++)
        motion[body[lane]] = out[lane];
}

/* Takes what an impulse changes from a speed, in the lanes of the mask. To take 0 from a speed
 * changes no bit of it. */
#define TAKE(speed, mask, change) ((speed) -= (f64x4)((mask) & (four_masks)(change)))

/* Gives the second bodies impulses [N s] along x and z with these levers, and the first ones the
 * opposite, in the lanes of the mask. */
#define PUSH(four, first, second, mask, ns, along_x, along_z, lever_a, lever_b)                    \
    do {                                                                                           \
        f64x4 push_x = (along_x), push_z = (along_z);                                              \
        f64x4 loss = SIMD_NEGATIVE((second)->inverse_mass);                                        \
        TAKE((first)->x, mask, push_x *(first)->inverse_mass);                                     \
        TAKE((first)->z, mask, push_z *(first)->inverse_mass);                                     \
        TAKE((first)->spin, mask, (ns) * (lever_a) * (four)->inverse_moment_a);                    \
        TAKE((second)->x, mask, push_x *loss);                                                     \
        TAKE((second)->z, mask, push_z *loss);                                                     \
        TAKE((second)->spin, mask, (ns) * (lever_b)*SIMD_NEGATIVE((four)->inverse_moment_b));      \
    } while (0)

#define PUSH_NORMAL(four, first, second, mask, ns)                                                 \
    PUSH(four, first, second, mask, ns, (ns) * (four)->normal_x, (ns) * (four)->normal_z,          \
         (four)->normal_lever_a, (four)->normal_lever_b)
#define PUSH_ACROSS(four, first, second, mask, ns)                                                 \
    PUSH(four, first, second, mask, ns, SIMD_NEGATIVE(ns) * (four)->normal_z,                      \
         (ns) * (four)->normal_x, (four)->across_lever_a, (four)->across_lever_b)

/* --- points ------------------------------------------------------------------------------------*/

/* Bounds the friction of the points that bear a load by it. */
static void solve_friction(struct level_four *four, struct lane_bodies *a, struct lane_bodies *b)
{
    const f64x4 none = SIMD_EVERY(0.0);
    four_masks bears = (four->normal_ns > none) | (four->friction_ns != none);
    f64x4 limit = four->friction * four->normal_ns;
    f64x4 off = (b->z - a->z) * four->normal_x - (b->x - a->x) * four->normal_z +
                b->spin * four->across_lever_b - a->spin * four->across_lever_a;
    f64x4 sum = four->friction_ns + SIMD_NEGATIVE(off) * four->across_kg;
    sum = SIMD_CLAMP(sum, SIMD_NEGATIVE(limit), limit);
    f64x4 slide = sum - four->friction_ns;
    four->friction_ns = SIMD_CHOOSE(bears, sum, four->friction_ns);
    PUSH_ACROSS(four, a, b, bears, slide);
}

/* Keeps the points from closing faster than they may. *change becomes by how much a speed changes
 * at most. */
static void solve_normal(struct level_four *four, struct lane_bodies *a, struct lane_bodies *b,
                         f64x4 *change)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 off = four->least_mps - ((b->x - a->x) * four->normal_x + (b->z - a->z) * four->normal_z +
                                   b->spin * four->normal_lever_b - a->spin * four->normal_lever_a);
    f64x4 sum = four->normal_ns + off * four->normal_kg;
    sum = SIMD_CHOOSE(sum < none, none, sum);
    f64x4 step = sum - four->normal_ns;
    four_masks pushes = step != none;
    four->normal_ns = sum;
    PUSH_NORMAL(four, a, b, pushes, step);
    f64x4 by = (f64x4)(pushes & (four_masks)(SIMD_ABS(step) / four->normal_kg));
    *change = SIMD_MAX(*change, by);
}

static double most_of(const f64x4 *lanes)
{
    return maths_max(maths_max((*lanes)[0], (*lanes)[1]), maths_max((*lanes)[2], (*lanes)[3]));
}

static double sweep(struct level_lanes *lanes, bool backwards, bool rough)
{
    f64x4 change = SIMD_EVERY(0.0);
    for (uint32_t n = 0; n < lanes->fours; n++) {
        struct level_four *four = &lanes->four[backwards ? lanes->fours - 1 - n : n];
        struct lane_bodies a, b;
        take(lanes->motion, four->a, &a);
        take(lanes->motion, four->b, &b);
        if (rough)
            solve_friction(four, &a, &b);
        solve_normal(four, &a, &b, &change);
        put(lanes->motion, four->a, &a);
        put(lanes->motion, four->b, &b);
    }
    return most_of(&change);
}

VECTOR_CLONES double level_lanes_sweep(struct level_lanes *lanes, bool backwards)
{
    return sweep(lanes, backwards, true);
}

VECTOR_CLONES double level_lanes_sweep_smooth(struct level_lanes *lanes, bool backwards)
{
    return sweep(lanes, backwards, false);
}

VECTOR_CLONES bool level_lanes_begin(struct level_lanes *lanes)
{
    const f64x4 none = SIMD_EVERY(0.0);
    four_masks any = {0, 0, 0, 0};
    for (uint32_t n = 0; n < lanes->fours; n++) {
        struct level_four *four = &lanes->four[n];
        struct lane_bodies a, b;
        take(lanes->motion, four->a, &a);
        take(lanes->motion, four->b, &b);
        f64x4 limit = four->friction * four->normal_ns;
        four_masks bears = four->normal_ns != none;
        four->friction_ns = SIMD_CLAMP(four->friction_ns, SIMD_NEGATIVE(limit), limit);
        PUSH_NORMAL(four, &a, &b, bears, four->normal_ns);
        PUSH_ACROSS(four, &a, &b, bears, four->friction_ns);
        any |= bears;
        put(lanes->motion, four->a, &a);
        put(lanes->motion, four->b, &b);
    }
    return SIMD_ANY(any) != 0;
}

/* --- the ground --------------------------------------------------------------------------------*/

/* Changes a sum of the ground's impulses by a step within its limit, and makes the step what it has
 * changed by. */
#define STEP_WITHIN(sum, step, limit)                                                              \
    do {                                                                                           \
        f64x4 before = (sum);                                                                      \
        (sum) = before + (step);                                                                   \
        (sum) = SIMD_CLAMP(sum, SIMD_NEGATIVE(limit), limit);                                      \
        (step) = (sum)-before;                                                                     \
    } while (0)

/* Fixed bodies, and lanes without a body, stay as they are. */
static void hold(struct level_held *held, struct lane_bodies *bodies)
{
    four_masks fixed = held->inverse_mass == SIMD_EVERY(0.0);
    f64x4 fx = held->forward_x, fz = held->forward_z;
    f64x4 off_x = bodies->x - held->wanted_x, off_z = bodies->z - held->wanted_z;
    f64x4 off = bodies->spin - held->wanted_spin;
    f64x4 along = SIMD_NEGATIVE(off_x * fx + off_z * fz) / held->inverse_mass;
    f64x4 across = SIMD_NEGATIVE(off_z * fx - off_x * fz) / held->inverse_mass;
    f64x4 turn_by = SIMD_NEGATIVE(off) / held->inverse_moment;
    STEP_WITHIN(held->along, along, held->grip_along);
    STEP_WITHIN(held->across, across, held->grip_across);
    STEP_WITHIN(held->turn, turn_by, held->grip_turn);
    f64x4 x = bodies->x + (along * fx - across * fz) * held->inverse_mass;
    f64x4 z = bodies->z + (along * fz + across * fx) * held->inverse_mass;
    f64x4 spin = bodies->spin + turn_by * held->inverse_moment;
    bodies->x = SIMD_CHOOSE(fixed, bodies->x, x);
    bodies->z = SIMD_CHOOSE(fixed, bodies->z, z);
    bodies->spin = SIMD_CHOOSE(fixed, bodies->spin, spin);
}

VECTOR_CLONES void level_lanes_hold(struct level_lanes *lanes)
{
    for (uint32_t i = 0; i < lanes->bodies; i += 4) {
        const uint32_t body[4] = {i, i + 1, i + 2, i + 3};
        struct lane_bodies bodies;
        take(lanes->motion, body, &bodies);
        hold(&lanes->held[i / 4], &bodies);
        put(lanes->motion, body, &bodies);
    }
}
