/* Planes of all pairs of hulls first, then intervals along their normals, and to the corners in
 * which the outlines of two pairs of hulls meet. */
#include "collider/geometry/level_exit.h"

#include "collider/geometry/hull_separation.h"
#include "collider/geometry/level_gap.h"
#include "world/runtime/reserve.h"

#include <errno.h>

/* There is room for so many at first. */
#define PLANES_FIRST 65536u
#define HULLS_FIRST  1024u
#define EDGES_FIRST  1024u

/* So far is a way to lead from all hulls: what is between two that are nearer to each other than
 * twice of that is no place to stay in [m]. */
#define CLEAR_M 0.01

/* Hulls that are farther apart on the map are left out at first, if a body leaves one other [m]. */
#define REACH_M 0.5

/* Directions that differ less are the same [square of the difference of unit vectors]. */
#define SAME 1e-18

/* Edges whose unit normals have a smaller cross product are parallel. */
#define PARALLEL 1e-9

/* A corner may lie so far beyond the ends of its edges, and within other hulls, by rounding [m]. */
#define ROUNDING_M 1e-9

/* So many directions are remembered, so that none of them is tried twice. */
#define TRIED_MAX 64u

/* --- planes ------------------------------------------------------------------------------------*/

int level_exit_init(struct level_exit *search)
{
    *search = (struct level_exit){.plane_capacity = PLANES_FIRST,
                                  .hulls_capacity = HULLS_FIRST,
                                  .edge_capacity = EDGES_FIRST};
    search->plane = reserve_take(PLANES_FIRST, sizeof *search->plane);
    search->hulls = reserve_take(HULLS_FIRST, sizeof *search->hulls);
    search->edge = reserve_take(EDGES_FIRST, sizeof *search->edge);
    if (search->plane && search->hulls && search->edge)
        return 0;
    level_exit_free(search);
    errno = ENOMEM;
    return -1;
}

void level_exit_free(struct level_exit *search)
{
    reserve_free(search->plane);
    reserve_free(search->hulls);
    reserve_free(search->edge);
    *search = (struct level_exit){0};
}

void level_exit_begin(struct level_exit *search)
{
    search->planes = search->hulls_count = 0;
}

/* Adds a plane with a normal from the body to the other. Returns false if it separates the hulls.
 */
static bool add_plane(struct level_exit *search, struct vec3 normal, double separation,
                      double clear_m)
{
    double level = sqrt(normal.x * normal.x + normal.z * normal.z);
    search->plane[search->planes++] =
        (struct exit_plane){normal.x, normal.z, separation - clear_m * level};
    return separation < 0.0;
}

static void make_room(struct level_exit *search, uint32_t planes)
{
    if (search->planes + planes > search->plane_capacity) {
        uint64_t more = 2 * (uint64_t)(search->planes + planes);
        search->plane = reserve_grow(search->plane, search->planes, more, sizeof *search->plane);
        search->plane_capacity = more;
    }
    if (search->hulls_count == search->hulls_capacity) {
        uint64_t more = 2 * (uint64_t)search->hulls_count;
        search->hulls =
            reserve_grow(search->hulls, search->hulls_count, more, sizeof *search->hulls);
        search->hulls_capacity = more;
    }
}

/* Adds the planes of two hulls, unless they pass above each other. */
static void add_hulls(struct level_exit *search, const struct relative_pose *now,
                      const struct swept_body *body, const struct hull *hull_a,
                      const struct swept_body *other, const struct hull *hull_b, bool bars)
{
    const struct hull_plane *a = body->planes + hull_a->first_plane;
    const struct hull_plane *b = other->planes + hull_b->first_plane;
    struct exit_hulls hulls = {.overlaps = true, .bars = bars};
    double clear = bars ? 0.0 : CLEAR_M;
    if (hull_separation_now(now, (struct vec3){0.0, 1.0, 0.0}) >= 0.0 ||
        hull_separation_now(now, (struct vec3){0.0, -1.0, 0.0}) >= 0.0)
        return;
    make_room(search, hull_a->plane_count + hull_b->plane_count);
    hulls.first = search->planes;
    for (uint32_t i = 0; i < hull_a->plane_count; i++) {
        struct vec3 normal = rotation_apply(&now->a.turn, a[i].normal), to;
        gjk_support(&now->b, vec3_scale(normal, -1.0), &to);
        double far = vec3_dot(normal, vec3_add(now->between, to));
        hulls.overlaps &= add_plane(search, normal, far - a[i].offset_m * now->a.scale, clear);
    }
    for (uint32_t i = 0; i < hull_b->plane_count; i++) {
        struct vec3 normal = vec3_scale(rotation_apply(&now->b.turn, b[i].normal), -1.0), to;
        gjk_support(&now->a, normal, &to);
        double far = vec3_dot(normal, vec3_sub(now->between, to));
        hulls.overlaps &= add_plane(search, normal, far - b[i].offset_m * now->b.scale, clear);
    }
    hulls.end = search->planes;
    search->hulls[search->hulls_count++] = hulls;
}

/* Returns true if two hulls are farther apart on the map than a way leads. */
static bool out_of_reach(const struct relative_pose *now, double radii_m, double reach_m)
{
    double x = now->towards.x * now->centres_m, z = now->towards.z * now->centres_m;
    return sqrt(x * x + z * z) - radii_m > reach_m + CLEAR_M;
}

/* Adds the hulls of another body that a way of this length can reach. */
static void add_body(struct level_exit *search, const struct swept_body *body,
                     const struct swept_body *other, bool bars, double reach_m)
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
            if (!out_of_reach(&now, radii_m, reach_m))
                add_hulls(search, &now, body, hull_a, other, hull_b, bars);
        }
    }
}

void level_exit_add(struct level_exit *search, const struct swept_body *body,
                    const struct swept_body *other, bool bars)
{
    add_body(search, body, other, bars, INFINITY);
}

/* --- ways --------------------------------------------------------------------------------------*/

/* The lengths of the way at which two hulls overlap [m]. Without any, from is above to. */
struct interval {
    double from, to;
};

/* normal: against the motion. */
static struct interval overlap_along(const struct level_exit *search,
                                     const struct exit_hulls *hulls, double normal_x,
                                     double normal_z)
{
    struct interval along = {-INFINITY, INFINITY};
    for (uint32_t i = hulls->first; i < hulls->end && along.from <= along.to; i++) {
        const struct exit_plane *plane = &search->plane[i];
        double rate = plane->x * normal_x + plane->z * normal_z;
        if (rate > 0.0)
            along.to = maths_min(along.to, -plane->separation_m / rate);
        else if (rate < 0.0)
            along.from = maths_max(along.from, -plane->separation_m / rate);
        else if (plane->separation_m >= 0.0)
            along.to = -INFINITY;
    }
    return along;
}

/* Returns the length of the way against the normal, or INFINITY if it is not below best_m. */
static double way_along(const struct level_exit *search, bool bars, double normal_x,
                        double normal_z, double best_m)
{
    double end = 0.0;
    bool longer = true;
    while (longer) {
        longer = false;
        for (uint32_t i = 0; i < search->hulls_count; i++) {
            const struct exit_hulls *hulls = &search->hulls[i];
            const struct interval along = overlap_along(search, hulls, normal_x, normal_z);
            if (along.from > along.to || along.to <= end || along.from > end)
                continue;
            if (along.to >= best_m || (bars && hulls->bars))
                return INFINITY;
            end = along.to;
            longer = true;
        }
    }
    return end;
}

/* The directions that have been tried. */
struct tried {
    double x[TRIED_MAX], z[TRIED_MAX];
    uint32_t count;
};

static bool is_new(struct tried *tried, double x, double z)
{
    for (uint32_t i = 0; i < tried->count; i++) {
        double dx = tried->x[i] - x, dz = tried->z[i] - z;
        if (dx * dx + dz * dz < SAME)
            return false;
    }
    if (tried->count < TRIED_MAX) {
        tried->x[tried->count] = x;
        tried->z[tried->count++] = z;
    }
    return true;
}

/* The shortest way that has been found. */
struct best_way {
    double length_m;
    double x, z; /* against the motion */
};

static void try_way(const struct level_exit *search, bool bars, double x, double z,
                    struct best_way *best)
{
    double way = way_along(search, bars, x, z, best->length_m);
    if (way < best->length_m)
        *best = (struct best_way){way, x, z};
}

/* Tries the ways across the faces of all hulls that are to be left. Those of hulls that do not
 * overlap yet count, too: the way out of one hull may lead into another, and out of that at its
 * face. */
static void try_faces(const struct level_exit *search, bool bars, struct best_way *best)
{
    struct tried tried = {.count = 0};
    for (uint32_t h = 0; h < search->hulls_count; h++) {
        const struct exit_hulls *hulls = &search->hulls[h];
        for (uint32_t i = hulls->first; !hulls->bars && i < hulls->end; i++) {
            const struct exit_plane *plane = &search->plane[i];
            double length = sqrt(plane->x * plane->x + plane->z * plane->z);
            if (length < LEVEL_MIN || plane->separation_m >= 0.0 ||
                -plane->separation_m >= best->length_m * length ||
                !is_new(&tried, plane->x / length, plane->z / length))
                continue;
            try_way(search, bars, plane->x / length, plane->z / length, best);
        }
    }
}

/* --- corners -----------------------------------------------------------------------------------*/

/* Cuts the line of an edge to the outline of its hulls. Returns false if nothing of it is left. */
static bool cut_edge(const struct level_exit *search, const struct exit_hulls *hulls,
                     struct exit_edge *edge)
{
    double foot_x = edge->far_m * edge->x, foot_z = edge->far_m * edge->z;
    edge->from = -INFINITY;
    edge->to = INFINITY;
    for (uint32_t i = hulls->first; i < hulls->end && edge->from <= edge->to; i++) {
        const struct exit_plane *plane = &search->plane[i];
        double rate = plane->z * edge->x - plane->x * edge->z;
        double room = -plane->separation_m - plane->x * foot_x - plane->z * foot_z;
        if (fabs(rate) < PARALLEL) {
            if (room < -ROUNDING_M)
                return false;
        } else if (rate > 0.0) {
            edge->to = maths_min(edge->to, room / rate);
        } else {
            edge->from = maths_max(edge->from, room / rate);
        }
    }
    return edge->from <= edge->to;
}

/* Lists the edges of the outlines that are nearer than the best way is long. */
static void list_edges(struct level_exit *search, double best_m)
{
    search->edges = 0;
    for (uint32_t h = 0; h < search->hulls_count; h++) {
        const struct exit_hulls *hulls = &search->hulls[h];
        for (uint32_t i = hulls->first; !hulls->bars && i < hulls->end; i++) {
            const struct exit_plane *plane = &search->plane[i];
            double length = sqrt(plane->x * plane->x + plane->z * plane->z);
            if (length < LEVEL_MIN || fabs(plane->separation_m) >= best_m * length)
                continue;
            struct exit_edge edge = {.hulls = h,
                                     .x = plane->x / length,
                                     .z = plane->z / length,
                                     .far_m = -plane->separation_m / length};
            if (!cut_edge(search, hulls, &edge))
                continue;
            if (search->edges == search->edge_capacity) {
                search->edge_capacity *= 2;
                search->edge = reserve_grow(search->edge, search->edges, search->edge_capacity,
                                            sizeof *search->edge);
            }
            search->edge[search->edges++] = edge;
        }
    }
}

static bool is_on(const struct exit_edge *edge, double x, double z)
{
    double along = z * edge->x - x * edge->z;
    return along >= edge->from - ROUNDING_M && along <= edge->to + ROUNDING_M;
}

/* Returns true if a way of this length leads out of all hulls, through none that bars it. Whether
 * it would lead into others farther on does not matter. */
static bool ends_outside(const struct level_exit *search, bool bars, double normal_x,
                         double normal_z, double length_m)
{
    for (uint32_t i = 0; i < search->hulls_count; i++) {
        const struct exit_hulls *hulls = &search->hulls[i];
        const struct interval along = overlap_along(search, hulls, normal_x, normal_z);
        if (along.from > along.to || along.to <= 0.0)
            continue;
        double end = bars && hulls->bars ? INFINITY : along.to;
        if (along.from < length_m - ROUNDING_M && end > length_m + ROUNDING_M)
            return false;
    }
    return true;
}

/* Tries the way to the point in which two edges cross, if it is nearer than the best way is long.
 */
static void try_corner(const struct level_exit *search, bool bars, const struct exit_edge *p,
                       const struct exit_edge *q, struct best_way *best)
{
    double across = p->x * q->z - p->z * q->x;
    if (fabs(across) < PARALLEL)
        return;
    double x = (p->far_m * q->z - q->far_m * p->z) / across;
    double z = (q->far_m * p->x - p->far_m * q->x) / across;
    double far = sqrt(x * x + z * z);
    if (far > 0.0 && far < best->length_m && is_on(p, x, z) && is_on(q, x, z) &&
        ends_outside(search, bars, x / far, z / far, far))
        *best = (struct best_way){far, x / far, z / far};
}

static void try_corners(struct level_exit *search, bool bars, struct best_way *best)
{
    list_edges(search, best->length_m);
    for (uint32_t i = 0; i < search->edges; i++) {
        for (uint32_t j = i + 1; j < search->edges; j++) {
            if (search->edge[i].hulls != search->edge[j].hulls &&
                search->edge[j].far_m < best->length_m)
                try_corner(search, bars, &search->edge[i], &search->edge[j], best);
        }
    }
}

double level_exit_find(struct level_exit *search, bool bars, struct vec3 *normal)
{
    struct best_way best = {.length_m = INFINITY};
    bool overlaps = false;
    for (uint32_t h = 0; h < search->hulls_count; h++)
        overlaps |= search->hulls[h].overlaps && !search->hulls[h].bars;
    if (!overlaps)
        return INFINITY;
    try_faces(search, bars, &best);
    try_corners(search, bars, &best);
    if (best.length_m < INFINITY)
        *normal = (struct vec3){best.x, 0.0, best.z};
    return best.length_m;
}

double level_exit_of(struct level_exit *search, const struct swept_body *body,
                     const struct swept_body *other, struct vec3 *normal)
{
    double reach_m = REACH_M;
    for (;;) {
        level_exit_begin(search);
        add_body(search, body, other, false, reach_m);
        double way_m = level_exit_find(search, false, normal);
        if (way_m <= reach_m || way_m == INFINITY)
            return way_m;
        reach_m = way_m;
    }
}
