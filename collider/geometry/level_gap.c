/* Distances by GJK; overlaps by the separating axes that are horizontal. */
#include "collider/geometry/level_gap.h"

#include "collider/geometry/box_view.h"
#include "collider/geometry/contact_manifold.h"
#include "collider/geometry/hull_separation.h"
#include "collider/geometry/vertex_reach.h"

#include <stddef.h>

/* A shorter contact is treated as a point [m]. */
#define EDGE_LEAST_M 0.01

/* Hulls that a plane separates by this much more than the margin are farther apart than it, and GJK
 * would say so: its error is a tenth of this [m]. */
#define SURELY_M 1e-8
/* The least horizontal part of the normal between two hulls that are apart. */
#define STEEP 1e-3

/* Of more pairs of hulls that overlap, only so many count when whole bodies part. */
#define OVERLAPS_MAX 16u

/* The ends of so many searches are known, until those that are remembered are chosen. */
#define SEARCHES_MAX 16u

/* The two bodies at one time. */
struct body_pair {
    const struct swept_body *a, *b;
    struct body_pose pose_a, pose_b;
    struct vec3 between; /* [m] from a's position to b's */
    double time;
    struct vec3 line;   /* unit, horizontal: from a's position to b's */
    struct vec3 last;   /* the normal of the last overlap, or the line */
    struct vec3 *plane; /* [LEVEL_GAP_PLANES] normals that may separate hulls, or NULL */
    double apart_m;     /* all hulls measured so far are apart by this at least */
    const struct level_gap_memory *before; /* where searches begin, or NULL */
    uint64_t known; /* pairs of hulls that have been measured, as in box_view_near() */
    struct nearest_vertices after[SEARCHES_MAX]; /* where they ended */
    uint32_t remembered;                         /* entries of after */
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

/* Two hulls that overlap, and the normal along which they do so least. */
struct overlap {
    const struct relative_pose *now;
    const struct gjk *gjk;
    struct level_gap *gap;
};

static void shallower(const struct overlap *overlap, struct vec3 normal)
{
    struct level_gap *gap = overlap->gap;
    double depth = hull_separation_above(overlap->now, overlap->gjk, normal, gap->gap_m);
    if (depth > gap->gap_m) {
        gap->gap_m = depth;
        gap->normal = normal;
    }
}

/* Looks along the normals of a hull's faces, until the hulls overlap by no more than enough_m. */
static void faces(const struct overlap *overlap, const struct swept_body *body,
                  const struct mat3 *turn, const struct hull *hull, double side, double enough_m)
{
    const struct hull_plane *plane = body->planes + hull->first_plane;
    for (uint32_t i = 0; i < hull->plane_count && overlap->gap->gap_m < enough_m; i++) {
        struct vec3 normal = vec3_scale(rotation_apply(turn, plane[i].normal), side);
        if (level(&normal) > 0.0)
            shallower(overlap, normal);
    }
}

/* Finds the normal along which two hulls overlap least, or one along which they overlap by no more
 * than enough_m [m]. */
static void measure_overlap(const struct body_pair *bodies, const struct hull *hull_a,
                            const struct hull *hull_b, const struct overlap *overlap,
                            double enough_m)
{
    overlap->gap->gap_m = -INFINITY;
    overlap->gap->normal = bodies->line;
    if (enough_m < INFINITY)
        shallower(overlap, bodies->last);
    else /* the line is tried at last; a normal that is deeper than it need not be measured */
        overlap->gap->gap_m = hull_separation_now(overlap->now, bodies->line) - SURELY_M;
    faces(overlap, bodies->a, &overlap->now->a.turn, hull_a, 1.0, enough_m);
    faces(overlap, bodies->b, &overlap->now->b.turn, hull_b, -1.0, enough_m);
    shallower(overlap, bodies->line);
}

/* --- one pair of hulls -------------------------------------------------------------------------*/

/* The ends of the contact, across the normal; the point midway without a manifold, and of hulls
 * that only have to part. */
static void find_points(const struct body_pair *bodies, const struct relative_pose *now,
                        struct vec3 normal, struct vec3 middle, struct level_gap *gap)
{
    struct contact_manifold patch;
    struct vec3 at = path_at(&bodies->a->path, bodies->time), low = middle, high = middle;
    double least = 0.0, most = 0.0;
    if (gap->gap_m > -LEVEL_GAP_PARTS_M &&
        contact_manifold_between(&now->a, &now->b, normal, &patch)) {
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

/* Measures a pair of hulls whose distance is known, and not 0. */
static void measure_distance(const struct body_pair *bodies, const struct gjk *gjk,
                             struct level_gap *gap)
{
    struct vec3 n = gjk->normal;
    double share = sqrt(n.x * n.x + n.z * n.z);
    gap->normal = share > STEEP ? (struct vec3){n.x / share, 0.0, n.z / share} : bodies->line;
    gap->gap_m = gjk->distance_m / maths_max(share, STEEP);
}

static bool is_known(struct vec3 plane)
{
    return vec3_dot(plane, plane) > 0.0;
}

/* Returns true if a known plane separates the hulls by more than a length. A plane between two
 * convex bodies shows a lower bound of their distance, whatever plane it is. */
static bool plane_separates(const struct body_pair *bodies, const struct relative_pose *now,
                            double length_m)
{
    for (uint32_t i = 0; bodies->plane && i < LEVEL_GAP_PLANES; i++) {
        if (is_known(bodies->plane[i]) &&
            hull_separation_now(now, bodies->plane[i]) > length_m + SURELY_M)
            return true;
    }
    return false;
}

/* Keeps the normal of hulls that are apart for the next ones. The first plane is that of the outer
 * hulls, if these have one. */
static void learn(const struct body_pair *bodies, struct vec3 normal)
{
    if (bodies->plane)
        bodies->plane[is_known(bodies->plane[0])] = normal;
}

/* --- memory ------------------------------------------------------------------------------------*/

static bool has_vertices(const struct hull *hull, const uint8_t vertex[3], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (vertex[i] >= hull->vertex_count)
            return false;
    }
    return true;
}

/* Returns where the search for the nearest points of two hulls begins. */
static struct gjk_start start_of(const struct body_pair *bodies, uint32_t hulls,
                                 const struct hull *hull_a, const struct hull *hull_b,
                                 struct vec3 guess)
{
    struct gjk_start start = {.guess = guess};
    for (uint32_t i = 0; bodies->before && i < PERSISTENT_CONTACT_NEAREST; i++) {
        const struct nearest_vertices *known = &bodies->before->nearest[i];
        if (known->count == 0 || known->count > 3 || known->hulls != hulls ||
            !has_vertices(hull_a, known->a, known->count) ||
            !has_vertices(hull_b, known->b, known->count))
            continue;
        start.count = known->count;
        for (uint32_t k = 0; k < known->count; k++) {
            start.a[k] = known->a[k];
            start.b[k] = known->b[k];
        }
        break;
    }
    return start;
}

/* Remembers where a search ended, if there is room. The vertices are in an order of their own: a
 * search that begins where it ends then ends with the same bits the next time. */
static void remember(struct body_pair *bodies, uint32_t hulls, const struct gjk_start *end)
{
    if (end->count == 0 || bodies->remembered == SEARCHES_MAX)
        return;
    struct nearest_vertices *known = &bodies->after[bodies->remembered++];
    *known = (struct nearest_vertices){.hulls = (uint8_t)hulls, .count = (uint8_t)end->count};
    for (uint32_t k = 0; k < end->count; k++) {
        uint8_t a = (uint8_t)end->a[k], b = (uint8_t)end->b[k];
        uint32_t place = k;
        for (; place > 0 &&
               (known->a[place - 1] > a || (known->a[place - 1] == a && known->b[place - 1] > b));
             place--) {
            known->a[place] = known->a[place - 1];
            known->b[place] = known->b[place - 1];
        }
        known->a[place] = a;
        known->b[place] = b;
    }
}

static struct nearest_vertices recall(const struct body_pair *bodies, uint32_t hulls)
{
    for (uint32_t i = 0; i < bodies->remembered; i++) {
        if (bodies->after[i].hulls == hulls)
            return bodies->after[i];
    }
    for (uint32_t i = 0; bodies->known >> hulls & 1 && i < PERSISTENT_CONTACT_NEAREST; i++) {
        if (bodies->before->nearest[i].hulls == hulls)
            return bodies->before->nearest[i];
    }
    return (struct nearest_vertices){.hulls = (uint8_t)hulls};
}

static bool is_listed(const struct level_gap *list, uint32_t count, uint32_t hulls)
{
    for (uint32_t i = 0; i < count; i++) {
        if (list[i].hulls == hulls)
            return true;
    }
    return false;
}

/* Returns where the searches ended, those of the listed gaps first. */
static struct level_gap_memory memory_of(const struct body_pair *bodies,
                                         const struct level_gap *list, uint32_t count)
{
    struct level_gap_memory memory = {0};
    uint32_t kept = 0;
    for (; kept < count && kept < PERSISTENT_CONTACT_NEAREST; kept++)
        memory.nearest[kept] = recall(bodies, list[kept].hulls);
    for (uint32_t i = 0; i < bodies->remembered && kept < PERSISTENT_CONTACT_NEAREST; i++) {
        if (!is_listed(list, count, bodies->after[i].hulls))
            memory.nearest[kept++] = bodies->after[i];
    }
    return memory;
}

/* --- all of two hulls --------------------------------------------------------------------------*/

/* Returns false if the hulls are farther apart than the margin. points: finds the points, too. Else
 * the gap is at least margin_m if it is not below it. hulls: their bit in box_view_near(). */
static bool measure(struct body_pair *bodies, uint32_t hulls, double margin_m, bool points,
                    struct level_gap *gap)
{
    const struct hull *hull_a = &bodies->a->hull[hulls / HULLS_A_MODEL];
    const struct hull *hull_b = &bodies->b->hull[hulls % HULLS_A_MODEL];
    const struct relative_pose now =
        relative_pose_of(&bodies->pose_a, hull_a, &bodies->pose_b, hull_b, bodies->time);
    double radii = hull_a->radius_m * bodies->a->scale + hull_b->radius_m * bodies->b->scale;
    double near = maths_max(margin_m, 0.0);
    gap->hulls = hulls;
    if (now.centres_m - radii > near || plane_separates(bodies, &now, near))
        return false;
    struct gjk_start search = start_of(bodies, hulls, hull_a, hull_b, now.towards);
    const struct gjk gjk = gjk_distance_within(&now.a, &now.b, near, &search);
    struct vec3 normal = gjk.normal;
    remember(bodies, hulls, &search);
    if (gjk.distance_m > near) {
        learn(bodies, gjk.normal);
        return false;
    }
    bodies->apart_m = maths_min(bodies->apart_m, gjk.distance_m);
    gap->plane = gjk.normal;
    if (gjk.distance_m > 0.0) {
        measure_distance(bodies, &gjk, gap);
    } else {
        const struct overlap overlap = {&now, &gjk, gap};
        measure_overlap(bodies, hull_a, hull_b, &overlap, points ? INFINITY : margin_m);
        normal = bodies->last = gap->normal;
    }
    if (points)
        find_points(bodies, &now, normal, vec3_lerp(gjk.on_a, gjk.on_b, 0.5), gap);
    return true;
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Puts a gap into its place in the list; of too many the largest is left out. */
static uint32_t keep(struct level_gap *list, uint32_t room, uint32_t count,
                     const struct level_gap *gap)
{
    uint32_t place = count < room ? count : room;
    for (; place > 0 && list[place - 1].gap_m > gap->gap_m; place--) {
        if (place < room)
            list[place] = list[place - 1];
    }
    if (place < room)
        list[place] = *gap;
    return count < room ? count + 1 : count;
}

struct mat3 level_gap_turn(const struct swept_body *body, double time)
{
    double left = 1.0 - body->path.since, share = left > 0.0 ? 1.0 / left : 0.0;
    double t = maths_clamp((time - body->path.since) * share, 0.0, 1.0);
    struct quat turned = body->from;
    struct vec3 spin;
    if (body->turn)
        free_turn_at(body->turn, t, &turned, &spin);
    else if (rotation_rate(body->from, body->to) > 0.0)
        turned = rotation_between(body->from, body->to, t);
    return rotation_matrix(turned);
}

static struct body_pose pose_at(const struct swept_body *body, double time)
{
    return (struct body_pose){.body = body, .turn = level_gap_turn(body, time)};
}

static struct body_pair body_pair_of(const struct body_pose *a, const struct body_pose *b,
                                     double time)
{
    struct vec3 between = hull_separation_at(&a->body->path, &b->body->path, time);
    struct vec3 line = line_of(between);
    return (struct body_pair){.a = a->body,
                              .b = b->body,
                              .pose_a = *a,
                              .pose_b = *b,
                              .between = between,
                              .time = time,
                              .line = line,
                              .last = line};
}

/* Measures each pair of hulls that may be as near as *margin_m. Puts the gaps into the list, which
 * has count, and returns how many it holds. list NULL: reduces *margin_m to the least gap instead.
 * Hulls that overlap are all measured, because the deepest overlap is found only by its own
 * normals. */
static uint32_t search(struct body_pair *bodies, double *margin_m, struct level_gap *list,
                       uint32_t count, uint32_t room)
{
    const struct swept_body *a = bodies->a, *b = bodies->b;
    struct box_view view = box_view_of(&bodies->pose_a.turn, &bodies->pose_b.turn, bodies->between,
                                       maths_max(*margin_m, 0.0));
    uint64_t near = box_view_near(&view, a, b) & ~bodies->known;
    bodies->apart_m = maths_max(*margin_m, 0.0);
    for (; near != 0; near &= near - 1) {
        uint32_t bit = (uint32_t)__builtin_ctzll(near);
        struct level_gap one;
        if (!measure(bodies, bit, *margin_m, list != NULL, &one))
            continue;
        if (list)
            count = keep(list, room, count, &one);
        else
            *margin_m = maths_min(*margin_m, one.gap_m);
    }
    return count;
}

static uint32_t find(const struct body_pose *a, const struct body_pose *b, double time,
                     double margin_m, struct level_gap *gap, uint32_t room, double *apart_m,
                     struct level_gap_memory *memory)
{
    struct body_pair bodies = body_pair_of(a, b, time);
    bodies.before = memory;
    uint32_t count = search(&bodies, &margin_m, gap, 0, room);
    *apart_m = bodies.apart_m;
    *memory = memory_of(&bodies, gap, count);
    return count;
}

uint32_t level_gap_find(const struct swept_body *a, const struct swept_body *b, double time,
                        double margin_m, const struct level_gap_memory *memory,
                        struct level_gap *gap)
{
    double apart_m;
    struct level_gap_memory kept = {0};
    struct body_pose pose_a = pose_at(a, time), pose_b = pose_at(b, time);
    if (memory)
        kept = *memory;
    return find(&pose_a, &pose_b, time, margin_m, gap, LEVEL_GAPS_MAX, &apart_m, &kept);
}

uint32_t level_gap_find_more(const struct turned_body *a, const struct turned_body *b,
                             double margin_m, struct level_gap *gap, uint32_t room, double *apart_m,
                             struct level_gap_memory *memory)
{
    const struct body_pose pose_a = {.body = a->body, .turn = a->turn};
    const struct body_pose pose_b = {.body = b->body, .turn = b->turn};
    return find(&pose_a, &pose_b, 0.0, margin_m, gap, room, apart_m, memory);
}

uint32_t level_gap_find_wider(const struct turned_body *a, const struct turned_body *b,
                              double margin_m, struct level_gap *gap, uint32_t count, uint32_t room,
                              struct level_gap_memory *memory)
{
    const struct body_pose pose_a = {.body = a->body, .turn = a->turn};
    const struct body_pose pose_b = {.body = b->body, .turn = b->turn};
    struct body_pair bodies = body_pair_of(&pose_a, &pose_b, 0.0);
    bodies.before = memory;
    for (uint32_t i = 0; i < count; i++)
        bodies.known |= (uint64_t)1 << gap[i].hulls;
    count = search(&bodies, &margin_m, gap, count, room);
    *memory = memory_of(&bodies, gap, count);
    return count;
}

double level_gap_least(const struct swept_body *a, const struct swept_body *b, double time,
                       double margin_m)
{
    struct body_pose pose_a = pose_at(a, time), pose_b = pose_at(b, time);
    struct body_pair bodies = body_pair_of(&pose_a, &pose_b, time);
    search(&bodies, &margin_m, NULL, 0, 0);
    return margin_m;
}

bool level_gap_deepest(const struct turned_body *a, const struct turned_body *b, double least_m,
                       double enough_m, struct level_gap *deepest)
{
    const struct body_pose pose_a = {.body = a->body, .turn = a->turn};
    const struct body_pose pose_b = {.body = b->body, .turn = b->turn};
    struct body_pair bodies = body_pair_of(&pose_a, &pose_b, 0.0);
    struct box_view view = box_view_of(&pose_a.turn, &pose_b.turn, bodies.between, 0.0);
    uint64_t near = box_view_near(&view, a->body, b->body);
    deepest->gap_m = -least_m;
    for (; near != 0 && deepest->gap_m >= -enough_m; near &= near - 1) {
        struct level_gap one;
        bodies.last = bodies.line; /* the normals of other hulls are none of these */
        if (measure(&bodies, (uint32_t)__builtin_ctzll(near), -least_m, false, &one) &&
            one.gap_m < deepest->gap_m)
            *deepest = one;
    }
    return deepest->gap_m < -least_m;
}

double level_gap_depth(const struct turned_body *a, const struct turned_body *b,
                       struct vec3 plane[LEVEL_GAP_PLANES], const struct level_gap_memory *memory)
{
    const struct body_pose pose_a = {.body = a->body, .turn = a->turn};
    const struct body_pose pose_b = {.body = b->body, .turn = b->turn};
    struct body_pair bodies = body_pair_of(&pose_a, &pose_b, 0.0);
    double gap_m = 0.0;
    bodies.plane = plane;
    bodies.before = memory;
    search(&bodies, &gap_m, NULL, 0, 0);
    return gap_m;
}

/* --- planes ------------------------------------------------------------------------------------*/

/* Returns how far a hull reaches along a normal from the position of its body. */
static double reach_along(const struct turned_body *body, const struct hull *hull,
                          struct vec3 normal)
{
    struct vec3 own = rotation_back(&body->turn, normal);
    const struct vec3 *vertex = body->body->vertices + hull->first_vertex;
    return vertex_reach_most(vertex, hull->vertex_count, own) * body->body->scale;
}

bool level_gap_planes_hold(const struct turned_body *a, const struct turned_body *b,
                           const struct level_gap *gap, uint32_t count)
{
    struct vec3 between = vec3_sub(b->body->path.at, a->body->path.at);
    for (uint32_t i = 0; i < count; i++) {
        const struct hull *hull_a = &a->body->hull[gap[i].hulls / HULLS_A_MODEL];
        const struct hull *hull_b = &b->body->hull[gap[i].hulls % HULLS_A_MODEL];
        struct vec3 plane = gap[i].plane;
        if (!is_known(plane) || turret_path_turns(&a->body->turret, hull_a) ||
            turret_path_turns(&b->body->turret, hull_b) ||
            vec3_dot(plane, between) - reach_along(a, hull_a, plane) -
                    reach_along(b, hull_b, vec3_scale(plane, -1.0)) <=
                SURELY_M)
            return false;
    }
    return true;
}

/* --- whole bodies ------------------------------------------------------------------------------*/

static struct relative_pose hulls_of(const struct body_pair *bodies, uint32_t hulls)
{
    return relative_pose_of(&bodies->pose_a, &bodies->a->hull[hulls / HULLS_A_MODEL],
                            &bodies->pose_b, &bodies->b->hull[hulls % HULLS_A_MODEL], bodies->time);
}

/* Puts the pairs of hulls that overlap into the list. Returns how many it holds. */
static uint32_t search_overlaps(const struct body_pair *bodies, struct relative_pose *list)
{
    struct box_view view =
        box_view_of(&bodies->pose_a.turn, &bodies->pose_b.turn, bodies->between, 0.0);
    uint32_t count = 0;
    for (uint64_t near = box_view_near(&view, bodies->a, bodies->b);
         near != 0 && count < OVERLAPS_MAX; near &= near - 1) {
        list[count] = hulls_of(bodies, (uint32_t)__builtin_ctzll(near));
        struct gjk_start start = {.guess = list[count].towards};
        count += gjk_distance_within(&list[count].a, &list[count].b, 0.0, &start).distance_m == 0.0;
    }
    return count;
}

/* The same from a list of gaps that had room for all: those of hulls that overlap are below 0. */
static uint32_t list_overlaps(const struct body_pair *bodies, const struct level_gap *gap,
                              uint32_t gaps, struct relative_pose *list)
{
    uint32_t count = 0;
    for (; count < gaps && count < OVERLAPS_MAX && gap[count].gap_m < 0.0; count++)
        list[count] = hulls_of(bodies, gap[count].hulls);
    return count;
}

/* Returns the separation of all of the pairs along the normal, below 0, or least_m if it is less.
 */
static double along_all(const struct relative_pose *list, uint32_t count, struct vec3 normal,
                        double least_m)
{
    double gap = 0.0;
    for (uint32_t i = 0; i < count && gap > least_m; i++)
        gap = maths_min(gap, hull_separation_now(&list[i], normal));
    return maths_max(gap, least_m);
}

void level_gap_whole(const struct turned_body *a, const struct turned_body *b,
                     struct level_gap *gap, uint32_t count, uint32_t room)
{
    const struct body_pose pose_a = {.body = a->body, .turn = a->turn};
    const struct body_pose pose_b = {.body = b->body, .turn = b->turn};
    struct body_pair bodies = body_pair_of(&pose_a, &pose_b, 0.0);
    struct relative_pose list[OVERLAPS_MAX];
    uint32_t overlaps =
        count < room ? list_overlaps(&bodies, gap, count, list) : search_overlaps(&bodies, list);
    struct vec3 best = bodies.line;
    double least = along_all(list, overlaps, best, -INFINITY);
    for (uint32_t i = 0; i < count && gap[i].gap_m < 0.0; i++) {
        double along = along_all(list, overlaps, gap[i].normal, least);
        if (along > least)
            least = along, best = gap[i].normal;
    }
    gap[0].gap_m = maths_min(gap[0].gap_m, least);
    gap[0].normal = best;
}
