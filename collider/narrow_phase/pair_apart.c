/* Bounding spheres first, then a plane between the hulls. */
#include "collider/narrow_phase/pair_apart.h"

#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#define ROUNDING_M 1e-6 /* of distances between spheres */

int pair_apart_init(struct pair_apart *apart, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *apart = (struct pair_apart){.world = world,
                                 .pose = reserve_take(rows, sizeof *apart->pose),
                                 .place = reserve_take(rows, sizeof *apart->place),
                                 .known = reserve_take(rows, sizeof *apart->known)};
    if (apart->pose && apart->place && apart->known)
        return 0;
    pair_apart_free(apart);
    return -1;
}

void pair_apart_free(struct pair_apart *apart)
{
    reserve_free(apart->pose);
    reserve_free(apart->place);
    reserve_free(apart->known);
    *apart = (struct pair_apart){0};
}

void pair_apart_prepare(struct pair_apart *apart, const struct body_motion *motion, uint32_t row)
{
    struct row_pose *pose = &apart->pose[apart->place[row] - 1];
    struct free_turn turn;
    body_motion_put(motion, row, &turn, &pose->body);
    pose->freely = pose->body.turn != NULL;
    pose->body.turn = NULL; /* it points to this function's memory */
    pose->rate = rotation_rate(pose->body.from, pose->body.to);
    pose->spin_y = 0.0;
    if (pose->rate > 0.0 && pose->body.path.since < 1.0)
        pose->spin_y =
            rotation_speed(pose->body.from, pose->body.to, 0.0).y / (1.0 - pose->body.path.since);
    if (!pose->freely)
        axis_side_set(&pose->side, &pose->body, pose->rate, pose->body.path.since);
}

/* Returns true if the spheres around two bodies stay apart. */
static bool spheres_stay(const struct swept_body *a, const struct swept_body *b, double time,
                         double margin_m)
{
    struct vec3 between = vec3_sub(path_at(&b->path, time), path_at(&a->path, time));
    struct vec3 along = vec3_sub(b->path.along, a->path.along);
    double speed2 = vec3_dot(along, along), nearest = 0.0;
    if (speed2 > 0.0)
        nearest = maths_clamp(-vec3_dot(between, along) / speed2, 0.0, 1.0 - time);
    struct vec3 then = vec3_add(between, vec3_scale(along, nearest));
    double reach = a->bound_m + b->bound_m + margin_m + ROUNDING_M;
    return vec3_dot(then, then) > reach * reach;
}

static struct row_pose fixed_pose(const struct pair_apart *apart, uint32_t object)
{
    struct row_pose pose = {.body = body_motion_fixed(apart->world, object)};
    axis_side_set(&pose.side, &pose.body, 0.0, 0.0);
    return pose;
}

/* Returns the side of a body from a time on. Most proofs begin with the body's path, and a body has
 * many neighbours. */
static const struct axis_side *side_from(const struct row_pose *pose, double time,
                                         struct axis_side *room)
{
    if (time == pose->body.path.since)
        return &pose->side;
    axis_side_set(room, &pose->body, pose->rate, time);
    return room;
}

bool pair_apart_stays(const struct pair_apart *apart, const struct pair *pair, double time,
                      double margin_m, bool nearest, struct vec3 *axis, double *apart_m)
{
    const struct row_pose *a = pair_apart_pose(apart, pair->a), *b = NULL;
    struct row_pose fixed;
    if (pair->b & PAIR_FIXED) {
        fixed = fixed_pose(apart, pair->b & ~PAIR_FIXED);
        b = &fixed;
    } else {
        b = pair_apart_pose(apart, pair->b);
    }
    *apart_m = margin_m;
    if (spheres_stay(&a->body, &b->body, time, margin_m))
        return true;
    if (a->freely || b->freely)
        return false;
    struct axis_side room_a, room_b;
    const struct axis_side *side_a = side_from(a, time, &room_a);
    const struct axis_side *side_b = side_from(b, time, &room_b);
    return separating_axis_find(side_a, side_b, margin_m, nearest, axis, apart_m);
}
