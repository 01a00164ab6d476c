/* Let z be the vector from a vertex of a to one of b, with velocity z' per frame, and n the normal
 * of a plane that swings by m a frame. At time h from now z is z + h z', to within K h^2 / 2, as no
 * point at r from an axis is accelerated by more than rate^2 r (world/maths/rotation.h). So along n
 * + h m the separation of the two is (for a body that spins freely rate^2 stands for the bound that
 * free_turn.h gives)
 *
 *     n.z + h (n.z' + m.z)     linear in h; the least over all vertices is concave
 *     + h^2 m.z'               the translation's part is known, the rotation's part is bounded
 *     - |n + h m| K h^2 / 2    by the acceleration
 *
 * where a gap counts |n + h m| <= 1 + h^2 m.m / 2 times, as n and m are orthogonal. Together this
 * is a concave function less a bend B h^2 / 2. If it is positive at some h, it is positive from now
 * until h. Newton's steps from above descend to the last h at which it equals the gap. The least
 * linear function is that of the vertices that are foremost in a direction: n.(r + h spin x r) + h
 * m.r = r.(n + h (n x spin + m)). */
#include "collider/geometry/hull_separation.h"

#define NEWTON     16 /* steps for one time */
#define ROUNDING_M 1e-13
#define BOUND_M    1e-9 /* error of gjk_most_apart() */
/* Spheres that are this share of their radii apart are tested instead of the hulls. */
#define SPHERES_FAR 0.1

/* Separation of two points along a direction, and its rate of change. */
struct line {
    double gap, rate;
};

/* --- bodies in time ----------------------------------------------------------------------------*/

struct rotation_path rotation_path_of(const struct swept_body *body)
{
    struct rotation_path rotation = {.body = body, .turn = rotation_matrix(body->from)};
    double left = 1.0 - body->path.since;
    rotation.share = left > 0.0 ? 1.0 / left : 0.0;
    if (body->turn) {
        rotation.free = true;
        rotation.rate = free_turn_rate(body->turn, &rotation.bend) * rotation.share;
        rotation.bend *= rotation.share * rotation.share;
        return rotation;
    }
    rotation.rate = rotation_rate(body->from, body->to) * rotation.share;
    rotation.bend = rotation.rate * rotation.rate;
    struct vec3 spin = rotation_speed(body->from, body->to, 0.0);
    double speed = vec3_length(spin);
    if (speed > 0.0)
        rotation.axis = rotation_back(&rotation.turn, vec3_scale(spin, 1.0 / speed));
    return rotation;
}

/* Returns how far the centre of the hull's sphere is from the axis at most [m]. */
static double arm_of(const struct rotation_path *rotation, const struct hull *hull)
{
    struct vec3 arm = rotation->free ? hull->centre : vec3_cross(rotation->axis, hull->centre);
    return vec3_length(arm) * rotation->body->scale;
}

/* How the points within a radius of the centre of a hull's sphere move by rotation at most. */
struct bounds {
    double speed, bend;
};

static struct bounds bounds_of(const struct rotation_path *rotation, const struct hull *hull,
                               double radius_m)
{
    const struct swept_body *body = rotation->body;
    double scale = body->scale, rate = rotation->rate;
    if (!turret_path_turns(&body->turret, hull)) {
        double arm = arm_of(rotation, hull) + radius_m * scale;
        return (struct bounds){rate * arm, rotation->bend * arm};
    }
    struct part_bounds part = turret_path_bounds(&body->turret, hull, radius_m);
    double bend = rotation->bend * part.reach + 2.0 * rate * part.speed + part.bend;
    return (struct bounds){(rate * part.reach + part.speed) * scale, bend * scale};
}

struct hull_pair hull_pair_of(const struct rotation_path *a, const struct rotation_path *b,
                              const struct hull *hull_a, const struct hull *hull_b)
{
    struct bounds bounds_a = bounds_of(a, hull_a, hull_a->radius_m);
    struct bounds bounds_b = bounds_of(b, hull_b, hull_b->radius_m);
    return (struct hull_pair){
        .a = a,
        .b = b,
        .hull_a = hull_a,
        .hull_b = hull_b,
        .velocity = vec3_sub(b->body->path.along, a->body->path.along),
        .radii_m = hull_a->radius_m * a->body->scale + hull_b->radius_m * b->body->scale,
        .speed = bounds_a.speed + bounds_b.speed,
        .bend = bounds_a.bend + bounds_b.bend,
        .bend_spheres = bounds_of(a, hull_a, 0.0).bend + bounds_of(b, hull_b, 0.0).bend,
    };
}

struct hull_pair hull_pair_first(const struct rotation_path *a, const struct rotation_path *b,
                                 uint64_t pairs)
{
    uint32_t bit = (uint32_t)__builtin_ctzll(pairs);
    return hull_pair_of(a, b, &a->body->hull[bit / HULLS_A_MODEL],
                        &b->body->hull[bit % HULLS_A_MODEL]);
}

struct body_pose body_pose_at(const struct rotation_path *rotation, double time)
{
    const struct swept_body *body = rotation->body;
    struct body_pose pose = {.body = body, .turn = rotation->turn};
    if (!(rotation->rate > 0.0))
        return pose;
    double t = maths_clamp((time - body->path.since) * rotation->share, 0.0, 1.0);
    struct quat turned;
    if (rotation->free) {
        free_turn_at(body->turn, t, &turned, &pose.spin);
    } else {
        turned = rotation_between(body->from, body->to, t);
        pose.spin = rotation_speed(body->from, body->to, t);
    }
    pose.turn = rotation_matrix(turned);
    pose.spin = vec3_scale(pose.spin, rotation->share);
    return pose;
}

/* How a hull moves at one time: its axes [rad a frame], and its origin in its body [m a frame]. */
struct hull_motion {
    struct vec3 spin, velocity;
};

/* Turns the hull of a turret or a gun in its body. */
static void turn_part(const struct swept_body *body, const struct hull *hull, double time,
                      struct convex *convex, struct hull_motion *motion)
{
    struct part_motion part = turret_path_at(&body->turret, hull->part, time);
    struct mat3 turn = convex->turn;
    convex->turn = rotation_both(&turn, &part.pose.turn);
    convex->at = rotation_apply(&turn, vec3_scale(part.pose.at, body->scale));
    motion->velocity = vec3_add(vec3_cross(motion->spin, convex->at),
                                rotation_apply(&turn, vec3_scale(part.velocity, body->scale)));
    motion->spin = vec3_add(motion->spin, rotation_apply(&turn, part.spin));
}

/* Puts a hull where it is at one time, relative to its body's position. */
static struct hull_motion put_hull(const struct body_pose *pose, const struct hull *hull,
                                   double time, struct convex *convex)
{
    const struct swept_body *body = pose->body;
    struct hull_motion motion = {.spin = pose->spin};
    convex->vertex = body->vertices + hull->first_vertex;
    convex->count = hull->vertex_count;
    convex->scale = body->scale;
    convex->turn = pose->turn;
    convex->at = (struct vec3){0.0, 0.0, 0.0};
    if (turret_path_turns(&body->turret, hull))
        turn_part(body, hull, time, convex, &motion);
    return motion;
}

static struct vec3 centre_of(const struct convex *convex, const struct hull *hull)
{
    return rotation_apply(&convex->turn, vec3_scale(hull->centre, convex->scale));
}

struct vec3 hull_separation_at(const struct path *a, const struct path *b, double time)
{
    struct vec3 moved_a = vec3_scale(a->along, time - a->since);
    struct vec3 moved_b = vec3_scale(b->along, time - b->since);
    return vec3_add(vec3_sub(b->at, a->at), vec3_sub(moved_b, moved_a));
}

struct relative_pose relative_pose_of(const struct body_pose *a, const struct hull *hull_a,
                                      const struct body_pose *b, const struct hull *hull_b,
                                      double time)
{
    struct relative_pose now;
    struct hull_motion of_a = put_hull(a, hull_a, time, &now.a);
    struct hull_motion of_b = put_hull(b, hull_b, time, &now.b);
    struct vec3 at = hull_separation_at(&a->body->path, &b->body->path, time);
    now.time = time;
    now.spin_a = of_a.spin;
    now.spin_b = of_b.spin;
    now.velocity = vec3_add(vec3_sub(b->body->path.along, a->body->path.along),
                            vec3_sub(of_b.velocity, of_a.velocity));
    now.centre_a = centre_of(&now.a, hull_a);
    now.centre_b = centre_of(&now.b, hull_b);
    now.b.at = vec3_add(at, now.b.at);
    now.between = vec3_sub(now.b.at, now.a.at);
    now.towards = vec3_add(now.between, vec3_sub(now.centre_b, now.centre_a));
    now.centres_m = vec3_length(now.towards);
    now.towards = now.centres_m > 0.0 ? vec3_scale(now.towards, 1.0 / now.centres_m)
                                      : (struct vec3){0.0, 1.0, 0.0};
    return now;
}

struct relative_pose relative_pose_at(const struct hull_pair *pair, double time)
{
    struct body_pose a = body_pose_at(pair->a, time), b = body_pose_at(pair->b, time);
    return relative_pose_of(&a, pair->hull_a, &b, pair->hull_b, time);
}

/* --- lines -------------------------------------------------------------------------------------*/

/* Returns the velocity of the vector from r_a to r_b, both relative to their hulls' origins. */
static struct vec3 parting(const struct relative_pose *now, struct vec3 r_a, struct vec3 r_b)
{
    return vec3_add(now->velocity,
                    vec3_sub(vec3_cross(now->spin_b, r_b), vec3_cross(now->spin_a, r_a)));
}

static struct line line_between(const struct relative_pose *now, const struct plane *plane,
                                struct vec3 r_a, struct vec3 r_b)
{
    struct vec3 z = vec3_add(now->between, vec3_sub(r_b, r_a));
    return (struct line){vec3_dot(plane->normal, z),
                         vec3_dot(plane->normal, parting(now, r_a, r_b)) +
                             vec3_dot(plane->swing, z)};
}

/* Returns the linear function of the vertices with the least separation at h. */
static struct line nearest_at(const struct relative_pose *now, const struct plane *plane, double h)
{
    struct vec3 n = plane->normal, r_a, r_b;
    struct vec3 change_a = vec3_add(vec3_cross(n, now->spin_a), plane->swing);
    struct vec3 change_b = vec3_add(vec3_cross(n, now->spin_b), plane->swing);
    gjk_support(&now->a, vec3_add(n, vec3_scale(change_a, h)), &r_a);
    gjk_support(&now->b, vec3_scale(vec3_add(n, vec3_scale(change_b, h)), -1.0), &r_b);
    return line_between(now, plane, r_a, r_b);
}

/* Returns how much of the separation is left over a gap at h. */
static double over(struct line line, double gap, double bend, double h)
{
    return line.gap - gap + (line.rate - 0.5 * bend * h) * h;
}

/* Returns the h at which the separation equals the gap. There is one, since the separation is
 * greater now and smaller later. */
static double root(struct line line, double gap, double bend)
{
    double left = maths_max(line.gap - gap, 0.0);
    double root = sqrt(line.rate * line.rate + 2.0 * bend * left);
    if (line.rate > 0.0)
        return (line.rate + root) / bend;
    return left > 0.0 ? 2.0 * left / (root - line.rate) : 0.0;
}

/* Returns the bend of the separation for h up to most. */
static double bend_of(const struct hull_pair *pair, const struct plane *plane, double gap,
                      double most)
{
    double square = vec3_dot(plane->swing, plane->swing), swing = sqrt(square);
    double known = vec3_dot(plane->swing, pair->velocity);
    return pair->bend * (1.0 + swing * most) + 2.0 * swing * pair->speed +
           maths_max(0.0, -2.0 * known) + square * maths_max(0.0, gap);
}

/* Returns the greatest angular speed of a part of a body [rad a frame]. */
static double rate_of(const struct rotation_path *rotation)
{
    const struct turret_path *turret = &rotation->body->turret;
    return rotation->rate + fabs(turret->turret_turn) + fabs(turret->gun_turn);
}

/* --- public ------------------------------------------------------------------------------------*/

double hull_separation_now(const struct relative_pose *now, struct vec3 normal)
{
    struct vec3 r_a, r_b;
    gjk_support(&now->a, normal, &r_a);
    gjk_support(&now->b, vec3_scale(normal, -1.0), &r_b);
    return vec3_dot(normal, vec3_add(now->between, vec3_sub(r_b, r_a)));
}

double hull_separation_above(const struct relative_pose *now, const struct gjk *gjk,
                             struct vec3 normal, double length_m)
{
    return gjk_most_apart(gjk, normal) < length_m - BOUND_M ? length_m
                                                            : hull_separation_now(now, normal);
}

double hull_separation_nearing(const struct relative_pose *now, struct vec3 normal,
                               struct vec3 point)
{
    return -vec3_dot(normal, parting(now, vec3_sub(point, now->a.at), vec3_sub(point, now->b.at)));
}

double hull_separation_for(const struct hull_pair *pair, const struct relative_pose *now,
                           const struct plane *plane, double gap, double most)
{
    double bend = bend_of(pair, plane, gap, most), h = most;
    for (int i = 0; i < NEWTON; i++) {
        struct line line = nearest_at(now, plane, h);
        if (over(line, gap, bend, h) >= -ROUNDING_M)
            return h;
        h = maths_min(h, root(line, gap, bend));
    }
    /* Concave: the separation is at least its chord from now to h. */
    double left = nearest_at(now, plane, 0.0).gap - gap;
    double there = over(nearest_at(now, plane, h), gap, bend, h);
    return left > 0.0 ? h * left / (left - there) : 0.0;
}

struct vec3 hull_separation_swing(const struct hull_pair *pair, const struct relative_pose *now,
                                  struct vec3 normal, const struct gjk_start *nearest)
{
    struct vec3 edge[2], rest = {0.0, 0.0, 0.0}, first = rest, first_parting = rest;
    double change[2], most = 2.0 * (rate_of(pair->a) + rate_of(pair->b));
    if (most == 0.0 || nearest->count < 2)
        return rest;
    /* n stays orthogonal to the edges e of the simplex: m.e = -n.e'. */
    for (uint32_t i = 0; i < nearest->count; i++) {
        struct vec3 r_a = gjk_vertex(&now->a, nearest->a[i]);
        struct vec3 r_b = gjk_vertex(&now->b, nearest->b[i]);
        struct vec3 z = vec3_sub(r_b, r_a), z_parting = parting(now, r_a, r_b);
        if (i == 0) {
            first = z;
            first_parting = z_parting;
        } else {
            edge[i - 1] = vec3_sub(z, first);
            change[i - 1] = -vec3_dot(normal, vec3_sub(z_parting, first_parting));
        }
    }
    struct vec3 swing;
    if (nearest->count == 2) {
        swing = vec3_scale(edge[0], change[0] / vec3_dot(edge[0], edge[0]));
    } else {
        struct vec3 across = vec3_cross(edge[1], normal), over_it = vec3_cross(normal, edge[0]);
        swing = vec3_add(vec3_scale(across, change[0] / vec3_dot(edge[0], across)),
                         vec3_scale(over_it, change[1] / vec3_dot(edge[1], over_it)));
    }
    /* For edges of almost no length the swing would be noise. */
    return vec3_dot(swing, swing) <= most * most ? swing : rest;
}

bool hull_separation_by_spheres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most, double *h)
{
    double gap = pair->radii_m + SKIN_M;
    if (now->centres_m <= gap + SPHERES_FAR * pair->radii_m)
        return false;
    const struct plane plane = {.normal = now->towards};
    struct line line = line_between(now, &plane, now->centre_a, now->centre_b);
    *h = most;
    if (over(line, gap, pair->bend_spheres, most) < 0.0)
        *h = maths_min(most, root(line, gap, pair->bend_spheres));
    return true;
}

bool hull_separation_by_centres(const struct hull_pair *pair, const struct relative_pose *now,
                                double most)
{
    const struct plane plane = {.normal = now->towards};
    if (nearest_at(now, &plane, 0.0).gap < SKIN_M)
        return false;
    return over(nearest_at(now, &plane, most), SKIN_M, pair->bend, most) >= 0.0;
}
