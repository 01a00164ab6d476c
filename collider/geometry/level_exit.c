/* The outlines of all pairs of hulls first, then for each edge what of it lies outside all of them.
 */
#include "collider/geometry/level_exit.h"

#include "collider/geometry/hull_separation.h"
#include "collider/geometry/level_gap.h"
#include "world/runtime/reserve.h"

#include <errno.h>

/* There is room for so many at first. */
#define PLANES_FIRST   1024u
#define OUTLINES_FIRST 1024u
#define EDGES_FIRST    16384u

/* So far is a way to lead from all hulls: what is between two that are nearer to each other than
 * twice of that is no place to stay in [m]. */
#define CLEAR_M 0.01

/* Hulls that are farther apart on the map are left out at first, if a body leaves one other [m]. */
#define REACH_M 0.5

/* A plane whose level part is smaller is level. */
#define UPRIGHT 1e-9

/* Edges whose unit normals have a smaller cross product are parallel. */
#define PARALLEL 1e-9

/* A place may lie so far within hulls by rounding [m]. */
#define ROUNDING_M 1e-9

/* --- outlines ----------------------------------------------------------------------------------*/

int level_exit_init(struct level_exit *search)
{
    *search = (struct level_exit){.plane_capacity = PLANES_FIRST,
                                  .outline_capacity = OUTLINES_FIRST,
                                  .edge_capacity = EDGES_FIRST};
    search->plane = reserve_take(PLANES_FIRST, sizeof *search->plane);
    search->corner = reserve_take(PLANES_FIRST, sizeof *search->corner);
    search->cut = reserve_take(PLANES_FIRST, sizeof *search->cut);
    search->outline = reserve_take(OUTLINES_FIRST, sizeof *search->outline);
    search->covered = reserve_take(OUTLINES_FIRST, sizeof *search->covered);
    search->edge = reserve_take(EDGES_FIRST, sizeof *search->edge);
    if (search->plane && search->corner && search->cut && search->outline && search->covered &&
        search->edge)
        return 0;
    level_exit_free(search);
    errno = ENOMEM;
    return -1;
}

void level_exit_free(struct level_exit *search)
{
    reserve_free(search->plane);
    reserve_free(search->corner);
    reserve_free(search->cut);
    reserve_free(search->outline);
    reserve_free(search->covered);
    reserve_free(search->edge);
    *search = (struct level_exit){0};
}

void level_exit_begin(struct level_exit *search, struct exit_slope slope)
{
    search->slope = slope;
    search->outlines = search->edges = 0;
}

/* Makes room for the planes and the outline of two hulls, and for the two edges of its shadow. */
static void make_room(struct level_exit *search, uint32_t faces)
{
    uint32_t planes = faces + 4; /* and the square that they cut, and a corner more for each */
    if (planes > search->plane_capacity) {
        uint64_t more = 2 * (uint64_t)planes;
        search->plane = reserve_grow(search->plane, 0, more, sizeof *search->plane);
        search->corner = reserve_grow(search->corner, 0, more, sizeof *search->corner);
        search->cut = reserve_grow(search->cut, 0, more, sizeof *search->cut);
        search->plane_capacity = more;
    }
    if (search->outlines == search->outline_capacity) {
        uint64_t more = 2 * (uint64_t)search->outlines;
        search->outline =
            reserve_grow(search->outline, search->outlines, more, sizeof *search->outline);
        search->covered = reserve_grow(search->covered, 0, more, sizeof *search->covered);
        search->outline_capacity = more;
    }
    uint64_t edges = (uint64_t)search->edges + 2 * (uint64_t)planes + 2;
    if (edges > search->edge_capacity) {
        search->edge = reserve_grow(search->edge, search->edges, 2 * edges, sizeof *search->edge);
        search->edge_capacity = 2 * edges;
    }
}

static double cross(double ax, double az, double bx, double bz)
{
    return ax * bz - az * bx;
}

/* Adds the line through the origin and a point as an edge of a shadow. */
static void add_tangent(struct level_exit *search, double normal_x, double normal_z)
{
    double length = sqrt(normal_x * normal_x + normal_z * normal_z);
    search->edge[search->edges++] =
        (struct exit_edge){.x = normal_x / length, .z = normal_z / length};
}

/* Adds the shadow of an outline that bars the way: all places to which a straight way leads through
 * it. The origin is not within it. */
static void add_shadow(struct level_exit *search, struct exit_outline *outline)
{
    double left_x = 0.0, left_z = 0.0, right_x = 0.0, right_z = 0.0;
    for (uint32_t i = outline->first; i < outline->end; i++) {
        const struct exit_edge edge = search->edge[i];
        for (int end = 0; end < 2; end++) {
            double along = end ? edge.to : edge.from;
            double x = edge.far_m * edge.x - along * edge.z;
            double z = edge.far_m * edge.z + along * edge.x;
            bool first = i == outline->first && end == 0;
            if (first || cross(left_x, left_z, x, z) > 0.0)
                left_x = x, left_z = z;
            if (first || cross(right_x, right_z, x, z) < 0.0)
                right_x = x, right_z = z;
        }
        if (edge.far_m <= 0.0)
            search->edge[search->edges++] = edge;
    }
    if (search->edges > outline->end) { /* else the origin is within it, and no way leads out */
        add_tangent(search, right_z, -right_x);
        add_tangent(search, -left_z, left_x);
    }
}

/* The faces of two hulls, as lines in search->plane. */
struct faces {
    uint32_t count;
    double clear_m;
    bool meet;     /* none separates them wherever they are moved */
    bool overlaps; /* none separates them */
};

/* Cuts off the part of a polygon that is beyond a line. Returns how many corners are left; the
 * corners are then in search->cut, and the old ones in search->corner, if any is beyond it. */
static uint32_t cut_off(struct level_exit *search, uint32_t count, uint32_t line)
{
    const struct exit_edge *side = &search->plane[line];
    struct exit_corner *corner = search->corner;
    uint32_t left = 0;
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        corner[i].beyond_m = corner[i].x * side->x + corner[i].z * side->z - side->far_m;
        any |= corner[i].beyond_m > 0.0;
    }
    if (!any)
        return count;
    for (uint32_t i = 0; i < count; i++) {
        const struct exit_corner *one = &corner[i], *next = &corner[i + 1 < count ? i + 1 : 0];
        bool beyond = one->beyond_m > 0.0;
        if (!beyond)
            search->cut[left++] = *one;
        if (beyond == (next->beyond_m > 0.0))
            continue;
        double share = one->beyond_m / (one->beyond_m - next->beyond_m);
        search->cut[left++] = (struct exit_corner){one->x + share * (next->x - one->x),
                                                   one->z + share * (next->z - one->z), 0.0,
                                                   beyond ? one->line : line};
    }
    search->corner = search->cut;
    search->cut = corner;
    return left;
}

/* Finds the corners of the outline that all faces leave, of which none is farther away than reach_m
 * along an axis of the map. Returns their number. */
static uint32_t find_corners(struct level_exit *search, uint32_t faces, double reach_m)
{
    static const double x[] = {1.0, 0.0, -1.0, 0.0}, z[] = {0.0, 1.0, 0.0, -1.0};
    uint32_t count = 4;
    for (uint32_t i = 0; i < 4; i++) {
        search->plane[faces + i] = (struct exit_edge){.x = x[i], .z = z[i], .far_m = reach_m};
        search->corner[i] =
            (struct exit_corner){reach_m * (x[i] + z[i]), reach_m * (z[i] - x[i]), 0.0, faces + i};
    }
    for (uint32_t i = 0; i < faces && count > 0; i++)
        count = cut_off(search, count, i);
    return count;
}

/* Adds the outline that the faces leave, unless it is empty. */
static void add_outline(struct level_exit *search, const struct faces *faces, double reach_m,
                        bool bars)
{
    struct exit_outline outline = {
        .first = search->edges, .bars = bars, .overlaps = faces->overlaps};
    uint32_t count = find_corners(search, faces->count, reach_m);
    for (uint32_t i = 0; i < count; i++) {
        const struct exit_corner *one = &search->corner[i];
        const struct exit_corner *next = &search->corner[i + 1 < count ? i + 1 : 0];
        struct exit_edge edge = search->plane[one->line];
        edge.from = one->z * edge.x - one->x * edge.z;
        edge.to = next->z * edge.x - next->x * edge.z;
        search->edge[search->edges++] = edge;
    }
    outline.end = outline.shadow_end = search->edges;
    if (count == 0)
        return;
    if (bars) {
        add_shadow(search, &outline);
        outline.shadow_end = search->edges;
    }
    search->outline[search->outlines++] = outline;
}

/* Takes a face with a normal from the body to the other. */
static void take_face(struct level_exit *search, struct faces *faces, struct vec3 normal,
                      double separation_m)
{
    double x = normal.x + normal.y * search->slope.east;
    double z = normal.z + normal.y * search->slope.south;
    double level = sqrt(x * x + z * z);
    faces->overlaps &= separation_m < 0.0;
    if (level < UPRIGHT)
        faces->meet &= separation_m < 0.0;
    else
        search->plane[faces->count++] = (struct exit_edge){
            .x = x / level, .z = z / level, .far_m = faces->clear_m - separation_m / level};
}

/* Adds the outline of two hulls, unless they pass above each other. */
static void add_hulls(struct level_exit *search, const struct relative_pose *now,
                      const struct swept_body *body, const struct hull *hull_a,
                      const struct swept_body *other, const struct hull *hull_b, double radii_m,
                      bool bars)
{
    const struct hull_plane *a = body->planes + hull_a->first_plane;
    const struct hull_plane *b = other->planes + hull_b->first_plane;
    const struct vec3 up = {-search->slope.east, 1.0, -search->slope.south};
    if (hull_separation_now(now, up) >= 0.0 ||
        hull_separation_now(now, vec3_scale(up, -1.0)) >= 0.0)
        return;
    make_room(search, hull_a->plane_count + hull_b->plane_count);
    struct faces faces = {.clear_m = bars ? 0.0 : CLEAR_M, .meet = true, .overlaps = true};
    for (uint32_t i = 0; i < hull_a->plane_count; i++) {
        struct vec3 normal = rotation_apply(&now->a.turn, a[i].normal), to;
        gjk_support(&now->b, vec3_scale(normal, -1.0), &to);
        double far = vec3_dot(normal, vec3_add(now->between, to));
        take_face(search, &faces, normal, far - a[i].offset_m * now->a.scale);
    }
    for (uint32_t i = 0; i < hull_b->plane_count; i++) {
        struct vec3 normal = vec3_scale(rotation_apply(&now->b.turn, b[i].normal), -1.0), to;
        gjk_support(&now->a, normal, &to);
        double far = vec3_dot(normal, vec3_sub(now->between, to));
        take_face(search, &faces, normal, far - b[i].offset_m * now->b.scale);
    }
    if (faces.meet)
        add_outline(search, &faces, now->centres_m + radii_m + CLEAR_M, bars);
}

/* Returns true if two hulls are farther apart on the map than a way leads. */
static bool out_of_reach(const struct relative_pose *now, double radii_m, double reach_m)
{
    double x = now->towards.x * now->centres_m, z = now->towards.z * now->centres_m;
    return sqrt(x * x + z * z) - radii_m > reach_m + CLEAR_M;
}

/* Adds the hulls of another body that a way of this length can reach, but one of length had_m
 * cannot. */
static void add_body(struct level_exit *search, const struct swept_body *body,
                     const struct swept_body *other, bool bars, double had_m, double reach_m)
{
    const struct rotation_path turn_a = rotation_path_of(body), turn_b = rotation_path_of(other);
    const struct body_pose pose_a = body_pose_at(&turn_a, body->path.since);
    const struct body_pose pose_b = body_pose_at(&turn_b, other->path.since);
    double time = maths_max(body->path.since, other->path.since);
    for (uint32_t i = 0; i < body->hull_count; i++) {
        for (uint32_t j = 0; j < other->hull_count; j++) {
            const struct hull *hull_a = &body->hull[i], *hull_b = &other->hull[j];
            const struct relative_pose now =
                relative_pose_of(&pose_a, hull_a, &pose_b, hull_b, time);
            double radii_m = hull_a->radius_m * body->scale + hull_b->radius_m * other->scale;
            if (out_of_reach(&now, radii_m, had_m) && !out_of_reach(&now, radii_m, reach_m))
                add_hulls(search, &now, body, hull_a, other, hull_b, radii_m, bars);
        }
    }
}

void level_exit_add(struct level_exit *search, const struct swept_body *body,
                    const struct swept_body *other, bool bars)
{
    add_body(search, body, other, bars, -INFINITY, INFINITY);
}

/* --- ways --------------------------------------------------------------------------------------*/

/* Returns what an outline covers of the line of an edge: the hulls overlap there, or the way there
 * leads through them. If that is nothing, from is above to. */
static struct exit_interval covered_by(const struct level_exit *search,
                                       const struct exit_outline *outline, bool bars,
                                       const struct exit_edge *edge)
{
    bool shadow = bars && outline->bars;
    uint32_t first = shadow ? outline->end : outline->first;
    uint32_t end = shadow ? outline->shadow_end : outline->end;
    struct exit_interval covered = {-INFINITY, INFINITY};
    for (uint32_t i = first; i < end; i++) {
        const struct exit_edge *side = &search->edge[i];
        double rate = side->z * edge->x - side->x * edge->z;
        double room = side->far_m - edge->far_m * (side->x * edge->x + side->z * edge->z);
        if (fabs(rate) < PARALLEL) {
            if (room < ROUNDING_M)
                return (struct exit_interval){INFINITY, -INFINITY};
        } else if (rate > 0.0) {
            covered.to = maths_min(covered.to, room / rate);
        } else {
            covered.from = maths_max(covered.from, room / rate);
        }
        if (covered.to - covered.from <= 2.0 * ROUNDING_M)
            return (struct exit_interval){INFINITY, -INFINITY};
    }
    return covered;
}

/* Moves a place on an edge out of all intervals: forwards, or backwards, at most once out of each.
 */
static double out_of_all(const struct exit_interval *covered, uint32_t count, double at,
                         bool forwards)
{
    bool any = true;
    while (any) {
        any = false;
        for (uint32_t i = 0; i < count; i++) {
            if (covered[i].from >= at - ROUNDING_M || covered[i].to <= at + ROUNDING_M)
                continue;
            at = forwards ? covered[i].to : covered[i].from;
            any = true;
        }
    }
    return at;
}

/* The shortest way that has been found. */
struct best_way {
    double length_m;
    double x, z; /* against the motion */
};

/* Tries the way to a place on an edge. */
static void try_way(const struct exit_edge *edge, double at, struct best_way *best)
{
    double far = sqrt(edge->far_m * edge->far_m + at * at);
    if (at < edge->from - ROUNDING_M || at > edge->to + ROUNDING_M || far <= 0.0 ||
        far >= best->length_m)
        return;
    *best = (struct best_way){far, (edge->far_m * edge->x - at * edge->z) / far,
                              (edge->far_m * edge->z + at * edge->x) / far};
}

/* Tries the ways to the places of an edge that are nearest, on both sides, and outside all
 * outlines. */
static void try_edge(const struct level_exit *search, bool bars, uint32_t index,
                     struct best_way *best)
{
    const struct exit_edge *edge = &search->edge[index];
    double nearest = maths_clamp(0.0, edge->from, edge->to), reach = best->length_m;
    double half = reach < INFINITY ? sqrt(reach * reach - edge->far_m * edge->far_m) : INFINITY;
    uint32_t count = 0;
    for (uint32_t i = 0; i < search->outlines; i++) {
        const struct exit_interval covered = covered_by(search, &search->outline[i], bars, edge);
        if (covered.from > covered.to)
            continue;
        if (covered.from < maths_max(edge->from, -half) - ROUNDING_M &&
            covered.to > maths_min(edge->to, half) + ROUNDING_M)
            return;
        search->covered[count++] = covered;
    }
    try_way(edge, out_of_all(search->covered, count, nearest, true), best);
    try_way(edge, out_of_all(search->covered, count, nearest, false), best);
}

double level_exit_find(struct level_exit *search, bool bars, struct vec3 *normal)
{
    struct best_way best = {.length_m = INFINITY};
    bool overlaps = false;
    for (uint32_t h = 0; h < search->outlines; h++)
        overlaps |= search->outline[h].overlaps && !search->outline[h].bars;
    if (!overlaps)
        return INFINITY;
    for (uint32_t h = 0; h < search->outlines; h++) {
        const struct exit_outline *outline = &search->outline[h];
        for (uint32_t i = outline->first; !outline->bars && i < outline->end; i++) {
            const struct exit_edge *edge = &search->edge[i];
            double nearest = maths_clamp(0.0, edge->from, edge->to);
            double square = edge->far_m * edge->far_m + nearest * nearest;
            if (square < best.length_m * best.length_m)
                try_edge(search, bars, i, &best);
        }
    }
    if (best.length_m < INFINITY)
        *normal = (struct vec3){best.x, 0.0, best.z};
    return best.length_m;
}

double level_exit_of(struct level_exit *search, struct exit_slope slope,
                     const struct swept_body *body, const struct swept_body *other,
                     struct vec3 *normal)
{
    double had_m = -INFINITY, reach_m = REACH_M;
    level_exit_begin(search, slope);
    for (;;) {
        add_body(search, body, other, false, had_m, reach_m);
        double way_m = level_exit_find(search, false, normal);
        if (way_m <= reach_m || way_m == INFINITY)
            return way_m;
        had_m = reach_m;
        reach_m = way_m;
    }
}
