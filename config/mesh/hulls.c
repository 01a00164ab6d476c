/* Joins pieces by the volume that their common hulls add, then makes hulls with one face for all
 * triangles in a plane. */
#include "config/mesh/hulls.h"

#include "config/mesh/connected_pieces.h"
#include "config/mesh/model_parts.h"
#include "config/syntax/table.h"
#include "world/entity/hull.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A piece is inside another when it is outside of its hull by no more than this [m]. */
#define NESTED_M 1e-6

/* --- joining -----------------------------------------------------------------------------------*/

/* The common hull of two pieces. */
struct joint {
    double cost_m3; /* its volume beyond that of both hulls */
    bool exact;     /* false: cost_m3 is a lower bound */
};

struct joining {
    struct connected_pieces *pieces;
    struct joint *joint; /* [count * count]: of i with j at i * count + j, where i < j */
    uint32_t left;       /* pieces that are left */
};

static struct joint *joint_of(const struct joining *joining, uint32_t i, uint32_t j)
{
    uint32_t count = joining->pieces->count;
    return i < j ? &joining->joint[i * count + j] : &joining->joint[j * count + i];
}

static bool same_part(const struct joining *joining, uint32_t i, uint32_t j)
{
    return joining->pieces->piece[i].part == joining->pieces->piece[j].part;
}

/* Joins all pieces of its part that are inside this one to it. */
static int take_inside(struct joining *joining, uint32_t outer)
{
    struct connected_pieces *pieces = joining->pieces;
    for (uint32_t i = 0; pieces->piece[outer].count > 0 && i < pieces->count; i++) {
        if (i == outer || pieces->piece[i].count == 0 || !same_part(joining, i, outer) ||
            !convex_hull_holds(&pieces->piece[outer].hull, &pieces->piece[i].hull, NESTED_M))
            continue;
        if (connected_pieces_join(&pieces->piece[outer], &pieces->piece[i], NULL) != 0)
            return -1;
        joining->left--;
    }
    return 0;
}

/* A lower bound of the cost: the common hull holds at least this hull and the furthest point of the
 * other. */
static double least_cost(const struct convex_hull *hull, const struct convex_hull *other)
{
    struct vec3 furthest = other->point[0];
    double most = 0.0;
    for (uint32_t i = 0; i < other->point_count; i++) {
        struct vec3 out = vec3_sub(other->point[i], hull->middle);
        double far = vec3_dot(out, out);
        if (far > most) {
            most = far;
            furthest = other->point[i];
        }
    }
    return convex_hull_growth(hull, furthest) - other->volume_m3;
}

/* Sets the lower bounds of piece i with every piece from `from` on. */
static void guess_joints(const struct joining *joining, uint32_t i, uint32_t from)
{
    const struct piece *piece = joining->pieces->piece;
    for (uint32_t j = from; piece[i].count > 0 && j < joining->pieces->count; j++) {
        if (j == i || piece[j].count == 0 || !same_part(joining, i, j))
            continue;
        *joint_of(joining, i, j) = (struct joint){
            maths_max(least_cost(&piece[i].hull, &piece[j].hull),
                      least_cost(&piece[j].hull, &piece[i].hull)),
            false,
        };
    }
}

static int measure_joint(const struct joining *joining, uint32_t i, uint32_t j)
{
    const struct convex_hull *a = &joining->pieces->piece[i].hull,
                             *b = &joining->pieces->piece[j].hull;
    double volume;
    if (convex_hull_volume(&volume, a, b) != 0)
        return -1;
    *joint_of(joining, i, j) = (struct joint){volume - a->volume_m3 - b->volume_m3, true};
    return 0;
}

static int join(struct joining *joining, uint32_t i, uint32_t j)
{
    struct piece *a = &joining->pieces->piece[i], *b = &joining->pieces->piece[j];
    struct convex_hull both;
    if (convex_hull_both(&both, &a->hull, &b->hull) != 0)
        return -1;
    if (connected_pieces_join(a, b, &both) != 0) {
        convex_hull_free(&both);
        return -1;
    }
    joining->left--;
    if (take_inside(joining, i) != 0)
        return -1;
    guess_joints(joining, i, 0);
    return 0;
}

/* The pair of one part with the least cost, of equal pairs the first; NULL: there is none. */
static const struct joint *cheapest(const struct joining *joining, uint32_t *left, uint32_t *right)
{
    const struct piece *piece = joining->pieces->piece;
    const struct joint *best = NULL;
    for (uint32_t i = 0; i < joining->pieces->count; i++) {
        if (piece[i].count == 0)
            continue;
        for (uint32_t j = i + 1; j < joining->pieces->count; j++) {
            const struct joint *joint = joint_of(joining, i, j);
            if (piece[j].count > 0 && same_part(joining, i, j) &&
                (best == NULL || joint->cost_m3 < best->cost_m3)) {
                best = joint;
                *left = i;
                *right = j;
            }
        }
    }
    return best;
}

/* The exact cost of a pair is computed only when its lower bound is the least of all, for few
 * pairs. */
static int join_cheapest(struct joining *joining)
{
    double free_m3 = HULLS_FREE_M3;
    const struct joint *joint;
    uint32_t i = 0, j = 0;
    while ((joint = cheapest(joining, &i, &j)) != NULL) {
        if (!joint->exact) {
            if (measure_joint(joining, i, j) != 0)
                return -1;
            continue;
        }
        if (joining->left > HULLS_A_MODEL)
            free_m3 = maths_max(free_m3, joint->cost_m3 * (1.0 + HULLS_TIE_SHARE));
        else if (joint->cost_m3 > free_m3)
            break;
        if (join(joining, i, j) != 0)
            return -1;
    }
    return 0;
}

static int join_pieces(struct connected_pieces *pieces)
{
    struct joining joining = {.pieces = pieces, .left = pieces->count};
    int result = 0;
    joining.joint = malloc((size_t)pieces->count * pieces->count * sizeof(*joining.joint));
    if (joining.joint == NULL)
        return -1;
    for (uint32_t i = 0; result == 0 && i < pieces->count; i++)
        result = take_inside(&joining, i);
    for (uint32_t i = 0; result == 0 && i < pieces->count; i++)
        guess_joints(&joining, i, i + 1);
    if (result == 0)
        result = join_cheapest(&joining);
    free(joining.joint);
    return result;
}

/* --- a hull without flat edges -----------------------------------------------------------------*/

struct shell {
    struct vec3 *vertex; /* in order of x, y, z */
    uint32_t vertices;
    struct hull_plane *plane; /* in order of their normals */
    uint32_t planes;
    uint32_t *plane_of; /* [face_count of the piece's hull], while the shell is made */
};

static void shell_free(struct shell *shell)
{
    free(shell->vertex);
    free(shell->plane);
    free(shell->plane_of);
}

static int compare_areas(const void *left, const void *right)
{
    const struct convex_hull_face *a = left, *b = right;
    if (a->area_m2 > b->area_m2 || a->area_m2 < b->area_m2)
        return a->area_m2 > b->area_m2 ? -1 : 1;
    return convex_hull_compare(&a->normal, &b->normal);
}

static int compare_planes(const void *left, const void *right)
{
    const struct hull_plane *a = left, *b = right;
    int normals = convex_hull_compare(&a->normal, &b->normal);
    return normals != 0 ? normals : (a->offset_m > b->offset_m) - (a->offset_m < b->offset_m);
}

static bool lies_on(const struct hull_plane *plane, const struct convex_hull *hull,
                    const struct convex_hull_face *face)
{
    for (int k = 0; k < 3; k++) {
        double above = vec3_dot(plane->normal, hull->point[face->corner[k]]) - plane->offset_m;
        if (fabs(above) > HULLS_FLAT_M)
            return false;
    }
    return true;
}

/* Finds the plane of each face: that of the largest face in whose plane it lies. */
static void find_planes(struct shell *shell, struct convex_hull *hull)
{
    qsort(hull->face, hull->face_count, sizeof(*hull->face), compare_areas);
    for (uint32_t i = 0; i < hull->face_count; i++) {
        const struct convex_hull_face *face = &hull->face[i];
        uint32_t plane = 0;
        while (plane < shell->planes && !lies_on(&shell->plane[plane], hull, face))
            plane++;
        if (plane == shell->planes)
            shell->plane[shell->planes++] = (struct hull_plane){face->normal, face->offset_m};
        shell->plane_of[i] = plane;
    }
}

/* Returns true for a corner of three planes or more. Other points are within a face or an edge. */
static bool is_corner(const struct shell *shell, const struct convex_hull *hull, uint32_t point)
{
    uint32_t seen[2] = {UINT32_MAX, UINT32_MAX};
    for (uint32_t i = 0; i < hull->face_count; i++) {
        const struct convex_hull_face *face = &hull->face[i];
        uint32_t plane = shell->plane_of[i];
        if (face->corner[0] != point && face->corner[1] != point && face->corner[2] != point)
            continue;
        if (seen[0] == UINT32_MAX || seen[0] == plane)
            seen[0] = plane;
        else if (seen[1] == UINT32_MAX || seen[1] == plane)
            seen[1] = plane;
        else
            return true;
    }
    return false;
}

/* Moves the planes outwards until all corners are inside: snapping to the lattice may have left
 * some of them outside. */
static void hold_points(struct shell *shell, const struct piece *piece)
{
    for (uint32_t i = 0; i < shell->planes; i++) {
        struct hull_plane *plane = &shell->plane[i];
        for (uint32_t k = 0; k < piece->count; k++)
            plane->offset_m = maths_max(plane->offset_m, vec3_dot(plane->normal, piece->point[k]));
    }
}

static int shell_make(struct shell *shell, struct piece *piece)
{
    struct convex_hull *hull = &piece->hull;
    memset(shell, 0, sizeof(*shell));
    shell->vertex = malloc(hull->point_count * sizeof(*shell->vertex));
    shell->plane = malloc(hull->face_count * sizeof(*shell->plane));
    shell->plane_of = malloc(hull->face_count * sizeof(*shell->plane_of));
    if (shell->vertex == NULL || shell->plane == NULL || shell->plane_of == NULL)
        return -1;
    find_planes(shell, hull);
    for (uint32_t i = 0; i < hull->point_count; i++) {
        if (is_corner(shell, hull, i))
            shell->vertex[shell->vertices++] = hull->point[i];
    }
    qsort(shell->vertex, shell->vertices, sizeof(*shell->vertex), convex_hull_compare);
    qsort(shell->plane, shell->planes, sizeof(*shell->plane), compare_planes);
    if (shell->vertices > HULL_VERTICES_MAX) {
        errno = ERANGE;
        return -1;
    }
    hold_points(shell, piece);
    return 0;
}

/* --- into the scenario's tables ----------------------------------------------------------------*/

/* Sets the box and the sphere around the vertices. Each holds all of them, rounding included. */
static void set_bounds(struct hull *hull, const struct shell *shell)
{
    struct vec3 low = shell->vertex[0], high = low;
    for (uint32_t i = 1; i < shell->vertices; i++) {
        const struct vec3 *v = &shell->vertex[i];
        low = (struct vec3){maths_min(low.x, v->x), maths_min(low.y, v->y), maths_min(low.z, v->z)};
        high = (struct vec3){maths_max(high.x, v->x), maths_max(high.y, v->y),
                             maths_max(high.z, v->z)};
    }
    hull->centre = vec3_lerp(low, high, 0.5);
    for (uint32_t i = 0; i < shell->vertices; i++) {
        struct vec3 arm = vec3_sub(shell->vertex[i], hull->centre);
        hull->half = (struct vec3){maths_max(hull->half.x, fabs(arm.x)),
                                   maths_max(hull->half.y, fabs(arm.y)),
                                   maths_max(hull->half.z, fabs(arm.z))};
        hull->radius_m = maths_max(hull->radius_m, vec3_length(arm));
    }
}

static int add_hull(struct scenario *scenario, const struct shell *shell, enum hull_part part)
{
    void *hulls = scenario->hulls, *vertices = scenario->hull_vertices,
         *planes = scenario->hull_planes;
    struct hull added = {.first_vertex = scenario->hull_vertex_count,
                         .vertex_count = shell->vertices,
                         .first_plane = scenario->hull_plane_count,
                         .plane_count = shell->planes,
                         .part = part};
    set_bounds(&added, shell);
    struct hull *hull = table_extend(&hulls, &scenario->hull_count, 1, sizeof(*hull));
    scenario->hulls = hulls;
    struct vec3 *vertex =
        table_extend(&vertices, &scenario->hull_vertex_count, shell->vertices, sizeof(*vertex));
    scenario->hull_vertices = vertices;
    struct hull_plane *plane =
        table_extend(&planes, &scenario->hull_plane_count, shell->planes, sizeof(*plane));
    scenario->hull_planes = planes;
    if (hull == NULL || vertex == NULL || plane == NULL)
        return -1;
    *hull = added;
    memcpy(vertex, shell->vertex, shell->vertices * sizeof(*vertex));
    memcpy(plane, shell->plane, shell->planes * sizeof(*plane));
    return 0;
}

static void grow_extent(struct hulls *hulls, const struct shell *shell)
{
    for (uint32_t i = 0; i < shell->vertices; i++) {
        const struct vec3 *v = &shell->vertex[i];
        hulls->bound_m = maths_max(hulls->bound_m, vec3_length(*v));
        hulls->level_m = maths_max(hulls->level_m, sqrt(v->x * v->x + v->z * v->z));
        hulls->low_m = maths_min(hulls->low_m, v->y);
        hulls->high_m = maths_max(hulls->high_m, v->y);
    }
}

static int add_pieces(struct hulls *hulls, struct scenario *scenario,
                      struct connected_pieces *pieces)
{
    *hulls = (struct hulls){.first = scenario->hull_count, .low_m = INFINITY, .high_m = -INFINITY};
    for (uint32_t i = 0; i < pieces->count; i++) {
        struct shell shell;
        int result;
        if (pieces->piece[i].count == 0)
            continue;
        result = shell_make(&shell, &pieces->piece[i]);
        if (result == 0) {
            grow_extent(hulls, &shell);
            result = add_hull(scenario, &shell, pieces->piece[i].part);
        }
        shell_free(&shell);
        if (result != 0)
            return -1;
        hulls->count++;
        hulls->body += pieces->piece[i].part == HULL_PART_BODY;
    }
    return 0;
}

/* Makes one hull around the pieces of these parts (a bit each), for a first test. The caller frees
 * it in any case. -1 with errno EDOM: there are no such pieces. */
static int outer_make(struct shell *shell, const struct connected_pieces *pieces, uint32_t parts)
{
    uint32_t count = 0, taken = 0;
    int result = -1;
    for (uint32_t i = 0; i < pieces->count; i++)
        count += parts >> pieces->piece[i].part & 1u ? pieces->piece[i].hull.point_count : 0;
    if (count == 0) {
        errno = EDOM; /* as convex_hull_points() would say */
        return -1;
    }
    struct vec3 *point = malloc(count * sizeof(*point));
    if (point == NULL)
        return -1;
    for (uint32_t i = 0; i < pieces->count; i++) {
        const struct convex_hull *hull = &pieces->piece[i].hull;
        if (!(parts >> pieces->piece[i].part & 1u) || hull->point_count == 0)
            continue; /* an empty hull has no points to copy from */
        memcpy(point + taken, hull->point, hull->point_count * sizeof(*point));
        taken += hull->point_count;
    }
    struct piece all = {.point = point, .count = count};
    if (convex_hull_points(&all.hull, all.point, all.count) == 0) {
        result = shell_make(shell, &all);
        convex_hull_free(&all.hull);
    }
    free(point);
    return result;
}

/* Returns how many parts the model has, 0 if it is all body. */
static uint32_t count_parts(const struct connected_pieces *pieces)
{
    uint32_t parts = 0;
    for (uint32_t i = 0; i < pieces->count; i++)
        parts |= 1u << pieces->piece[i].part;
    return parts >> HULL_PART_GUN & 1u ? 3 : parts >> HULL_PART_TURRET & 1u ? 2 : 0;
}

/* Adds a hull around each part. */
static int add_part_hulls(struct hulls *hulls, struct scenario *scenario,
                          const struct connected_pieces *pieces)
{
    hulls->first_part = scenario->hull_count;
    for (uint32_t part = 0; part < hulls->parts; part++) {
        struct shell shell = {.vertex = NULL};
        int result = outer_make(&shell, pieces, 1u << part);
        if (result == 0)
            result = add_hull(scenario, &shell, (enum hull_part)part);
        shell_free(&shell);
        if (result != 0)
            return -1;
    }
    return 0;
}

static int build(struct hulls *hulls, struct scenario *scenario, const struct model *model,
                 struct connected_pieces *pieces)
{
    struct shell outer = {.vertex = NULL};
    int result = -1;
    if (connected_pieces_find(pieces, scenario, model) == 0 &&
        outer_make(&outer, pieces, UINT32_MAX) == 0 && join_pieces(pieces) == 0 &&
        add_pieces(hulls, scenario, pieces) == 0) {
        hulls->outer = scenario->hull_count;
        hulls->parts = count_parts(pieces);
        result = add_hull(scenario, &outer, HULL_PART_BODY);
        if (result == 0)
            result = add_part_hulls(hulls, scenario, pieces);
        hulls->turret_pivot = model_parts_pivot(scenario, model, PART_TURRET);
        hulls->gun_pivot = model_parts_pivot(scenario, model, PART_GUN);
    }
    shell_free(&outer);
    return result;
}

static int refuse(struct key_place place, struct error_text *error, int code)
{
    switch (code) {
    case E2BIG:
        return key_table_refuse(error, place, NULL, NULL, "has too many pieces; allowed: up to %d",
                                CONNECTED_PIECES_MAX);
    case ERANGE:
        return key_table_refuse(error, place, NULL, NULL,
                                "has a piece whose hull has too many corners; allowed: up to %d",
                                HULL_VERTICES_MAX);
    case EDOM:
        return key_table_refuse(error, place, NULL, NULL, "has a piece that takes up no space");
    default:
        return key_table_refuse(error, place, NULL, NULL, "no memory for its hulls");
    }
}

int hulls_build(struct hulls *hulls, struct scenario *scenario, const struct model *model,
                struct key_place place, struct error_text *error)
{
    struct connected_pieces *pieces = malloc(sizeof(*pieces));
    int result = -1, code;
    if (pieces == NULL)
        return refuse(place, error, ENOMEM);
    result = build(hulls, scenario, model, pieces);
    code = errno;
    connected_pieces_free(pieces);
    free(pieces);
    return result == 0 ? 0 : refuse(place, error, code);
}

static int fill_pieces(struct connected_pieces *pieces, const struct vec3 *point,
                       const uint32_t *end, uint32_t count)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < count; first = end[i++]) {
        struct piece *piece = &pieces->piece[pieces->count];
        *piece = (struct piece){.count = end[i] - first, .part = HULL_PART_BODY};
        piece->point = malloc(piece->count * sizeof(*piece->point));
        if (piece->point == NULL)
            return -1;
        pieces->count++;
        memcpy(piece->point, point + first, piece->count * sizeof(*piece->point));
        if (convex_hull_points(&piece->hull, piece->point, piece->count) != 0)
            return -1;
    }
    return 0;
}

int hulls_of_points(struct hulls *hulls, struct scenario *scenario, const struct vec3 *point,
                    const uint32_t *end, uint32_t count)
{
    struct connected_pieces *pieces = malloc(sizeof(*pieces));
    struct shell outer = {.vertex = NULL};
    int result = -1;
    if (pieces == NULL)
        return -1;
    pieces->count = 0;
    if (fill_pieces(pieces, point, end, count) == 0 &&
        outer_make(&outer, pieces, UINT32_MAX) == 0 && add_pieces(hulls, scenario, pieces) == 0) {
        hulls->outer = scenario->hull_count;
        result = add_hull(scenario, &outer, HULL_PART_BODY);
    }
    int code = errno;
    shell_free(&outer);
    connected_pieces_free(pieces);
    free(pieces);
    errno = code;
    return result;
}
