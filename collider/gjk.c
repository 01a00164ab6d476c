/* The nearest point of the difference of two bodies to the origin, round by round: the simplex of
 * at most four of its corners that is nearest so far, and the corner farthest towards the origin.
 *
 * What makes it hold for thin and flat simplices: a simplex's nearest point comes from modified
 * Gram-Schmidt, which is backward stable (Bjorck 1967), so that it is exact for corners moved by
 * rounding alone; of all faces at the new corner the nearest is taken. Every point on the way is
 * one of both bodies, so that the distance is never less than what is known; and every plane on the
 * way keeps the bodies apart, so that it is never more: the two meet, or it is looked again from
 * elsewhere. */
#include "collider/gjk.h"

#define ROUNDS     64    /* of one look; most end after ten */
#define LOOKS      8     /* more, from the corners of a cube, where the first is not sure */
#define NEAR_M     1e-13 /* as near as doubles tell for bodies of tens of metres */
#define NEAR_SHARE 1e-15 /* of the distance, for far ones */
#define SURE_M     1e-11 /* the nearest points and the plane between them agree to this */
#define FLAT       1e-28 /* an edge this little off the others [share of its length, squared] */
/* Where the origin is over the very border of two faces, rounding can hide the next face from the
 * present one: then a corner is taken that brings the point no farther than this, a few times. */
#define TIE  1e-6 /* [share] */
#define TIES 12

struct corner {
    struct vec3 w;          /* on_a - on_b */
    struct vec3 on_a, on_b; /* relative to a's at */
    uint32_t a, b;          /* vertices */
};

struct simplex {
    struct corner corner[4];
    double weight[4]; /* of the point nearest to the origin; > 0, together 1 */
    int count;
    struct vec3 nearest;
    double square;       /* its distance, squared */
    struct vec3 edge[3]; /* square to each other; they span what the corners do */
    double edge_square[3];
    int edges;
};

uint32_t gjk_support(const struct convex *convex, struct vec3 direction, struct vec3 *point)
{
    struct vec3 d = rotation_back(&convex->turn, direction);
    double most = vec3_dot(convex->vertex[0], d);
    uint32_t best = 0;
    for (uint32_t i = 1; i < convex->count; i++) {
        double reach = vec3_dot(convex->vertex[i], d);
        if (reach > most) {
            most = reach;
            best = i;
        }
    }
    *point = rotation_apply(&convex->turn, vec3_scale(convex->vertex[best], convex->scale));
    return best;
}

/* The corner of the difference farthest in a direction. */
static struct corner corner_along(const struct convex *a, const struct convex *b,
                                  struct vec3 direction)
{
    struct corner corner;
    corner.a = gjk_support(a, direction, &corner.on_a);
    corner.b = gjk_support(b, vec3_scale(direction, -1.0), &corner.on_b);
    corner.on_b = vec3_add(corner.on_b, vec3_sub(b->at, a->at));
    corner.w = vec3_sub(corner.on_a, corner.on_b);
    return corner;
}

/* Adds the part of a corner's edge that is square to those there are, and what share of each of
 * those is in it. False when nothing of it is left. */
static bool span(struct simplex *s, const struct corner *corner, double share[3])
{
    struct vec3 e = vec3_sub(corner->w, s->corner[0].w);
    double length = vec3_dot(e, e);
    for (int i = 0; i < s->edges; i++) {
        share[i] = vec3_dot(s->edge[i], e) / s->edge_square[i];
        e = vec3_sub(e, vec3_scale(s->edge[i], share[i]));
    }
    double square = vec3_dot(e, e);
    if (!(square > FLAT * length))
        return false;
    s->edge[s->edges] = e;
    s->edge_square[s->edges++] = square;
    return true;
}

/* Finds the point nearest to the origin in the line, plane or space through the corners. False
 * when they are flat, or it lies outside of them. */
static bool project(struct simplex *s)
{
    struct vec3 rest = vec3_scale(s->corner[0].w, -1.0);
    double along[3], share[3][3], left = 1.0;
    s->edges = 0;
    for (int i = 0; i < s->count - 1; i++) {
        if (!span(s, &s->corner[i + 1], share[i]))
            return false;
        along[i] = vec3_dot(rest, s->edge[i]) / s->edge_square[i];
        rest = vec3_sub(rest, vec3_scale(s->edge[i], along[i]));
    }
    for (int i = s->edges - 1; i >= 0; i--) {
        s->weight[i + 1] = along[i];
        for (int j = i + 1; j < s->edges; j++)
            s->weight[i + 1] -= share[j][i] * s->weight[j + 1];
        left -= s->weight[i + 1];
    }
    s->weight[0] = left;
    s->nearest = (struct vec3){0.0, 0.0, 0.0};
    for (int i = 0; i < s->count; i++) {
        if (!(s->weight[i] > 0.0))
            return false;
        s->nearest = vec3_add(s->nearest, vec3_scale(s->corner[i].w, s->weight[i]));
    }
    s->square = s->count == 4 ? 0.0 : vec3_dot(s->nearest, s->nearest);
    return true;
}

/* Takes a new corner in: of all faces that have it the nearest. False when none is nearer than the
 * limit [squared]. */
static bool take(struct simplex *simplex, const struct corner *corner, double limit)
{
    struct simplex trial[2];
    double least = limit;
    int kept = 0;
    for (int faces = 0; faces < 1 << simplex->count; faces++) {
        struct simplex *face = &trial[1 - kept];
        face->corner[0] = *corner;
        face->count = 1;
        for (int i = 0; i < simplex->count; i++) {
            if (faces & 1 << i)
                face->corner[face->count++] = simplex->corner[i];
        }
        if (project(face) && face->square < least) {
            least = face->square;
            kept = 1 - kept;
        }
    }
    if (!(least < limit))
        return false;
    *simplex = trial[kept];
    return true;
}

static bool holds(const struct simplex *simplex, const struct corner *corner)
{
    for (int i = 0; i < simplex->count; i++) {
        if (simplex->corner[i].a == corner->a && simplex->corner[i].b == corner->b)
            return true;
    }
    return false;
}

/* The direction from the nearest point to the origin. It is made square to the edges again, as
 * the rounding of a point that is very near would not have it. */
static struct vec3 towards_origin(const struct simplex *simplex)
{
    struct vec3 n = vec3_scale(simplex->nearest, -1.0 / sqrt(simplex->square));
    for (int i = 0; i < simplex->edges; i++)
        n = vec3_sub(n, vec3_scale(simplex->edge[i],
                                   vec3_dot(n, simplex->edge[i]) / simplex->edge_square[i]));
    return vec3_scale(n, 1.0 / vec3_length(n));
}

/* A corner that brings the point no nearer still tells how the nearest faces lie: the direction n
 * is to be square to its edge as well. False when it lies ahead, or that is known already. */
static bool lean_on(struct simplex *simplex, const struct corner *corner, struct vec3 n)
{
    double share[3];
    if (simplex->edges >= 2 || !span(simplex, corner, share))
        return false;
    double ahead = vec3_dot(simplex->edge[simplex->edges - 1], n);
    return ahead * ahead < 0.25 * simplex->edge_square[simplex->edges - 1];
}

static bool overlapping(const struct simplex *simplex)
{
    return simplex->square <= GJK_OVERLAP_M * GJK_OVERLAP_M;
}

/* What is known of a distance: the nearest simplex, and the plane that keeps the most apart. */
struct known {
    struct simplex simplex;
    struct vec3 normal;
    double apart;
};

static bool certain(const struct known *known, double slack)
{
    double length = sqrt(known->simplex.square);
    return overlapping(&known->simplex) || length - known->apart <= slack + NEAR_SHARE * length;
}

/* Looks once, from the corner along the guess. */
static void look(const struct convex *a, const struct convex *b, struct vec3 guess,
                 struct known *known)
{
    struct simplex simplex = {.count = 1, .weight[0] = 1.0};
    int ties = 0;
    simplex.corner[0] = corner_along(a, b, guess);
    simplex.nearest = simplex.corner[0].w;
    simplex.square = vec3_dot(simplex.nearest, simplex.nearest);
    for (int round = 0; round < ROUNDS; round++) {
        if (simplex.square < known->simplex.square)
            known->simplex = simplex;
        if (certain(known, NEAR_M))
            return;
        struct vec3 n = towards_origin(&simplex);
        struct corner corner = corner_along(a, b, n);
        double apart = -vec3_dot(n, corner.w);
        if (apart > known->apart) {
            known->apart = apart;
            known->normal = n;
        }
        if (certain(known, NEAR_M) || holds(&simplex, &corner))
            return;
        if (take(&simplex, &corner, simplex.square))
            continue;
        if (ties++ < TIES && take(&simplex, &corner, simplex.square * (1.0 + TIE)))
            continue;
        if (!lean_on(&simplex, &corner, n))
            return;
    }
}

static struct gjk result(const struct convex *a, const struct known *known)
{
    const struct simplex *simplex = &known->simplex;
    struct gjk gjk = {.on_a = a->at, .on_b = a->at};
    for (int i = 0; i < simplex->count; i++) {
        gjk.on_a = vec3_add(gjk.on_a, vec3_scale(simplex->corner[i].on_a, simplex->weight[i]));
        gjk.on_b = vec3_add(gjk.on_b, vec3_scale(simplex->corner[i].on_b, simplex->weight[i]));
    }
    if (overlapping(simplex)) {
        gjk.on_a = vec3_lerp(gjk.on_a, gjk.on_b, 0.5);
        gjk.on_b = gjk.on_a;
        return gjk;
    }
    gjk.distance_m = sqrt(simplex->square);
    gjk.normal = known->normal;
    return gjk;
}

struct gjk gjk_distance_from(const struct convex *a, const struct convex *b, struct vec3 guess)
{
    struct known known = {.simplex.square = INFINITY, .apart = -INFINITY};
    look(a, b, guess, &known);
    for (int other = 0; other < LOOKS && !certain(&known, SURE_M); other++)
        look(a, b,
             (struct vec3){other & 1 ? -1.0 : 1.0, other & 2 ? -1.0 : 1.0, other & 4 ? -1.0 : 1.0},
             &known);
    return result(a, &known);
}

struct gjk gjk_distance(const struct convex *a, const struct convex *b)
{
    return gjk_distance_from(a, b, vec3_sub(b->at, a->at));
}
