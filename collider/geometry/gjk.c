/* Finds the point of the Minkowski difference of two bodies that is nearest to the origin. Each
 * round keeps the nearest simplex of at most four corners and adds the corner farthest towards the
 * origin.
 *
 * Why it is robust for thin and flat simplices: a simplex's nearest point is computed by modified
 * Gram-Schmidt, which is backward stable (Bjorck 1967), so it is exact for corners moved by
 * rounding alone; and the nearest of all faces at the new corner is taken. Every point on the way
 * belongs to both bodies, so the distance is an upper bound. Every plane on the way separates the
 * bodies, which gives a lower bound. If the two bounds do not meet, the search starts again from
 * another corner. */
#include "collider/geometry/gjk.h"

#include "collider/geometry/vertex_reach.h"

#define ROUNDS     64 /* of one search; most end after ten */
#define SEARCHES   8 /* further searches, from the corners of a cube, if the first is not certain */
#define NEAR_M     1e-13 /* accuracy of doubles for bodies of tens of metres */
#define NEAR_SHARE 1e-15 /* the same as a share of large distances */
#define SURE_M     1e-11 /* largest difference of the two bounds of a certain result */
#define FLAT                                                                                       \
    1e-28 /* least part of an edge perpendicular to the others [share of its length, squared] */
/* If the origin is exactly over the border of two faces, rounding can hide the next face from the
 * present one. Then a corner is accepted that increases the distance by no more than this, at most
 * TIES times. */
#define TIE  1e-6 /* [share] */
#define TIES 12

/* A corner of the difference: a vertex of a minus a vertex of b. */
struct corner {
    struct vec3 w;
    uint32_t a, b;
};

/* Up to four corners, and the point between them that is nearest to the origin. */
struct face {
    const struct corner *corner[4];
    double weight[4]; /* > 0, their sum is 1 */
    int count;
    struct vec3 nearest;
    double square;       /* squared distance */
    struct vec3 edge[3]; /* orthogonal; they span the same space as the corners */
    double edge_square[3];
    int edges;
};

struct simplex {
    struct corner corner[4]; /* of the face */
    struct face face;
};

struct vec3 gjk_vertex(const struct convex *convex, uint32_t vertex)
{
    return rotation_apply(&convex->turn, vec3_scale(convex->vertex[vertex], convex->scale));
}

uint32_t gjk_support(const struct convex *convex, struct vec3 direction, struct vec3 *point)
{
    struct vec3 d = rotation_back(&convex->turn, direction);
    uint32_t best = vertex_reach_first(convex->vertex, convex->count, d);
    *point = gjk_vertex(convex, best);
    return best;
}

static struct corner corner_of(const struct convex *a, const struct convex *b, uint32_t of_a,
                               uint32_t of_b)
{
    struct vec3 on_b = vec3_add(gjk_vertex(b, of_b), vec3_sub(b->at, a->at));
    return (struct corner){vec3_sub(gjk_vertex(a, of_a), on_b), of_a, of_b};
}

/* Returns the corner of the difference that is farthest in a direction. */
static struct corner corner_along(const struct convex *a, const struct convex *b,
                                  struct vec3 direction)
{
    struct corner corner;
    struct vec3 on_a, on_b;
    corner.a = gjk_support(a, direction, &on_a);
    corner.b = gjk_support(b, vec3_scale(direction, -1.0), &on_b);
    corner.w = vec3_sub(on_a, vec3_add(on_b, vec3_sub(b->at, a->at)));
    return corner;
}

/* Adds the part of a corner's edge that is orthogonal to the face's edges, and its components along
 * each of those. Returns false if no such part is left. */
static bool span(struct face *face, const struct corner *corner, double share[3])
{
    struct vec3 e = vec3_sub(corner->w, face->corner[0]->w);
    double length = vec3_dot(e, e);
    for (int i = 0; i < face->edges; i++) {
        share[i] = vec3_dot(face->edge[i], e) / face->edge_square[i];
        e = vec3_sub(e, vec3_scale(face->edge[i], share[i]));
    }
    double square = vec3_dot(e, e);
    if (!(square > FLAT * length))
        return false;
    face->edge[face->edges] = e;
    face->edge_square[face->edges++] = square;
    return true;
}

/* Finds the point nearest to the origin in the line, plane or space through the corners. Returns
 * false if the corners are flat or the point lies outside of them. */
static bool project(struct face *face)
{
    struct vec3 rest = vec3_scale(face->corner[0]->w, -1.0);
    double along[3], share[3][3], left = 1.0;
    face->edges = 0;
    for (int i = 0; i < face->count - 1; i++) {
        if (!span(face, face->corner[i + 1], share[i]))
            return false;
        along[i] = vec3_dot(rest, face->edge[i]) / face->edge_square[i];
        rest = vec3_sub(rest, vec3_scale(face->edge[i], along[i]));
    }
    for (int i = face->edges - 1; i >= 0; i--) {
        double weight = along[i];
        for (int j = i + 1; j < face->edges; j++)
            weight -= share[j][i] * face->weight[j + 1];
        if (!(weight > 0.0))
            return false;
        face->weight[i + 1] = weight;
        left -= weight;
    }
    if (!(left > 0.0))
        return false;
    face->weight[0] = left;
    face->nearest = vec3_scale(face->corner[0]->w, left);
    for (int i = 1; i < face->count; i++)
        face->nearest = vec3_add(face->nearest, vec3_scale(face->corner[i]->w, face->weight[i]));
    face->square = face->count == 4 ? 0.0 : vec3_dot(face->nearest, face->nearest);
    return true;
}

/* Replaces the simplex by this face of it and a new corner. */
static void settle(struct simplex *simplex, const struct face *face)
{
    struct corner corner[4];
    for (int i = 0; i < face->count; i++)
        corner[i] = *face->corner[i];
    simplex->face = *face;
    for (int i = 0; i < face->count; i++) {
        simplex->corner[i] = corner[i];
        simplex->face.corner[i] = &simplex->corner[i];
    }
}

/* For each set of corners, bit c of which is corner c: the sets that are a part of it. */
static const uint32_t FACES_WITHIN[8] = {0x00, 0x01, 0x01, 0x07, 0x01, 0x13, 0x15, 0x7f};

/* Adds a new corner: the nearest of all faces that contain it is taken, which is the whole simplex
 * if the origin projects into it. Returns false if no face is nearer than the limit [squared
 * distance]. */
static bool add_corner(struct simplex *simplex, const struct corner *corner, double limit)
{
    struct face trial[2];
    double least = limit;
    int kept = 0, whole = (1 << simplex->face.count) - 1;
    uint32_t within = 0; /* faces of a face whose inside is nearest: they are farther */
    bool any = false;
    for (int faces = whole; faces >= 0; faces--) {
        if (within >> faces & 1)
            continue;
        struct face *face = &trial[1 - kept];
        face->corner[0] = corner;
        face->count = 1;
        for (int i = 0; i < simplex->face.count; i++) {
            if (faces & 1 << i)
                face->corner[face->count++] = &simplex->corner[i];
        }
        if (!project(face))
            continue;
        within |= FACES_WITHIN[faces];
        if (!(face->square < least))
            continue;
        least = face->square;
        kept = 1 - kept;
        any = true;
        if (faces == whole)
            break;
    }
    if (any)
        settle(simplex, &trial[kept]);
    return any;
}

static bool holds(const struct simplex *simplex, const struct corner *corner)
{
    for (int i = 0; i < simplex->face.count; i++) {
        if (simplex->corner[i].a == corner->a && simplex->corner[i].b == corner->b)
            return true;
    }
    return false;
}

/* Returns the direction from the nearest point to the origin, made orthogonal to the edges again,
 * since the position of a very near point is lost in rounding. */
static struct vec3 towards_origin(const struct face *face, double length)
{
    struct vec3 n = vec3_scale(face->nearest, -1.0 / length);
    for (int i = 0; i < face->edges; i++)
        n = vec3_sub(n,
                     vec3_scale(face->edge[i], vec3_dot(n, face->edge[i]) / face->edge_square[i]));
    return vec3_scale(n, 1.0 / vec3_length(n));
}

/* Uses a corner that brings the point no nearer: the direction n must be orthogonal to this
 * corner's edge too. Returns false if the corner lies ahead or is known already. */
static bool constrain(struct face *face, const struct corner *corner, struct vec3 n)
{
    double share[3];
    if (face->edges >= 2 || !span(face, corner, share))
        return false;
    double ahead = vec3_dot(face->edge[face->edges - 1], n);
    return ahead * ahead < 0.25 * face->edge_square[face->edges - 1];
}

/* The bounds of a distance found so far: the nearest simplex (upper bound) and the best separating
 * plane (lower bound). */
struct known {
    struct simplex simplex[2]; /* the nearest one, and that of the search */
    uint32_t nearest;          /* which is the nearest */
    double square;             /* of its distance */
    struct vec3 normal;
    double apart;
    double enough; /* with a plane that separates the bodies by more the search ends */
};

/* Returns the simplex of the search. */
static struct simplex *searched(struct known *known)
{
    return &known->simplex[1 - known->nearest];
}

/* Keeps the simplex of the search, which goes on, if it is nearer. */
static void keep(struct known *known)
{
    const struct simplex *simplex = searched(known);
    if (!(simplex->face.square < known->square))
        return;
    known->square = simplex->face.square;
    settle(&known->simplex[known->nearest], &simplex->face);
}

/* The same when the search is over. */
static void keep_last(struct known *known)
{
    double square = searched(known)->face.square;
    if (!(square < known->square))
        return;
    known->square = square;
    known->nearest = 1 - known->nearest;
}

/* Returns true if a distance agrees with its lower bound. */
static bool certain(double length, double apart, double slack)
{
    return length <= GJK_OVERLAP_M || length - apart <= slack + NEAR_SHARE * length;
}

/* Returns true if the bodies are farther apart than anyone asks. */
static bool far(const struct known *known)
{
    return known->apart > known->enough;
}

/* Sets up the first simplex from the corners in start. Mostly the origin still projects into all of
 * them; else they are added one by one. */
static void begin_warm(const struct convex *a, const struct convex *b,
                       const struct gjk_start *start, struct simplex *simplex)
{
    uint32_t last = start->count - 1;
    struct corner corner[3];
    simplex->face.count = (int)start->count;
    for (uint32_t i = 0; i < start->count; i++) {
        simplex->corner[last - i] = corner[i] = corner_of(a, b, start->a[i], start->b[i]);
        simplex->face.corner[last - i] = &simplex->corner[last - i];
    }
    if (project(&simplex->face))
        return;
    struct face face = {.corner[0] = &corner[0], .count = 1};
    (void)project(&face); /* always possible for a single point */
    settle(simplex, &face);
    for (uint32_t i = 1; i < start->count; i++)
        (void)add_corner(simplex, &corner[i], simplex->face.square);
}

/* Sets up the first simplex. */
static void begin(const struct convex *a, const struct convex *b, const struct gjk_start *start,
                  struct simplex *simplex)
{
    if (start->count > 0) {
        begin_warm(a, b, start, simplex);
        return;
    }
    struct corner corner = corner_along(a, b, start->guess);
    struct face face = {.corner[0] = &corner, .count = 1};
    (void)project(&face);
    settle(simplex, &face);
}

/* Runs one search. */
static void search_once(const struct convex *a, const struct convex *b,
                        const struct gjk_start *start, struct known *known)
{
    struct corner corner;
    struct simplex *simplex = searched(known);
    int ties = 0;
    begin(a, b, start, simplex);
    for (int round = 0; round < ROUNDS; round++) {
        double square = simplex->face.square, length = sqrt(square);
        if (certain(length, known->apart, NEAR_M))
            break;
        struct vec3 n = towards_origin(&simplex->face, length);
        corner = corner_along(a, b, n);
        double apart = -vec3_dot(n, corner.w);
        if (apart > known->apart) {
            known->apart = apart;
            known->normal = n;
        }
        if (far(known) || certain(length, known->apart, NEAR_M) || holds(simplex, &corner))
            break;
        if (add_corner(simplex, &corner, square))
            continue;
        keep(known);
        if (ties++ < TIES && add_corner(simplex, &corner, square * (1.0 + TIE)))
            continue;
        if (!constrain(&simplex->face, &corner, n))
            break;
    }
    keep_last(known);
}

static struct gjk result(const struct convex *a, const struct convex *b, const struct known *known)
{
    const struct simplex *nearest = &known->simplex[known->nearest];
    struct gjk gjk = {.on_a = a->at, .on_b = b->at, .corners = (uint32_t)nearest->face.count};
    for (int i = 0; i < nearest->face.count; i++) {
        const struct corner *corner = &nearest->corner[i];
        gjk.corner[i] = corner->w;
        double weight = nearest->face.weight[i];
        gjk.on_a = vec3_add(gjk.on_a, vec3_scale(gjk_vertex(a, corner->a), weight));
        gjk.on_b = vec3_add(gjk.on_b, vec3_scale(gjk_vertex(b, corner->b), weight));
    }
    gjk.distance_m = sqrt(known->square);
    gjk.normal = known->normal;
    if (gjk.distance_m <= GJK_OVERLAP_M) {
        gjk.on_a = vec3_lerp(gjk.on_a, gjk.on_b, 0.5);
        gjk.on_b = gjk.on_a;
        gjk.distance_m = 0.0;
        gjk.normal = (struct vec3){0.0, 0.0, 0.0};
    }
    return gjk;
}

double gjk_most_apart(const struct gjk *gjk, struct vec3 normal)
{
    double most = -vec3_dot(normal, gjk->corner[0]);
    for (uint32_t i = 1; i < gjk->corners; i++)
        most = maths_min(most, -vec3_dot(normal, gjk->corner[i]));
    return most;
}

struct gjk gjk_distance_within(const struct convex *a, const struct convex *b, double limit_m,
                               struct gjk_start *start)
{
    struct known known;
    known.simplex[0].face.count = 0; /* the first search always finds a nearer one */
    known.nearest = 0;
    known.square = INFINITY;
    known.normal = (struct vec3){0.0, 0.0, 0.0};
    known.apart = -INFINITY;
    known.enough = limit_m + GJK_OVERLAP_M + SURE_M;
    search_once(a, b, start, &known);
    for (int other = 0;
         other < SEARCHES && !far(&known) && !certain(sqrt(known.square), known.apart, SURE_M);
         other++) {
        const struct gjk_start elsewhere = {
            .guess = {other & 1 ? -1.0 : 1.0, other & 2 ? -1.0 : 1.0, other & 4 ? -1.0 : 1.0}};
        search_once(a, b, &elsewhere, &known);
    }
    const struct simplex *nearest = &known.simplex[known.nearest];
    start->count = nearest->face.count < 4 ? (uint32_t)nearest->face.count : 0;
    for (uint32_t i = 0; i < start->count; i++) {
        start->a[i] = nearest->corner[i].a;
        start->b[i] = nearest->corner[i].b;
    }
    struct gjk gjk = result(a, b, &known);
    if (far(&known))
        gjk.distance_m = known.apart;
    return gjk;
}

struct gjk gjk_distance_from(const struct convex *a, const struct convex *b,
                             struct gjk_start *start)
{
    return gjk_distance_within(a, b, INFINITY, start);
}

struct gjk gjk_distance(const struct convex *a, const struct convex *b)
{
    struct gjk_start start = {.guess = vec3_sub(b->at, a->at)};
    return gjk_distance_from(a, b, &start);
}
