/* Distances by GJK; overlaps by the separating axes that are horizontal. */
#include "collider/geometry/level_gap.h"

#include "collider/geometry/box_view.h"
#include "collider/geometry/contact_manifold.h"
#include "collider/geometry/hull_separation.h"

#include <stddef.h>

/* A shorter contact is treated as a point [m]. */
#define EDGE_LEAST_M 0.01

/* The two bodies at one time. */
struct body_pair {
    const struct swept_body *a, *b;
    struct rotation_path turn_a, turn_b;
    struct mat3 pose_a, pose_b;
    struct vec3 between; /* [m] from a's position to b's */
    double time;
    struct vec3 line; /* unit, horizontal: from a's position to b's */
};

/* --- directions --------------------------------------------------------------------------------*/

/* Makes the direction horizontal and returns its horizontal part, 0 if it is too steep. */
static double level(struct vec3 *direction)
{
    double length = sqrt(direction->x * direction->x + direction->z * direction->z);
    if (length < LEVEL_MIN)
        return 0.0;
    *direction = (struct vec3){direction->x / length, 0.0, direction->z / length};
    return length;
}

static struct vec3 line_of(struct vec3 between)
{
    double length = sqrt(between.x * between.x + between.z * between.z);
    return length > 0.0 ? (struct vec3){between.x / length, 0.0, between.z / length}
                        : (struct vec3){1.0, 0.0, 0.0};
}

/* --- overlaps ----------------------------------------------------------------------------------*/

static void shallower(const struct relative_pose *now, struct vec3 normal, struct level_gap *gap)
{
    double depth = hull_separation_now(now, normal);
    if (depth > gap->gap_m) {
        gap->gap_m = depth;
        gap->normal = normal;
    }
}

static void faces(const struct relative_pose *now, const struct mat3 *turn,
                  const struct hull_plane *plane, uint32_t count, double side,
                  struct level_gap *gap)
{
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 normal = vec3_scale(rotation_apply(turn, plane[i].normal), side);
        if (level(&normal) > 0.0)
            shallower(now, normal, gap);
    }
}

static void measure_overlap(const struct body_pair *bodies, const struct hull_pair *pair,
                            const struct relative_pose *now, struct level_gap *gap)
{
    gap->gap_m = -INFINITY;
    faces(now, &now->a.turn, bodies->a->planes + pair->hull_a->first_plane,
          pair->hull_a->plane_count, 1.0, gap);
    faces(now, &now->b.turn, bodies->b->planes + pair->hull_b->first_plane,
          pair->hull_b->plane_count, -1.0, gap);
    shallower(now, bodies->line, gap);
}

/* --- one pair of hulls -------------------------------------------------------------------------*/

/* The ends of the contact, across the normal; without a manifold the point midway. */
static void find_points(const struct body_pair *bodies, const struct relative_pose *now,
                        struct vec3 normal, struct vec3 middle, struct level_gap *gap)
{
    struct contact_manifold patch;
    struct vec3 at = path_at(&bodies->a->path, bodies->time), low = middle, high = middle;
    double least = 0.0, most = 0.0;
    if (contact_manifold_between(&now->a, &now->b, normal, &patch)) {
        least = INFINITY, most = -INFINITY;
        for (uint32_t i = 0; i < patch.count; i++) {
            double across = patch.corner[i].z * gap->normal.x - patch.corner[i].x * gap->normal.z;
            if (across < least)
                least = across, low = patch.corner[i];
            if (across > most)
                most = across, high = patch.corner[i];
        }
        middle = patch.middle;
    }
    gap->points = most - least > EDGE_LEAST_M ? 2 : 1;
    gap->point[0] = vec3_add(at, gap->points == 2 ? low : middle);
    gap->point[1] = vec3_add(at, high);
}

/* Returns false if the hulls are farther apart than the margin. */
static bool measure(const struct body_pair *bodies, const struct hull_pair *pair, double margin_m,
                    bool points, struct level_gap *gap)
{
    struct relative_pose now = relative_pose_at(pair, bodies->time);
    if (now.centres_m - pair->radii_m > margin_m)
        return false;
    struct gjk_start start = {.guess = now.towards};
    struct gjk gjk = gjk_distance_within(&now.a, &now.b, margin_m, &start);
    struct vec3 normal = gjk.normal;
    if (gjk.distance_m > margin_m)
        return false;
    if (gjk.distance_m > 0.0) {
        gap->normal = gjk.normal;
        double share = level(&gap->normal);
        if (share == 0.0)
            gap->normal = bodies->line;
        gap->gap_m = gjk.distance_m / maths_max(share, LEVEL_MIN);
    } else {
        measure_overlap(bodies, pair, &now, gap);
        normal = gap->normal;
    }
    if (points)
        find_points(bodies, &now, normal, vec3_lerp(gjk.on_a, gjk.on_b, 0.5), gap);
    return true;
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Puts a gap into its place in the list; of too many the largest is left out. */
static uint32_t keep(struct level_gap *list, uint32_t count, const struct level_gap *gap)
{
    uint32_t place = count < LEVEL_GAPS_MAX ? count : LEVEL_GAPS_MAX;
    for (; place > 0 && list[place - 1].gap_m > gap->gap_m; place--) {
        if (place < LEVEL_GAPS_MAX)
            list[place] = list[place - 1];
    }
    if (place < LEVEL_GAPS_MAX)
        list[place] = *gap;
    return count < LEVEL_GAPS_MAX ? count + 1 : count;
}

static struct mat3 pose_at(const struct swept_body *body, double time)
{
    double left = 1.0 - body->path.since;
    double t = left > 0.0 ? maths_clamp((time - body->path.since) / left, 0.0, 1.0) : 0.0;
    struct quat turned;
    struct vec3 spin;
    if (body->turn && body->turn->rotation.steps > 0) {
        free_turn_at(body->turn, t, &turned, &spin);
        return rotation_matrix(turned);
    }
    return rotation_matrix(rotation_between(body->from, body->to, t));
}

static struct body_pair body_pair_of(const struct swept_body *a, const struct swept_body *b,
                                     double time)
{
    struct vec3 between = hull_separation_at(&a->path, &b->path, time);
    return (struct body_pair){.a = a,
                              .b = b,
                              .pose_a = pose_at(a, time),
                              .pose_b = pose_at(b, time),
                              .between = between,
                              .time = time,
                              .line = line_of(between)};
}

/* Measures each pair of hulls that may be as near as *margin_m. Puts the gaps into the list and
 * returns how many it holds. list NULL: reduces *margin_m to the least gap instead. Hulls that
 * overlap are all measured, because the deepest overlap is found only by its own normals. */
static uint32_t search(struct body_pair *bodies, double *margin_m, struct level_gap *list)
{
    const struct swept_body *a = bodies->a, *b = bodies->b;
    struct box_view view =
        box_view_of(&bodies->pose_a, &bodies->pose_b, bodies->between, maths_max(*margin_m, 0.0));
    uint32_t count = 0;
    if (box_view_apart(&view, a, a->outer, b, b->outer))
        return 0;
    uint64_t near = box_view_near(&view, a, b);
    if (near == 0)
        return 0;
    bodies->turn_a = rotation_path_of(a);
    bodies->turn_b = rotation_path_of(b);
    for (; near != 0; near &= near - 1) {
        struct level_gap one;
        struct hull_pair pair = hull_pair_first(&bodies->turn_a, &bodies->turn_b, near);
        if (!measure(bodies, &pair, maths_max(*margin_m, 0.0), list != NULL, &one))
            continue;
        if (list)
            count = keep(list, count, &one);
        else
            *margin_m = maths_min(*margin_m, one.gap_m);
    }
    return count;
}

uint32_t level_gap_find(const struct swept_body *a, const struct swept_body *b, double time,
                        double margin_m, struct level_gap *gap)
{
    struct body_pair bodies = body_pair_of(a, b, time);
    return search(&bodies, &margin_m, gap);
}

double level_gap_least(const struct swept_body *a, const struct swept_body *b, double time,
                       double margin_m)
{
    struct body_pair bodies = body_pair_of(a, b, time);
    search(&bodies, &margin_m, NULL);
    return margin_m;
}
