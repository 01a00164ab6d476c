/* Boxes along the bodies' own axes first, then vertices along the best of these axes, then along
 * the normal of the nearest points. */
#include "collider/narrow_phase/separating_axis.h"

#include "collider/geometry/gjk.h"
#include "collider/geometry/time_of_impact.h"
#include "collider/geometry/vertex_reach.h"

#define ROUNDING_M 1e-8 /* of positions 50 km from the origin, and of the distances of GJK */

#define CANDIDATES 7 /* the three axes of each body, and the line between their positions */

/* Of an arc with the acceleration c, the farthest distance from its chord is c t^2 / 8. */
#define SAGITTA 0.125

/* Returns how far a point of the box is from the position at most. */
static double box_bound(const struct hull_box *box)
{
    struct vec3 corner = {fabs(box->middle.x) + box->half.x, fabs(box->middle.y) + box->half.y,
                          fabs(box->middle.z) + box->half.z};
    return vec3_length(corner);
}

void axis_side_set(struct axis_side *side, const struct swept_body *body, double rate, double time)
{
    double left = 1.0 - body->path.since, share = left > 0.0 ? (1.0 - time) / left : 0.0;
    bool parts = body->turret.outers > 0;
    struct hull_box around = parts ? turret_path_box_all(&body->turret)
                                   : (struct hull_box){body->outer->centre, body->outer->half};
    side->vertex = body->vertices + body->outer->first_vertex;
    side->count = parts ? 0 : body->outer->vertex_count;
    side->scale = body->scale;
    side->box.middle = vec3_scale(around.middle, body->scale);
    side->box.half = vec3_scale(around.half, body->scale);
    side->at[0] = path_at(&body->path, time);
    side->at[1] = path_at(&body->path, 1.0);
    side->turn[0] = rotation_matrix(rate > 0.0 && share < 1.0
                                        ? rotation_between(body->from, body->to, 1.0 - share)
                                        : body->from);
    if (rate > 0.0)
        side->turn[1] = rotation_matrix(body->to);
    else
        side->turn[1] = side->turn[0];
    side->turned_m = rate * share * box_bound(&side->box);
    side->still = rate == 0.0 && vec3_dot(body->path.along, body->path.along) == 0.0;
    side->bend_m = SAGITTA * rate * rate * share * share * body->bound_m;
}

/* Returns how far the side's box reaches along the axis, at one end of the time, from the
 * position. */
static double box_reach(const struct axis_side *side, int end, struct vec3 axis)
{
    struct vec3 own = rotation_back(&side->turn[end], axis);
    return vec3_dot(own, side->box.middle) + fabs(own.x) * side->box.half.x +
           fabs(own.y) * side->box.half.y + fabs(own.z) * side->box.half.z;
}

/* Returns the same for the hull, if there is one. */
static double hull_reach(const struct axis_side *side, int end, struct vec3 axis)
{
    if (side->count == 0)
        return box_reach(side, end, axis);
    struct vec3 own = rotation_back(&side->turn[end], axis);
    return side->scale * vertex_reach_most(side->vertex, side->count, own);
}

static double between(const struct axis_side *a, const struct axis_side *b, int end,
                      struct vec3 axis)
{
    return vec3_dot(vec3_sub(b->at[end], a->at[end]), axis);
}

/* Returns a separation at the later end of the time that boxes or hulls have at least which are
 * apart_m apart at the earlier one: the bodies have come so much nearer, and turned. */
static double later(const struct axis_side *a, const struct axis_side *b, struct vec3 axis,
                    double apart_m)
{
    return apart_m + between(a, b, 1, axis) - between(a, b, 0, axis) - a->turned_m - b->turned_m;
}

/* Returns the separation of the boxes along the axis, the lesser of both ends of the time. Less
 * than enough is exact only at one of them, and more may be less than it is. */
static double box_separation(const struct axis_side *a, const struct axis_side *b, struct vec3 axis,
                             double enough)
{
    const struct vec3 back = vec3_scale(axis, -1.0);
    double apart = between(a, b, 0, axis) - box_reach(a, 0, axis) - box_reach(b, 0, back);
    if (apart <= enough || (a->still && b->still))
        return apart;
    double least = maths_min(apart, later(a, b, axis, apart));
    if (least > enough)
        return least;
    return maths_min(apart, between(a, b, 1, axis) - box_reach(a, 1, axis) - box_reach(b, 1, back));
}

/* A point of b stays relative to a point of a within the bends of the straight line between its
 * places at both ends of the time. So the least separation is that of one of the ends, less the
 * bends. */
static double enough_for(const struct axis_side *a, const struct axis_side *b, double margin_m)
{
    return margin_m + ROUNDING_M + a->bend_m + b->bend_m;
}

/* Returns the separation of the boxes along the axis, the lesser of both ends of the time, or of
 * the hulls if that of the boxes is not enough. Less than enough is no separation. */
static double separation(const struct axis_side *a, const struct axis_side *b, struct vec3 axis,
                         double enough)
{
    const struct vec3 back = vec3_scale(axis, -1.0);
    double least = box_separation(a, b, axis, enough);
    if (least > enough)
        return least;
    double apart = between(a, b, 0, axis) - hull_reach(a, 0, axis) - hull_reach(b, 0, back);
    if (apart <= enough || (a->still && b->still))
        return apart;
    least = maths_min(apart, later(a, b, axis, apart));
    if (least > enough)
        return least;
    return maths_min(apart,
                     between(a, b, 1, axis) - hull_reach(a, 1, axis) - hull_reach(b, 1, back));
}

bool separating_axis_holds(const struct axis_side *a, const struct axis_side *b, struct vec3 axis,
                           double margin_m)
{
    double enough = enough_for(a, b, margin_m);
    return separation(a, b, axis, enough) > enough;
}

static struct vec3 column(const struct mat3 *turn, int i)
{
    return (struct vec3){turn->m[0][i], turn->m[1][i], turn->m[2][i]};
}

/* Which axis of its bodies is tried as the n-th: along and across both, the line between them, and
 * up at last, which seldom separates what stands on the ground. */
static const int CANDIDATE[CANDIDATES] = {2, 0, 5, 3, 6, 1, 4};

/* Returns the separation of the boxes along the axis that separates them most, or along the first
 * one along which it is enough. */
static double find_by_boxes(const struct axis_side *a, const struct axis_side *b, double enough,
                            struct vec3 *best)
{
    struct vec3 line = vec3_sub(b->at[0], a->at[0]);
    double length = vec3_length(line), most = -INFINITY;
    for (int n = 0; n < CANDIDATES && most <= enough; n++) {
        int i = CANDIDATE[n];
        struct vec3 axis = i < 3   ? column(&a->turn[0], i)
                           : i < 6 ? column(&b->turn[0], i - 3)
                                   : vec3_scale(line, length > 0.0 ? 1.0 / length : 0.0);
        if (vec3_dot(axis, line) < 0.0)
            axis = vec3_scale(axis, -1.0);
        double apart = box_separation(a, b, axis, enough);
        if (apart > most) {
            most = apart;
            *best = axis;
        }
    }
    return most;
}

/* Returns the normal of the nearest points of the hulls at the beginning, 0 if they overlap or one
 * side has none. */
static struct vec3 nearest_normal(const struct axis_side *a, const struct axis_side *b)
{
    if (a->count == 0 || b->count == 0)
        return (struct vec3){0.0, 0.0, 0.0};
    const struct convex hull_a = {
        .vertex = a->vertex, .count = a->count, .scale = a->scale, .turn = a->turn[0]};
    const struct convex hull_b = {.vertex = b->vertex,
                                  .count = b->count,
                                  .scale = b->scale,
                                  .turn = b->turn[0],
                                  .at = vec3_sub(b->at[0], a->at[0])};
    return gjk_distance(&hull_a, &hull_b).normal;
}

bool separating_axis_find(const struct axis_side *a, const struct axis_side *b, double margin_m,
                          bool nearest, struct vec3 *axis, double *apart_m)
{
    struct vec3 best = *axis;
    double enough = enough_for(a, b, margin_m), apart = -INFINITY;
    if (vec3_dot(best, best) > 0.0)
        apart = separation(a, b, best, enough);
    if (!(apart > enough)) {
        apart = find_by_boxes(a, b, enough, &best);
        if (!(apart > enough))
            apart = separation(a, b, best, enough);
        if (!(apart > enough) && nearest) {
            best = nearest_normal(a, b);
            apart = vec3_dot(best, best) > 0.0 ? separation(a, b, best, enough) : -INFINITY;
        }
        if (!(apart > enough))
            return false;
    }
    *axis = best;
    *apart_m = apart - enough + margin_m;
    return true;
}
