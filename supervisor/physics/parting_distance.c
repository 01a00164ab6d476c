/* Half-planes of the places of b at which two pieces overlap, cut by lines. */
#include "supervisor/physics/parting_distance.h"

#include "supervisor/physics/hull_overlap.h"

#include <stdbool.h>

#define LEVEL_LEAST 0.2  /* the level part of a normal along which a body may leave */
#define PLACE_M     0.02 /* a narrower gap between pieces is no place */
#define OUT_M       1e-9 /* a shorter way is none */
#define LINES_MAX   512u /* edges that are nearer than the shortest way along a normal */

/* The level displacements of b at which two pieces overlap: no face separates them. */
struct piece_pair {
    const struct hull_shape *p, *q;
    const struct rigid_pose *pose_p, *pose_q;
    struct relative_place place;
};

/* The part of a line of displacements that is in it [m]. */
struct part_of_line {
    double from, to;
};

/* Returns the world's direction of face i of both pieces, from p to q. */
static struct vec3 face_normal(const struct piece_pair *pair, uint32_t i)
{
    if (i < pair->p->faces)
        return rigid_pose_out(pair->pose_p, pair->p->face[i].normal);
    return vec3_scale(rigid_pose_out(pair->pose_q, pair->q->face[i - pair->p->faces].normal), -1.0);
}

static double separation(const struct piece_pair *pair, struct vec3 normal)
{
    return hull_overlap_along(pair->p, pair->q, &pair->place, rigid_pose_in(pair->pose_p, normal));
}

/* Cuts the line along a level direction with the half-planes of all faces. */
static struct part_of_line cut(const struct piece_pair *pair, struct vec3 direction)
{
    struct part_of_line line = {-HUGE_VAL, HUGE_VAL};
    for (uint32_t i = 0; i < pair->p->faces + pair->q->faces && line.from <= line.to; i++) {
        struct vec3 normal = face_normal(pair, i);
        double apart = separation(pair, normal), rate = vec3_dot(normal, direction);
        if (fabs(rate) < 1e-12)
            line.to = apart >= 0.0 ? -HUGE_VAL : line.to;
        else if (rate > 0.0)
            line.to = maths_min(line.to, -apart / rate);
        else
            line.from = maths_max(line.from, -apart / rate);
    }
    return line;
}

/* Returns how far b has to go in the direction until no two pieces overlap, at most `most`. */
static double way_along(const struct piece_pair *pairs, uint32_t count, struct vec3 direction,
                        double most)
{
    struct part_of_line line[PARTING_PIECES_MAX];
    double end = 0.0;
    for (uint32_t i = 0; i < count; i++)
        line[i] = cut(&pairs[i], direction);
    for (uint32_t i = 0; i < count && end < most; i++) {
        if (line[i].from <= line[i].to && line[i].from < end + PLACE_M && line[i].to > end) {
            end = line[i].to;
            i = UINT32_MAX; /* begin anew */
        }
    }
    return maths_min(end, most);
}

static bool overlap_now(const struct piece_pair *pair)
{
    for (uint32_t i = 0; i < pair->p->faces + pair->q->faces; i++) {
        if (separation(pair, face_normal(pair, i)) >= 0.0)
            return false;
    }
    return true;
}

static uint32_t list_pairs(const struct parting_pieces *a, const struct parting_pieces *b,
                           struct piece_pair *pairs)
{
    const struct vec3 up = {0.0, 1.0, 0.0}, down = {0.0, -1.0, 0.0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < a->count; i++) {
        for (uint32_t j = 0; j < b->count && count < PARTING_PIECES_MAX; j++) {
            struct piece_pair *pair = &pairs[count];
            *pair = (struct piece_pair){&a->shape[i], &b->shape[j], &a->pose[i], &b->pose[j],
                                        hull_overlap_place(&a->pose[i], &b->pose[j], b->scale)};
            count += separation(pair, up) < 0.0 && separation(pair, down) < 0.0;
        }
    }
    return count;
}

/* --- corners -----------------------------------------------------------------------------------*/

/* An edge of a polygon: the level displacements with x * d.x + z * d.z = far_m, of which those
 * beyond it are outside. */
struct edge {
    double x, z, far_m; /* (x, z): unit */
};

/* Lists the edges that are nearer than most [m]. Returns how many there are. */
static uint32_t list_edges(const struct piece_pair *pairs, uint32_t count, double most,
                           struct edge edge[LINES_MAX])
{
    uint32_t edges = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct piece_pair *pair = &pairs[i];
        for (uint32_t k = 0; k < pair->p->faces + pair->q->faces && edges < LINES_MAX; k++) {
            struct vec3 normal = face_normal(pair, k);
            double level = sqrt(normal.x * normal.x + normal.z * normal.z);
            if (level < LEVEL_LEAST)
                continue;
            double far_m = -separation(pair, normal) / level;
            edge[edges] = (struct edge){normal.x / level, normal.z / level, far_m};
            edges += fabs(far_m) < most;
        }
    }
    return edges;
}

/* Returns true if b overlaps no piece after a level displacement. */
static bool is_out(const struct piece_pair *pairs, uint32_t count, double x, double z)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct piece_pair *pair = &pairs[i];
        bool apart = false;
        for (uint32_t k = 0; k < pair->p->faces + pair->q->faces && !apart; k++) {
            struct vec3 normal = face_normal(pair, k);
            apart = separation(pair, normal) + normal.x * x + normal.z * z >= -OUT_M;
        }
        if (!apart)
            return false;
    }
    return true;
}

/* Returns the distance of the nearest place in which the edges of two polygons cross, at most most.
 * b has a little room there: it goes on across both edges by half of what a place needs. */
static double nearest_corner(const struct piece_pair *pairs, uint32_t count, double most)
{
    struct edge edge[LINES_MAX];
    uint32_t edges = list_edges(pairs, count, most, edge);
    for (uint32_t i = 0; i < edges; i++) {
        for (uint32_t j = 0; j < i; j++) {
            const struct edge *p = &edge[i], *q = &edge[j];
            double sine = p->x * q->z - p->z * q->x;
            if (fabs(sine) < 1e-6)
                continue;
            double x = (p->far_m * q->z - q->far_m * p->z) / sine;
            double z = (q->far_m * p->x - p->far_m * q->x) / sine;
            double room = 0.5 * PLACE_M, far = sqrt(x * x + z * z);
            if (far < most &&
                is_out(pairs, count, x + room * (p->x + q->x), z + room * (p->z + q->z)))
                most = far;
        }
    }
    return most;
}

double parting_distance_find(const struct parting_pieces *a, const struct parting_pieces *b)
{
    struct piece_pair pairs[PARTING_PIECES_MAX];
    uint32_t count = list_pairs(a, b, pairs);
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        const struct piece_pair *pair = &pairs[i];
        if (!overlap_now(pair))
            continue;
        for (uint32_t k = 0; k < pair->p->faces + pair->q->faces; k++) {
            struct vec3 normal = face_normal(pair, k);
            double level = sqrt(normal.x * normal.x + normal.z * normal.z);
            if (level < LEVEL_LEAST)
                continue;
            const struct vec3 direction = {normal.x / level, 0.0, normal.z / level};
            least = maths_min(least, way_along(pairs, count, direction, least));
        }
    }
    if (!(least < HUGE_VAL && least > OUT_M))
        return 0.0;
    return nearest_corner(pairs, count, least);
}
