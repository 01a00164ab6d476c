/* The nearest parts of two hulls across the normal of their nearest points, as far as they are
 * opposite each other. */
#include "collider/resting/free_points.h"

#include "collider/geometry/box_view.h"
#include "collider/geometry/contact_manifold.h"
#include "collider/geometry/hull_separation.h"
#include "world/world.h"

#define SLACK_M   0.05 /* parts of a hull so far behind its foremost vertex may bear a load, too */
#define INWARDS_M 5e-3
#define CORNERS   8u   /* of a contact of two hulls at most */
#define FACING    1e-3 /* the least cosine between a face's normal and the contact's */
#define STEEPEST  0.3  /* the ground's normal is at least so much upwards */

/* Adds a point, or replaces the one with the greatest gap. */
static void add(struct free_point *point, uint32_t *count, const struct free_point *found)
{
    uint32_t widest = 0;
    if (*count < FREE_POINTS_MAX) {
        point[(*count)++] = *found;
        return;
    }
    for (uint32_t i = 1; i < *count; i++) {
        if (point[i].gap_m > point[widest].gap_m)
            widest = i;
    }
    if (found->gap_m < point[widest].gap_m)
        point[widest] = *found;
}

/* --- two hulls ---------------------------------------------------------------------------------*/

struct hulls {
    struct relative_pose now;
    const struct hull_plane *planes_a, *planes_b;
    uint32_t count_a, count_b;
};

static void shallower(const struct relative_pose *now, struct vec3 along, struct vec3 *normal,
                      double *gap_m)
{
    double gap = hull_separation_now(now, along);
    if (gap > *gap_m) {
        *gap_m = gap;
        *normal = along;
    }
}

/* Finds the face along whose normal two hulls overlap least. */
static double overlap_of(const struct hulls *hulls, struct vec3 *normal)
{
    const struct relative_pose *now = &hulls->now;
    double gap = -INFINITY;
    for (uint32_t i = 0; i < hulls->count_a; i++)
        shallower(now, rotation_apply(&now->a.turn, hulls->planes_a[i].normal), normal, &gap);
    for (uint32_t i = 0; i < hulls->count_b; i++)
        shallower(now, vec3_scale(rotation_apply(&now->b.turn, hulls->planes_b[i].normal), -1.0),
                  normal, &gap);
    shallower(now, now->towards, normal, &gap);
    return gap;
}

/* Returns how far the surface of a hull is from a point along a unit direction [m]. */
static double surface(const struct convex *hull, const struct hull_plane *planes, uint32_t count,
                      struct vec3 from, struct vec3 direction)
{
    struct vec3 p = rotation_back(&hull->turn, vec3_sub(from, hull->at));
    struct vec3 d = rotation_back(&hull->turn, direction);
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        double faces = vec3_dot(planes[i].normal, d);
        double inside = planes[i].offset_m * hull->scale - vec3_dot(planes[i].normal, p);
        if (faces > FACING)
            least = maths_min(least, inside / faces);
    }
    return least;
}

/* Returns the gap of two hulls along the normal at a point between them [m]. */
static double gap_at(const struct hulls *hulls, struct vec3 at, struct vec3 normal)
{
    struct vec3 back = vec3_scale(normal, -1.0);
    double a = surface(&hulls->now.a, hulls->planes_a, hulls->count_a, at, normal);
    double b = surface(&hulls->now.b, hulls->planes_b, hulls->count_b, at, back);
    return -a - b;
}

/* Returns a corner a little nearer to the middle of the contact: beside a hull its surface has no
 * gap. */
static struct vec3 inwards(struct vec3 corner, struct vec3 middle)
{
    struct vec3 way = vec3_sub(middle, corner);
    double length = vec3_length(way);
    return length > INWARDS_M ? vec3_add(corner, vec3_scale(way, INWARDS_M / length)) : middle;
}

/* Adds the nearest points of two hulls, and the corners of their contact. origin: of the hulls'
 * coordinates [m, world]. */
static void add_corners(const struct hulls *hulls, const struct free_point *middle,
                        struct vec3 origin, double margin_m, struct free_point *point,
                        uint32_t *count)
{
    struct contact_manifold patch;
    struct free_point found = *middle;
    const struct relative_pose *now = &hulls->now;
    found.at = vec3_add(origin, middle->at);
    add(point, count, &found);
    if (!contact_manifold_within(&now->a, &now->b, middle->normal, SLACK_M, &patch))
        return;
    uint32_t step = (patch.count + CORNERS - 1) / CORNERS;
    for (uint32_t i = 0; i < patch.count; i += step) {
        struct vec3 corner = inwards(patch.corner[i], patch.middle);
        found.gap_m = maths_max(middle->gap_m, gap_at(hulls, corner, middle->normal));
        found.at = vec3_add(origin, corner);
        if (found.gap_m <= margin_m)
            add(point, count, &found);
    }
}

static void add_hulls(const struct hulls *hulls, struct vec3 origin, double margin_m,
                      struct free_point *point, uint32_t *count)
{
    const struct relative_pose *now = &hulls->now;
    struct gjk_start start = {.guess = now->towards};
    struct gjk gjk = gjk_distance_within(&now->a, &now->b, margin_m, &start);
    struct free_point middle = {
        .at = vec3_lerp(gjk.on_a, gjk.on_b, 0.5), .normal = gjk.normal, .gap_m = gjk.distance_m};
    if (gjk.distance_m > margin_m)
        return;
    if (gjk.distance_m == 0.0)
        middle.gap_m = overlap_of(hulls, &middle.normal);
    add_corners(hulls, &middle, origin, margin_m, point, count);
}

uint32_t free_points_find(const struct swept_body *a, const struct swept_body *b, double margin_m,
                          struct free_point point[FREE_POINTS_MAX])
{
    struct rotation_path rotation_a = rotation_path_of(a), rotation_b = rotation_path_of(b);
    struct body_pose pose_a = body_pose_at(&rotation_a, 0.0);
    struct body_pose pose_b = body_pose_at(&rotation_b, 0.0);
    struct box_view view = box_view_of(&pose_a.turn, &pose_b.turn,
                                       hull_separation_at(&a->path, &b->path, 0.0), margin_m);
    struct vec3 origin = path_at(&a->path, 0.0);
    uint32_t count = 0;
    for (uint64_t near = box_view_near(&view, a, b); near != 0; near &= near - 1) {
        struct hull_pair pair = hull_pair_first(&rotation_a, &rotation_b, near);
        struct hulls hulls = {.now =
                                  relative_pose_of(&pose_a, pair.hull_a, &pose_b, pair.hull_b, 0.0),
                              .planes_a = a->planes + pair.hull_a->first_plane,
                              .planes_b = b->planes + pair.hull_b->first_plane,
                              .count_a = pair.hull_a->plane_count,
                              .count_b = pair.hull_b->plane_count};
        if (hulls.now.centres_m - pair.radii_m <= margin_m)
            add_hulls(&hulls, origin, margin_m, point, &count);
    }
    return count;
}

/* --- the ground --------------------------------------------------------------------------------*/

uint32_t free_points_on_ground(const struct world *world, const struct crater_index *craters,
                               const struct body_points *points, struct vec3 at, struct quat turn,
                               double margin_m, struct free_point point[FREE_POINTS_MAX])
{
    struct mat3 axes = rotation_matrix(turn);
    uint32_t count = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        struct vec3 p = vec3_add(at, rotation_apply(&axes, points->point[i]));
        double over = p.y - terrain_height(&world->terrain, craters, p.x, p.z);
        if (over * STEEPEST > margin_m)
            continue;
        struct vec3 normal = terrain_normal(&world->terrain, craters, p.x, p.z);
        const struct free_point found = {
            .at = p, .normal = normal, .gap_m = over * maths_max(normal.y, STEEPEST)};
        if (found.gap_m <= margin_m)
            add(point, &count, &found);
    }
    return count;
}
