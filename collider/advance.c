/* How time goes forward. Along a direction n the bodies are s = min n.b - max n.a apart, which a
 * look along n at the foremost vertices gives. At h from now each vertex is where its velocity
 * takes it, give or take K h^2 / 2, since no point r from an axis is accelerated by more than
 * rate^2 r (world/rotation.h). So s(h) >= S(h) - K h^2 / 2, where S, the least of straight lines,
 * is concave: what holds at h holds all the way to h, and Newton's steps from above come down to
 * the last h at which it does. For bodies that do not turn K = 0 and this is exact.
 *
 * From there, along the normal of the nearest points there, and so on: Newton's method for the gap,
 * which doubles its digits with each distance that GJK finds. */
#include "collider/advance.h"

#include "collider/gjk.h"
#include "collider/patch.h"

#define LOOKS      512   /* distances of one pair of hulls */
#define NEWTON     16    /* steps to one time */
#define TOUCHING_M 5e-10 /* a gap this near to the one looked for is it, if it gets no nearer */
#define EXACT_M    1e-12 /* and this near anyway */
#define ROUNDING_M 1e-13
#define WINDOW_M   1e-6 /* what the spheres' times may be off */
#define SHALLOW_M  1e-6 /* gaps below this are left for an overlap */
#define SPHERES_FAR                                                                                \
    0.1 /* spheres this much of their radii apart are looked at instead of hulls                   \
         */

/* A body's turning. */
struct turning {
    const struct swept_body *body;
    double share;     /* of the way from its from to its to, a frame */
    double rate;      /* [rad a frame] at most */
    struct vec3 axis; /* unit, body axes: it stands still; 0 when there is no turning */
};

/* Two hulls. */
struct pair {
    const struct turning *a, *b;
    const struct hull *hull_a, *hull_b;
    struct vec3 velocity;      /* of b's position from a's [m a frame] */
    double radii_m;            /* of the hulls' spheres */
    double bend, bend_spheres; /* K of hulls and of their spheres' centres [m a frame^2] */
};

/* A moment: positions are relative to a's. */
struct moment {
    double time;
    struct convex a, b;
    struct vec3 spin_a, spin_b; /* [rad a frame] */
};

/* How two hulls lie at a moment. */
struct sight {
    double gap; /* along the normal; below 0 they overlap by that */
    struct vec3 normal;
    struct vec3 point; /* between the nearest points */
};

/* How far apart two vertices are along a direction, and how that changes. */
struct line {
    double gap, rate;
};

static struct vec3 cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* --- bodies in time ----------------------------------------------------------------------------*/

static struct turning turning_of(const struct swept_body *body)
{
    struct turning turning = {.body = body};
    double left = 1.0 - body->path.since;
    turning.share = left > 0.0 ? 1.0 / left : 0.0;
    turning.rate = rotation_rate(body->from, body->to) * turning.share;
    struct vec3 spin = rotation_speed(body->from, body->to, 0.0);
    double speed = vec3_length(spin);
    if (speed > 0.0) {
        struct mat3 turn = rotation_matrix(body->from);
        turning.axis = rotation_back(&turn, vec3_scale(spin, 1.0 / speed));
    }
    return turning;
}

/* How far from the axis a point is. */
static double arm(const struct turning *turning, struct vec3 point)
{
    return vec3_length(cross(turning->axis, point));
}

static void pose(const struct turning *turning, double time, struct convex *convex,
                 struct vec3 *spin)
{
    const struct swept_body *body = turning->body;
    double t = maths_clamp((time - body->path.since) * turning->share, 0.0, 1.0);
    convex->scale = body->scale;
    convex->turn = rotation_matrix(rotation_between(body->from, body->to, t));
    *spin = vec3_scale(rotation_speed(body->from, body->to, t), turning->share);
}

static void aim(struct convex *convex, const struct swept_body *body, const struct hull *hull)
{
    convex->vertex = body->vertices + hull->first_vertex;
    convex->count = hull->vertex_count;
}

/* Where b is from a: the part that changes by itself, so that 50 km cost no digits. */
static struct vec3 apart_at(const struct path *a, const struct path *b, double time)
{
    struct vec3 moved_a = vec3_scale(a->along, time - a->since);
    struct vec3 moved_b = vec3_scale(b->along, time - b->since);
    return vec3_add(vec3_sub(b->at, a->at), vec3_sub(moved_b, moved_a));
}

static struct moment moment_at(const struct pair *pair, double time)
{
    struct moment now = {.time = time};
    pose(pair->a, time, &now.a, &now.spin_a);
    pose(pair->b, time, &now.b, &now.spin_b);
    aim(&now.a, pair->a->body, pair->hull_a);
    aim(&now.b, pair->b->body, pair->hull_b);
    now.a.at = (struct vec3){0.0, 0.0, 0.0};
    now.b.at = apart_at(&pair->a->body->path, &pair->b->body->path, time);
    return now;
}

static struct pair pair_of(const struct turning *a, const struct turning *b,
                           const struct hull *hull_a, const struct hull *hull_b)
{
    double scale_a = a->body->scale, scale_b = b->body->scale;
    double arm_a = arm(a, hull_a->centre) * scale_a, arm_b = arm(b, hull_b->centre) * scale_b;
    double radius_a = hull_a->radius_m * scale_a, radius_b = hull_b->radius_m * scale_b;
    double turn_a = a->rate * a->rate, turn_b = b->rate * b->rate;
    return (struct pair){
        .a = a,
        .b = b,
        .hull_a = hull_a,
        .hull_b = hull_b,
        .velocity = vec3_sub(b->body->path.along, a->body->path.along),
        .radii_m = radius_a + radius_b,
        .bend = turn_a * (arm_a + radius_a) + turn_b * (arm_b + radius_b),
        .bend_spheres = turn_a * arm_a + turn_b * arm_b,
    };
}

/* --- how long two hulls surely stay apart ------------------------------------------------------*/

/* How the points r_a and r_b of the hulls, from their bodies' positions, come apart along n. */
static struct line line_between(const struct pair *pair, const struct moment *now, struct vec3 n,
                                struct vec3 r_a, struct vec3 r_b)
{
    struct vec3 between = vec3_add(now->b.at, vec3_sub(r_b, r_a));
    struct vec3 velocity = vec3_sub(cross(now->spin_b, r_b), cross(now->spin_a, r_a));
    return (struct line){vec3_dot(n, between), vec3_dot(n, vec3_add(pair->velocity, velocity))};
}

/* The vertices that are the least apart along n at h from now, if all keep their velocities: n.(r +
 * h spin x r) is r.(n + h n x spin), so they are foremost in a direction a little turned. */
static struct line nearest_at(const struct pair *pair, const struct moment *now, struct vec3 n,
                              double h)
{
    struct vec3 towards_b = vec3_add(n, vec3_scale(cross(n, now->spin_a), h)), r_a, r_b;
    struct vec3 towards_a = vec3_scale(vec3_add(n, vec3_scale(cross(n, now->spin_b), h)), -1.0);
    gjk_support(&now->a, towards_b, &r_a);
    gjk_support(&now->b, towards_a, &r_b);
    return line_between(pair, now, n, r_a, r_b);
}

/* What a line leaves over a gap at h, whatever the bend. */
static double over(struct line line, double gap, double bend, double h)
{
    return line.gap - gap + (line.rate - 0.5 * bend * h) * h;
}

/* The h at which nothing is left; there is one, as something is left now and nothing later. */
static double root(struct line line, double gap, double bend)
{
    double left = maths_max(line.gap - gap, 0.0);
    double way = sqrt(line.rate * line.rate + 2.0 * bend * left);
    if (line.rate > 0.0)
        return (line.rate + way) / bend;
    return left > 0.0 ? 2.0 * left / (way - line.rate) : 0.0;
}

/* How long, at most `most`, the hulls surely stay more than a gap apart along n. */
static double free_for(const struct pair *pair, const struct moment *now, struct vec3 n, double gap,
                       double most)
{
    double h = most;
    for (int i = 0; i < NEWTON; i++) {
        struct line line = nearest_at(pair, now, n, h);
        if (over(line, gap, pair->bend, h) >= -ROUNDING_M)
            return h;
        h = maths_min(h, root(line, gap, pair->bend));
    }
    /* Concave: what is over is at least what is on the chord from now to h. */
    double left = nearest_at(pair, now, n, 0.0).gap - gap;
    double there = over(nearest_at(pair, now, n, h), gap, pair->bend, h);
    return left > 0.0 ? h * left / (left - there) : 0.0;
}

/* Are the hulls' spheres far apart? Then *h is how long, at most `most`, they surely stay so: that
 * takes no vertices. */
static bool spheres_free_for(const struct pair *pair, const struct moment *now, double most,
                             double *h)
{
    struct vec3 r_a = rotation_apply(&now->a.turn, vec3_scale(pair->hull_a->centre, now->a.scale));
    struct vec3 r_b = rotation_apply(&now->b.turn, vec3_scale(pair->hull_b->centre, now->b.scale));
    struct vec3 between = vec3_add(now->b.at, vec3_sub(r_b, r_a));
    double length = vec3_length(between), gap = pair->radii_m + TOUCH_M;
    if (length <= gap + SPHERES_FAR * pair->radii_m)
        return false;
    struct line line = line_between(pair, now, vec3_scale(between, 1.0 / length), r_a, r_b);
    *h = most;
    if (over(line, gap, pair->bend_spheres, most) < 0.0)
        *h = maths_min(most, root(line, gap, pair->bend_spheres));
    return true;
}

/* --- how two hulls lie -------------------------------------------------------------------------*/

static double gap_along(const struct moment *now, struct vec3 n)
{
    struct vec3 r_a, r_b;
    gjk_support(&now->a, n, &r_a);
    gjk_support(&now->b, vec3_scale(n, -1.0), &r_b);
    return vec3_dot(n, vec3_add(now->b.at, vec3_sub(r_b, r_a)));
}

/* Takes n when the hulls overlap less along it. */
static void shallower(const struct moment *now, struct vec3 n, struct sight *sight)
{
    double gap = gap_along(now, n);
    if (gap > sight->gap) {
        sight->gap = gap;
        sight->normal = n;
    }
}

/* The shallowest way out of an overlap: by the faces of both, the line of the centres, and the
 * normal that they had when they last were apart. */
static void look_inside(const struct pair *pair, const struct moment *now, struct vec3 last,
                        struct sight *sight)
{
    const struct hull_plane *planes_a = pair->a->body->planes + pair->hull_a->first_plane;
    const struct hull_plane *planes_b = pair->b->body->planes + pair->hull_b->first_plane;
    struct vec3 centre_a = rotation_apply(&now->a.turn, pair->hull_a->centre);
    struct vec3 centre_b = rotation_apply(&now->b.turn, pair->hull_b->centre);
    struct vec3 between = vec3_add(now->b.at, vec3_sub(vec3_scale(centre_b, now->b.scale),
                                                       vec3_scale(centre_a, now->a.scale)));
    double length = vec3_length(between);
    sight->gap = -INFINITY;
    for (uint32_t i = 0; i < pair->hull_a->plane_count; i++)
        shallower(now, rotation_apply(&now->a.turn, planes_a[i].normal), sight);
    for (uint32_t i = 0; i < pair->hull_b->plane_count; i++)
        shallower(now, vec3_scale(rotation_apply(&now->b.turn, planes_b[i].normal), -1.0), sight);
    shallower(now, length > 0.0 ? vec3_scale(between, 1.0 / length) : (struct vec3){0.0, 1.0, 0.0},
              sight);
    if (vec3_dot(last, last) > 0.0)
        shallower(now, last, sight);
}

/* last: the normal at the moment before, 0 for none. */
static struct sight look(const struct pair *pair, const struct moment *now, struct vec3 last)
{
    bool guess = vec3_dot(last, last) > 0.0;
    struct gjk gjk =
        gjk_distance_from(&now->a, &now->b, guess ? last : vec3_sub(now->b.at, now->a.at));
    struct sight sight = {.normal = gjk.normal, .point = vec3_lerp(gjk.on_a, gjk.on_b, 0.5)};
    if (gjk.distance_m > 0.0)
        sight.gap = gap_along(now, gjk.normal);
    else
        look_inside(pair, now, last, &sight);
    return sight;
}

/* How fast the bodies come nearer at a point [m a frame]. */
static double nearing_at(const struct pair *pair, const struct moment *now, struct vec3 n,
                         struct vec3 point)
{
    return -line_between(pair, now, n, point, vec3_sub(point, now->b.at)).rate;
}

/* Do the bodies come nearer where they touch? Then *point is where. */
static bool nearing(const struct pair *pair, const struct moment *now, const struct sight *sight,
                    struct vec3 *point)
{
    struct patch patch;
    double fastest = NEARING_M;
    bool found = false;
    if (!patch_between(&now->a, &now->b, sight->normal, &patch)) {
        patch.middle = sight->point;
        patch.count = 0;
    }
    *point = patch.middle;
    if (nearing_at(pair, now, sight->normal, patch.middle) > NEARING_M)
        return true;
    for (uint32_t i = 0; i < patch.count; i++) {
        double speed = nearing_at(pair, now, sight->normal, patch.corner[i]);
        if (speed > fastest) {
            fastest = speed;
            *point = patch.corner[i];
            found = true;
        }
    }
    return found;
}

/* --- pairs of hulls ----------------------------------------------------------------------------*/

/* The gap at which bodies that are this far apart now, and not coming nearer, touch. */
static double next_gap(double gap)
{
    if (gap <= SHALLOW_M)
        return gap - 0.5 * TOUCH_M;
    return maths_min(TOUCH_M, maths_max(0.5 * gap, gap - 0.5 * TOUCH_M));
}

static void found(const struct pair *pair, const struct moment *now, const struct sight *sight,
                  struct vec3 point, struct touch *touch)
{
    double depth = maths_max(0.0, -sight->gap);
    if (touch->toi < now->time || (touch->toi == now->time && touch->depth_m >= depth))
        return;
    *touch = (struct touch){.toi = now->time,
                            .point = vec3_add(path_at(&pair->a->body->path, now->time), point),
                            .normal = sight->normal,
                            .depth_m = depth};
}

/* Advances one pair from `from` to its touch, if there is one before `until` or touch->toi. */
static void advance(const struct pair *pair, double from, double until, struct touch *touch)
{
    struct sight sight = {.normal = {0.0, 0.0, 0.0}};
    struct vec3 point;
    double time = from, gap = TOUCH_M, last = maths_min(until, touch->toi);
    int near = 0;
    for (int looks = 0; looks < LOOKS; looks++) {
        struct moment now = moment_at(pair, time);
        double h;
        if (!spheres_free_for(pair, &now, last - time, &h)) {
            sight = look(pair, &now, sight.normal);
            double over_gap = sight.gap - gap;
            bool there = over_gap <= EXACT_M || (over_gap <= TOUCHING_M && ++near > 3);
            if ((there || looks == LOOKS - 1) && nearing(pair, &now, &sight, &point)) {
                found(pair, &now, &sight, point, touch);
                return;
            }
            gap = there ? next_gap(sight.gap) : maths_max(gap, next_gap(sight.gap));
            h = free_for(pair, &now, sight.normal, gap, last - time);
        }
        if (!(time + h < last))
            return;
        time += h;
    }
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* The part of [*from, *until] in which the spheres around the bodies are near enough. False when
 * there is none. */
static bool window(const struct swept_body *a, const struct swept_body *b, double *from,
                   double *until)
{
    struct vec3 s = apart_at(&a->path, &b->path, *from);
    struct vec3 w = vec3_sub(b->path.along, a->path.along);
    double reach = a->bound_m + b->bound_m + TOUCH_M + WINDOW_M;
    double ww = vec3_dot(w, w), sw = vec3_dot(s, w), over_reach = vec3_dot(s, s) - reach * reach;
    double root_of = sw * sw - ww * over_reach;
    if (over_reach > 0.0 && (sw >= 0.0 || root_of < 0.0))
        return false;
    if (ww == 0.0)
        return true;
    double way = sqrt(maths_max(root_of, 0.0));
    if (sw < way)
        *until = maths_min(*until, *from + (way - sw) / ww);
    if (over_reach > 0.0)
        *from += over_reach / (way - sw);
    return *from <= *until;
}

static int order_of(double a, double b)
{
    return (a > b) - (a < b);
}

static int order_of_points(struct vec3 a, struct vec3 b)
{
    int order = order_of(a.x, b.x);
    if (order == 0)
        order = order_of(a.y, b.y);
    return order != 0 ? order : order_of(a.z, b.z);
}

static int order_of_turns(struct quat a, struct quat b)
{
    int order = order_of(a.w, b.w);
    return order != 0 ? order
                      : order_of_points((struct vec3){a.x, a.y, a.z}, (struct vec3){b.x, b.y, b.z});
}

/* Which of two bodies is computed as the first, whatever the caller calls them. Bodies that are
 * alike in all of this do not move against each other. */
static int order_of_bodies(const struct swept_body *a, const struct swept_body *b)
{
    int order = order_of_points(a->path.at, b->path.at);
    if (order == 0)
        order = order_of_points(a->path.along, b->path.along);
    if (order == 0)
        order = order_of(a->path.since, b->path.since);
    if (order == 0)
        order = order_of_turns(a->from, b->from);
    return order != 0 ? order : order_of_turns(a->to, b->to);
}

bool advance_touch(const struct swept_body *a, const struct swept_body *b, double from,
                   struct touch *touch)
{
    double until = 1.0;
    bool swap = order_of_bodies(a, b) > 0;
    if (swap) {
        const struct swept_body *other = a;
        a = b;
        b = other;
    }
    if (!window(a, b, &from, &until))
        return false;
    struct turning turning_a = turning_of(a), turning_b = turning_of(b);
    if (turning_a.rate == 0.0 && turning_b.rate == 0.0 &&
        order_of_points(a->path.along, b->path.along) == 0)
        return false; /* at rest with each other */
    touch->toi = INFINITY;
    touch->depth_m = 0.0;
    for (uint32_t i = 0; i < a->hull_count; i++) {
        for (uint32_t j = 0; j < b->hull_count; j++) {
            struct pair pair = pair_of(&turning_a, &turning_b, &a->hull[i], &b->hull[j]);
            advance(&pair, from, until, touch);
        }
    }
    if (touch->toi == INFINITY)
        return false;
    if (swap)
        touch->normal = vec3_scale(touch->normal, -1.0);
    return true;
}

double advance_gap(const struct swept_body *a, const struct swept_body *b, double time)
{
    struct turning turning_a = turning_of(a), turning_b = turning_of(b);
    double least = INFINITY;
    for (uint32_t i = 0; i < a->hull_count; i++) {
        for (uint32_t j = 0; j < b->hull_count; j++) {
            struct pair pair = pair_of(&turning_a, &turning_b, &a->hull[i], &b->hull[j]);
            struct moment now = moment_at(&pair, time);
            least = maths_min(least, gjk_distance(&now.a, &now.b).distance_m);
        }
    }
    return least;
}
