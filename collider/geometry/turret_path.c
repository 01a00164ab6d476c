/* A turret turns x towards z, a gun x towards y. So a point v of the gun is at
 *
 *     q = P + T (S + G (v - S) - P) = T G v + [P + T (S - P - G S)]
 *
 * with the turret's pivot P and rotation T, and the gun's pivot S and rotation G. Let t' and g' be
 * the rates of the two angles. A point at s from the gun's axis and at r from the turret's is no
 * faster than t' r + g' s, and accelerated by no more than t'^2 r + 2 t' g' s + g'^2 s. */
#include "collider/geometry/turret_path.h"

static double over(double a, double b)
{
    return sqrt(a * a + b * b);
}

static struct mat3 turret_turn(double angle)
{
    double sine, cosine;
    maths_sincos(angle, &sine, &cosine);
    return (struct mat3){{{cosine, 0.0, -sine}, {0.0, 1.0, 0.0}, {sine, 0.0, cosine}}};
}

static struct mat3 gun_turn(double angle)
{
    double sine, cosine;
    maths_sincos(angle, &sine, &cosine);
    return (struct mat3){{{cosine, -sine, 0.0}, {sine, cosine, 0.0}, {0.0, 0.0, 1.0}}};
}

static struct part_pose compute(const struct turret_path *path, uint32_t part, double time)
{
    struct mat3 turret = turret_turn(path->turret + path->turret_turn * time);
    struct vec3 pivot = path->turret_pivot;
    if (part == HULL_PART_TURRET)
        return (struct part_pose){turret, vec3_sub(pivot, rotation_apply(&turret, pivot))};
    struct mat3 gun = gun_turn(path->gun + path->gun_turn * time);
    struct vec3 off =
        vec3_sub(vec3_sub(path->gun_pivot, pivot), rotation_apply(&gun, path->gun_pivot));
    return (struct part_pose){rotation_both(&turret, &gun),
                              vec3_add(pivot, rotation_apply(&turret, off))};
}

void turret_path_set(struct turret_path *path, double turret, double gun, double turret_turn,
                     double gun_turn)
{
    path->turret = turret;
    path->gun = gun;
    path->turret_turn = turret_turn;
    path->gun_turn = gun_turn;
    path->turret_begins = compute(path, HULL_PART_TURRET, 0.0);
    path->gun_begins = compute(path, HULL_PART_GUN, 0.0);
}

struct part_pose turret_path_pose(const struct turret_path *path, uint32_t part, double time)
{
    if (turret_path_moves(path))
        return compute(path, part, maths_clamp(time, 0.0, 1.0));
    return part == HULL_PART_TURRET ? path->turret_begins : path->gun_begins;
}

struct part_motion turret_path_at(const struct turret_path *path, uint32_t part, double time)
{
    struct part_motion motion = {.pose = turret_path_pose(path, part, time)};
    if (!turret_path_moves(path))
        return motion;
    const struct part_pose *pose = &motion.pose;
    struct vec3 by_turret = {0.0, -path->turret_turn, 0.0}, by_gun = {0.0, 0.0, 0.0};
    motion.velocity = vec3_cross(by_turret, vec3_sub(pose->at, path->turret_pivot));
    if (part == HULL_PART_GUN) {
        by_gun = rotation_apply(&pose->turn, (struct vec3){0.0, 0.0, path->gun_turn});
        motion.velocity = vec3_sub(
            motion.velocity, vec3_cross(by_gun, rotation_apply(&pose->turn, path->gun_pivot)));
    }
    motion.spin = vec3_add(by_turret, by_gun);
    return motion;
}

struct part_bounds turret_path_bounds(const struct turret_path *path, const struct hull *hull,
                                      double radius_m)
{
    struct vec3 pivot = path->turret_pivot, centre = hull->centre;
    double turn = fabs(path->turret_turn), raise = 0.0, height, around, about_gun = 0.0;
    if (hull->part == HULL_PART_GUN) {
        raise = fabs(path->gun_turn);
        about_gun = over(centre.x - path->gun_pivot.x, centre.y - path->gun_pivot.y) + radius_m;
        height = fabs(path->gun_pivot.y) + about_gun;
        around = over(fabs(path->gun_pivot.x - pivot.x) + about_gun,
                      fabs(centre.z - pivot.z) + radius_m);
    } else {
        height = fabs(centre.y) + radius_m;
        around = over(centre.x - pivot.x, centre.z - pivot.z) + radius_m;
    }
    return (struct part_bounds){
        .reach = over(over(pivot.x, pivot.z) + around, height),
        .speed = turn * around + raise * about_gun,
        .bend = turn * turn * around + raise * (2.0 * turn + raise) * about_gun,
    };
}

/* The box where the hull is in the middle of the frame, widened by how far its points move until
 * then and from then on. */
struct hull_box turret_path_box(const struct turret_path *path, const struct hull *hull)
{
    struct hull_box box = {hull->centre, hull->half};
    if (!turret_path_turns(path, hull))
        return box;
    const struct part_pose pose = turret_path_pose(path, hull->part, 0.5);
    const double(*m)[3] = pose.turn.m;
    double moved = 0.5 * turret_path_bounds(path, hull, hull->radius_m).speed, half[3];
    for (int k = 0; k < 3; k++)
        half[k] = fabs(m[k][0]) * hull->half.x + fabs(m[k][1]) * hull->half.y +
                  fabs(m[k][2]) * hull->half.z + moved;
    box.middle = vec3_add(rotation_apply(&pose.turn, hull->centre), pose.at);
    box.half = (struct vec3){half[0], half[1], half[2]};
    return box;
}

struct hull_box turret_path_box_all(const struct turret_path *path)
{
    struct vec3 low = {INFINITY, INFINITY, INFINITY}, high = vec3_scale(low, -1.0);
    for (uint32_t i = 0; i < path->outers; i++) {
        struct hull_box box = turret_path_box(path, &path->outer[i]);
        struct vec3 from = vec3_sub(box.middle, box.half), to = vec3_add(box.middle, box.half);
        low = (struct vec3){maths_min(low.x, from.x), maths_min(low.y, from.y),
                            maths_min(low.z, from.z)};
        high = (struct vec3){maths_max(high.x, to.x), maths_max(high.y, to.y),
                             maths_max(high.z, to.z)};
    }
    return (struct hull_box){vec3_lerp(low, high, 0.5), vec3_scale(vec3_sub(high, low), 0.5)};
}

static int order_of(double a, double b)
{
    return (a > b) - (a < b);
}

int turret_path_order(const struct turret_path *a, const struct turret_path *b)
{
    int order = order_of(a->turret, b->turret);
    if (order == 0)
        order = order_of(a->gun, b->gun);
    if (order == 0)
        order = order_of(a->turret_turn, b->turret_turn);
    return order != 0 ? order : order_of(a->gun_turn, b->gun_turn);
}
