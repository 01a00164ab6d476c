/* Time advances to the last time at which the plane between the nearest points certainly separates
 * the hulls (hull_separation.c), from there along the plane between the nearest points at that
 * time, and so on. This is Newton's method for the gap. As the plane turns with the surfaces, each
 * distance that GJK finds doubles the number of correct digits. */
#include "collider/geometry/time_of_impact.h"

#include "collider/geometry/box_view.h"
#include "collider/geometry/contact_manifold.h"
#include "collider/geometry/hull_separation.h"

#define DISTANCES_MAX 1024 /* distances of one pair of hulls */
#define CLOSE_M                                                                                    \
    5e-10 /* a gap that differs from the target by no more is accepted after a few tries */
#define TRIES     3
#define EXACT_M   1e-12 /* and by no more than this at once */
#define WINDOW_M  1e-6  /* error of the times that the spheres give */
#define SHALLOW_M 1e-6  /* smaller gaps are treated as an overlap */
#define DEEP      0.05  /* of an overlap: when it grows by this share, the bodies touch again */

/* Position of two hulls relative to each other at one time. */
struct separation {
    double gap; /* along the plane's normal; below 0 the depth of the overlap */
    struct plane plane;
    struct vec3 point; /* midway between the nearest points */
};

/* --- how two hulls lie -------------------------------------------------------------------------*/

/* Takes the plane if the hulls overlap it less; its normal turns with a spin. */
static void shallower(const struct relative_pose *now, const struct gjk *gjk, struct vec3 normal,
                      struct vec3 spin, struct separation *separation)
{
    double gap = hull_separation_above(now, gjk, normal, separation->gap);
    if (gap > separation->gap) {
        separation->gap = gap;
        separation->plane = (struct plane){normal, vec3_cross(spin, normal)};
    }
}

/* Finds the direction of least overlap among the faces of both hulls, the line of the centres, and
 * the normal from when they were last apart. */
static void measure_overlap(const struct hull_pair *pair, const struct relative_pose *now,
                            const struct gjk *gjk, struct vec3 last, struct separation *separation)
{
    const struct hull_plane *planes_a = pair->a->body->planes + pair->hull_a->first_plane;
    const struct hull_plane *planes_b = pair->b->body->planes + pair->hull_b->first_plane;
    const struct vec3 still = {0.0, 0.0, 0.0};
    separation->gap = -INFINITY;
    for (uint32_t i = 0; i < pair->hull_a->plane_count; i++)
        shallower(now, gjk, rotation_apply(&now->a.turn, planes_a[i].normal), now->spin_a,
                  separation);
    for (uint32_t i = 0; i < pair->hull_b->plane_count; i++)
        shallower(now, gjk, vec3_scale(rotation_apply(&now->b.turn, planes_b[i].normal), -1.0),
                  now->spin_b, separation);
    shallower(now, gjk, now->towards, still, separation);
    if (vec3_dot(last, last) > 0.0)
        shallower(now, gjk, last, still, separation);
}

/* last: the normal of the time before, 0 for none. */
static struct separation measure(const struct hull_pair *pair, const struct relative_pose *now,
                                 struct vec3 last, struct gjk_start *start)
{
    start->guess = now->towards;
    struct gjk gjk = gjk_distance_from(&now->a, &now->b, start);
    struct separation separation = {.point = vec3_lerp(gjk.on_a, gjk.on_b, 0.5)};
    if (gjk.distance_m > 0.0) {
        separation.gap = hull_separation_now(now, gjk.normal);
        separation.plane =
            (struct plane){gjk.normal, hull_separation_swing(pair, now, gjk.normal, start)};
    } else {
        measure_overlap(pair, now, &gjk, last, &separation);
    }
    return separation;
}

/* Used without a manifold: takes a point between the nearest points, or inside both of two
 * overlapping bodies, and the foremost vertices. */
static void scattered(const struct relative_pose *now, const struct separation *separation,
                      struct contact_manifold *patch)
{
    patch->middle = separation->point;
    patch->count = 2;
    gjk_support(&now->a, separation->plane.normal, &patch->corner[0]);
    gjk_support(&now->b, vec3_scale(separation->plane.normal, -1.0), &patch->corner[1]);
    patch->corner[0] = vec3_add(patch->corner[0], now->a.at);
    patch->corner[1] = vec3_add(patch->corner[1], now->b.at);
}

/* Returns true if the bodies approach where they touch; *point is where. */
static bool nearing(const struct relative_pose *now, const struct separation *separation,
                    struct vec3 *point)
{
    struct contact_manifold patch;
    struct vec3 normal = separation->plane.normal;
    double fastest = NEARING_M;
    bool nears = false;
    if (!contact_manifold_between(&now->a, &now->b, normal, &patch))
        scattered(now, separation, &patch);
    *point = patch.middle;
    if (hull_separation_nearing(now, normal, patch.middle) > NEARING_M)
        return true;
    for (uint32_t i = 0; i < patch.count; i++) {
        double speed = hull_separation_nearing(now, normal, patch.corner[i]);
        if (speed > fastest) {
            fastest = speed;
            *point = patch.corner[i];
            nears = true;
        }
    }
    return nears;
}

/* --- pairs of hulls ----------------------------------------------------------------------------*/

/* Returns the gap at which bodies that are this far apart now, and do not approach, touch. */
static double next_gap(double gap)
{
    if (gap <= SHALLOW_M)
        return gap - maths_max(0.5 * SKIN_M, -DEEP * gap);
    return maths_min(SKIN_M, maths_max(0.5 * gap, gap - 0.5 * SKIN_M));
}

/* Returns the plane's normal after h. */
static struct vec3 normal_after(const struct plane *plane, double h)
{
    struct vec3 normal = vec3_add(plane->normal, vec3_scale(plane->swing, h));
    return vec3_scale(normal, 1.0 / vec3_length(normal));
}

/* Keeps the contact if it is earlier than the one found so far, or deeper. */
static void found(const struct hull_pair *pair, const struct relative_pose *now,
                  const struct separation *separation, struct vec3 point,
                  struct hull_contact *impact)
{
    double depth = maths_max(0.0, -separation->gap);
    if (impact->toi < now->time || (impact->toi == now->time && impact->depth_m >= depth))
        return;
    *impact =
        (struct hull_contact){.toi = now->time,
                              .point = vec3_add(path_at(&pair->a->body->path, now->time), point),
                              .normal = separation->plane.normal,
                              .depth_m = depth};
}

/* Advances one pair of hulls from now to its contact, if there is one before `until` and before the
 * contact found so far. */
static void time_of_impact(const struct hull_pair *pair, struct relative_pose now, double until,
                           struct hull_contact *impact)
{
    struct gjk_start start = {.count = 0};
    struct vec3 point, normal = {0.0, 0.0, 0.0};
    double time = now.time, gap = SKIN_M, last = maths_min(until, impact->toi), h;
    bool first = true;
    int tries = 0;
    for (int looks = 0; looks < DISTANCES_MAX; looks++) {
        if (!hull_separation_by_spheres(pair, &now, last - time, &h)) {
            if (first && hull_separation_by_centres(pair, &now, last - time))
                return;
            first = false;
            struct separation separation = measure(pair, &now, normal, &start);
            double left = separation.gap - gap;
            bool there = left <= EXACT_M || (left <= CLOSE_M && tries++ >= TRIES);
            if ((there || looks == DISTANCES_MAX - 1) && nearing(&now, &separation, &point)) {
                found(pair, &now, &separation, point, impact);
                return;
            }
            gap = there ? next_gap(separation.gap) : maths_max(gap, next_gap(separation.gap));
            h = hull_separation_for(pair, &now, &separation.plane, gap, last - time);
            normal = normal_after(&separation.plane, h);
        }
        if (!(time + h < last))
            return;
        time += h;
        now = relative_pose_at(pair, time);
    }
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Narrows [*from, *until] to the time in which the spheres around the bodies are near enough.
 * Returns false if there is none. */
static bool window(const struct swept_body *a, const struct swept_body *b, double *from,
                   double *until)
{
    struct vec3 s = hull_separation_at(&a->path, &b->path, *from);
    struct vec3 w = vec3_sub(b->path.along, a->path.along);
    double reach = a->bound_m + b->bound_m + SKIN_M + WINDOW_M;
    double ww = vec3_dot(w, w), sw = vec3_dot(s, w), over = vec3_dot(s, s) - reach * reach;
    double discriminant = sw * sw - ww * over;
    if (over > 0.0 && (sw >= 0.0 || discriminant < 0.0))
        return false;
    if (ww == 0.0)
        return true;
    double root = sqrt(maths_max(discriminant, 0.0));
    *until = maths_min(*until, *from + (root - sw) / ww);
    if (over > 0.0)
        *from += over / (root - sw);
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

/* Orders two bodies, so that the result does not depend on the order of the arguments. Bodies that
 * are equal in all of this do not move relative to each other. */
static int order_of_bodies(const struct swept_body *a, const struct swept_body *b)
{
    int order = order_of_points(a->path.at, b->path.at);
    if (order == 0)
        order = order_of_points(a->path.along, b->path.along);
    if (order == 0)
        order = order_of(a->path.since, b->path.since);
    if (order == 0)
        order = order_of_turns(a->from, b->from);
    if (order == 0)
        order = order_of_turns(a->to, b->to);
    if (order == 0 && a->turn && b->turn)
        order = free_turn_order(a->turn, b->turn);
    return order != 0 ? order : turret_path_order(&a->turret, &b->turret);
}

/* Returns how far points of a body are moved by its rotation at most within a time [m]. */
static double turned_m(const struct rotation_path *rotation, double time)
{
    return rotation->rate * time * rotation->body->bound_m;
}

/* Returns the pairs of hulls that boxes do not keep apart in all of [from, until]. The poses are
 * those at from. */
static uint64_t near_pairs(const struct rotation_path *a, const struct body_pose *pose_a,
                           const struct rotation_path *b, const struct body_pose *pose_b,
                           double from, double until)
{
    const struct path *path_a = &a->body->path, *path_b = &b->body->path;
    double time = until - from;
    struct vec3 between = hull_separation_at(path_a, path_b, from);
    struct vec3 way = vec3_scale(vec3_sub(path_b->along, path_a->along), time);
    struct box_view view = box_view_swept(&pose_a->turn, &pose_b->turn, between, way,
                                          SKIN_M + turned_m(a, time) + turned_m(b, time));
    return box_view_near(&view, a->body, b->body);
}

/* Finds the first contact of the hulls of two bodies in [from, until]. */
static void first_contact(const struct rotation_path *a, const struct rotation_path *b, double from,
                          double until, struct hull_contact *first)
{
    struct body_pose pose_a = body_pose_at(a, from), pose_b = body_pose_at(b, from);
    uint64_t near = near_pairs(a, &pose_a, b, &pose_b, from, until);
    for (; near != 0; near &= near - 1) {
        struct hull_pair pair = hull_pair_first(a, b, near);
        struct relative_pose now =
            relative_pose_of(&pose_a, pair.hull_a, &pose_b, pair.hull_b, from);
        time_of_impact(&pair, now, until, first);
    }
}

bool time_of_impact_find(const struct swept_body *a, const struct swept_body *b, double from,
                         struct hull_contact *impact)
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
    struct rotation_path rotation_a = rotation_path_of(a), rotation_b = rotation_path_of(b);
    if (rotation_a.rate == 0.0 && rotation_b.rate == 0.0 && !turret_path_moves(&a->turret) &&
        !turret_path_moves(&b->turret) && order_of_points(a->path.along, b->path.along) == 0)
        return false; /* at rest relative to each other */
    struct hull_contact first = {.toi = INFINITY};
    first_contact(&rotation_a, &rotation_b, from, until, &first);
    if (first.toi == INFINITY)
        return false;
    if (swap)
        first.normal = vec3_scale(first.normal, -1.0);
    *impact = first;
    return true;
}

bool time_of_impact_excluded(const struct swept_body *a, const struct swept_body *b, double from)
{
    struct rotation_path rotation_a = rotation_path_of(a), rotation_b = rotation_path_of(b);
    struct body_pose pose_a = body_pose_at(&rotation_a, from);
    struct body_pose pose_b = body_pose_at(&rotation_b, from);
    return near_pairs(&rotation_a, &pose_a, &rotation_b, &pose_b, from, 1.0) == 0;
}

/* Returns the least distance of the hulls' pairs at a time, or least_m if all are farther apart. */
static double least_gap(const struct swept_body *a, const struct swept_body *b, double time,
                        double least_m)
{
    struct rotation_path rotation_a = rotation_path_of(a), rotation_b = rotation_path_of(b);
    struct body_pose pose_a = body_pose_at(&rotation_a, time);
    struct body_pose pose_b = body_pose_at(&rotation_b, time);
    struct box_view view = box_view_of(&pose_a.turn, &pose_b.turn,
                                       hull_separation_at(&a->path, &b->path, time), least_m);
    for (uint64_t near = box_view_near(&view, a, b); near != 0; near &= near - 1) {
        struct hull_pair pair = hull_pair_first(&rotation_a, &rotation_b, near);
        struct relative_pose now =
            relative_pose_of(&pose_a, pair.hull_a, &pose_b, pair.hull_b, time);
        struct gjk_start start = {.guess = now.towards};
        if (now.centres_m - pair.radii_m < least_m)
            least_m =
                maths_min(least_m, gjk_distance_within(&now.a, &now.b, least_m, &start).distance_m);
    }
    return least_m;
}

double time_of_impact_gap(const struct swept_body *a, const struct swept_body *b, double time)
{
    return least_gap(a, b, time, INFINITY);
}

double time_of_impact_gap_up_to(const struct swept_body *a, const struct swept_body *b, double time,
                                double most_m)
{
    return least_gap(a, b, time, most_m + GJK_OVERLAP_M);
}

bool time_of_impact_within(const struct swept_body *a, const struct swept_body *b, double time,
                           double gap_m)
{
    return time_of_impact_gap_up_to(a, b, time, gap_m) <= gap_m;
}
