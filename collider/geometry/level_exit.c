/* Planes of all pairs of hulls first, then intervals along each of their normals. */
#include "collider/geometry/level_exit.h"

#include "collider/geometry/hull_separation.h"
#include "collider/geometry/level_gap.h"
#include "world/runtime/reserve.h"

#include <errno.h>

/* There is room for so many at first. */
#define PLANES_FIRST 65536u
#define HULLS_FIRST  1024u

/* A narrower gap between two hulls is no place to stay in [m]. */
#define GAP_LEAST_M 0.02

/* Directions that differ less are the same [square of the difference of unit vectors]. */
#define SAME 1e-18

/* So many directions are remembered, so that none of them is tried twice. */
#define TRIED_MAX 64u

/* --- planes ------------------------------------------------------------------------------------*/

int level_exit_init(struct level_exit *search)
{
    *search = (struct level_exit){.plane_capacity = PLANES_FIRST, .hulls_capacity = HULLS_FIRST};
    search->plane = reserve_take(PLANES_FIRST, sizeof *search->plane);
    search->hulls = reserve_take(HULLS_FIRST, sizeof *search->hulls);
    if (search->plane && search->hulls)
        return 0;
    level_exit_free(search);
    errno = ENOMEM;
    return -1;
}

void level_exit_free(struct level_exit *search)
{
    reserve_free(search->plane);
    reserve_free(search->hulls);
    *search = (struct level_exit){0};
}

void level_exit_begin(struct level_exit *search)
{
    search->planes = search->hulls_count = 0;
}

static void add_plane(struct level_exit *search, const struct relative_pose *now,
                      struct vec3 normal)
{
    search->plane[search->planes++] =
        (struct exit_plane){normal.x, normal.z, hull_separation_now(now, normal)};
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
    if (hull_separation_now(now, (struct vec3){0.0, 1.0, 0.0}) >= 0.0 ||
        hull_separation_now(now, (struct vec3){0.0, -1.0, 0.0}) >= 0.0)
        return;
    make_room(search, hull_a->plane_count + hull_b->plane_count);
    hulls.first = search->planes;
    for (uint32_t i = 0; i < hull_a->plane_count; i++)
        add_plane(search, now, rotation_apply(&now->a.turn, a[i].normal));
    for (uint32_t i = 0; i < hull_b->plane_count; i++)
        add_plane(search, now, vec3_scale(rotation_apply(&now->b.turn, b[i].normal), -1.0));
    hulls.end = search->planes;
    for (uint32_t i = hulls.first; i < hulls.end; i++)
        hulls.overlaps = hulls.overlaps && search->plane[i].separation_m < 0.0;
    search->hulls[search->hulls_count++] = hulls;
}

void level_exit_add(struct level_exit *search, const struct swept_body *body,
                    const struct swept_body *other, bool bars)
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
            add_hulls(search, &now, body, hull_a, other, hull_b, bars);
        }
    }
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
            if (along.from > along.to || along.to <= end || along.from >= end + GAP_LEAST_M)
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

double level_exit_find(const struct level_exit *search, bool bars, struct vec3 *normal)
{
    struct tried tried = {.count = 0};
    double best = INFINITY;
    for (uint32_t h = 0; h < search->hulls_count; h++) {
        const struct exit_hulls *hulls = &search->hulls[h];
        for (uint32_t i = hulls->first; hulls->overlaps && !hulls->bars && i < hulls->end; i++) {
            const struct exit_plane *plane = &search->plane[i];
            double length = sqrt(plane->x * plane->x + plane->z * plane->z);
            if (length < LEVEL_MIN || !is_new(&tried, plane->x / length, plane->z / length))
                continue;
            double x = plane->x / length, z = plane->z / length;
            double way = way_along(search, bars, x, z, best);
            if (way < best) {
                best = way;
                *normal = (struct vec3){x, 0.0, z};
            }
        }
    }
    return best;
}
