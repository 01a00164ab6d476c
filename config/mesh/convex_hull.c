/* Makes a convex hull by adding points to a tetrahedron. A point outside removes the triangles that
 * face it, and new triangles connect it with the edge of the hole. */
#include "config/mesh/convex_hull.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A triangle is slim when twice its area is less than this share of the product of two sides. Its
 * normal is then computed exactly. The normals of other triangles have an error below 4e-14, so
 * that the distance of a point from a plane has an error below SURE_M [m]. */
#define SLIM_SHARE 0.01
#define SURE_M     1e-9

__extension__ typedef __int128 wide;

/* A hull while it grows. Its triangles are in no order. */
struct wrapping {
    struct vec3 *point;
    uint32_t count;
    struct convex_hull_face *face;
    uint32_t face_count;
    uint32_t (*edge)[2]; /* around the triangles that are removed */
    uint32_t edge_count;
};

int convex_hull_compare(const void *left, const void *right)
{
    const struct vec3 *a = left, *b = right;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    if (a->y < b->y || a->y > b->y)
        return a->y < b->y ? -1 : 1;
    return (a->z > b->z) - (a->z < b->z);
}

static struct vec3 unit(struct vec3 v)
{
    return vec3_scale(v, 1.0 / vec3_length(v));
}

/* --- the axes that points span -----------------------------------------------------------------*/

/* Up to four points that span as many axes as all points: the first, the furthest from it, the
 * furthest from their line, the furthest from their plane. */
struct span {
    int axes;           /* spanned by more than least_m; corner has one entry more */
    uint32_t corner[4]; /* indices */
    struct vec3 along;  /* axes >= 1: unit vector along the line */
    struct vec3 normal; /* axes >= 2: unit normal of the plane */
};

/* Distance of a point from the point, line or plane that is spanned. from: relative to corner[0].
 */
static double distance(const struct span *span, struct vec3 from)
{
    if (span->axes == 0)
        return vec3_length(from);
    return span->axes == 1 ? vec3_length(vec3_cross(span->along, from))
                           : fabs(vec3_dot(span->normal, from));
}

static struct span span_of(const struct vec3 *point, uint32_t count, double least_m)
{
    struct span span = {0};
    while (span.axes < 3) {
        double best = least_m;
        uint32_t found = 0;
        for (uint32_t i = 1; i < count; i++) {
            double away = distance(&span, vec3_sub(point[i], point[0]));
            if (away > best) {
                best = away;
                found = i;
            }
        }
        if (found == 0)
            break;
        struct vec3 to = vec3_sub(point[found], point[0]);
        if (span.axes == 0)
            span.along = unit(to);
        if (span.axes == 1)
            span.normal = unit(vec3_cross(span.along, to));
        span.corner[++span.axes] = found;
    }
    return span;
}

int convex_hull_missing(const struct vec3 *point, uint32_t count, double least_m,
                        struct vec3 axis[3])
{
    const struct vec3 x = {1.0, 0.0, 0.0}, y = {0.0, 1.0, 0.0}, z = {0.0, 0.0, 1.0};
    struct span span = span_of(point, count, least_m);
    switch (span.axes) {
    case 0:
        axis[0] = x;
        axis[1] = y;
        axis[2] = z;
        break;
    case 1:
        axis[0] = unit(vec3_cross(span.along, fabs(span.along.y) < 0.5 ? y : x));
        axis[1] = vec3_cross(span.along, axis[0]);
        break;
    default:
        axis[0] = span.normal;
        break;
    }
    return 3 - span.axes;
}

/* --- growing a hull ----------------------------------------------------------------------------*/

static struct vec3 snap(struct vec3 p)
{
    return (struct vec3){floor(p.x * CONVEX_HULL_STEPS + 0.5) / CONVEX_HULL_STEPS,
                         floor(p.y * CONVEX_HULL_STEPS + 0.5) / CONVEX_HULL_STEPS,
                         floor(p.z * CONVEX_HULL_STEPS + 0.5) / CONVEX_HULL_STEPS};
}

static int64_t steps(double metres)
{
    return (int64_t)(metres * CONVEX_HULL_STEPS);
}

/* The exact cross product in steps: differences have 33 bits, sums of two products 67 bits. */
static void cross_exactly(struct vec3 u, struct vec3 v, wide product[3])
{
    int64_t ux = steps(u.x), uy = steps(u.y), uz = steps(u.z);
    int64_t vx = steps(v.x), vy = steps(v.y), vz = steps(v.z);
    product[0] = (wide)uy * vz - (wide)uz * vy;
    product[1] = (wide)uz * vx - (wide)ux * vz;
    product[2] = (wide)ux * vy - (wide)uy * vx;
}

/* Sum of the absolute components of a vector. */
static double extent(struct vec3 v)
{
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

static void add_face(struct wrapping *w, uint32_t a, uint32_t b, uint32_t c)
{
    struct convex_hull_face *face = &w->face[w->face_count++];
    struct vec3 at = w->point[a], u = vec3_sub(w->point[b], at), v = vec3_sub(w->point[c], at);
    struct vec3 normal = vec3_cross(u, v);
    double length = vec3_length(normal);
    if (length < SLIM_SHARE * extent(u) * extent(v)) {
        const double square = CONVEX_HULL_STEPS * CONVEX_HULL_STEPS;
        wide product[3];
        cross_exactly(u, v, product);
        normal = (struct vec3){(double)product[0] / square, (double)product[1] / square,
                               (double)product[2] / square};
        length = vec3_length(normal);
    }
    face->corner[0] = a;
    face->corner[1] = b;
    face->corner[2] = c;
    face->normal = vec3_scale(normal, 1.0 / length);
    face->offset_m = vec3_dot(face->normal, at);
    face->area_m2 = 0.5 * length;
}

/* Returns true if the point is on the outer side of the triangle's plane. */
static bool is_above(const struct wrapping *w, const struct convex_hull_face *face, struct vec3 p)
{
    double above = vec3_dot(face->normal, p) - face->offset_m;
    if (fabs(above) > SURE_M)
        return above > 0.0;
    struct vec3 at = w->point[face->corner[0]], to = vec3_sub(p, at);
    wide product[3];
    cross_exactly(vec3_sub(w->point[face->corner[1]], at), vec3_sub(w->point[face->corner[2]], at),
                  product);
    return product[0] * steps(to.x) + product[1] * steps(to.y) + product[2] * steps(to.z) > 0;
}

static void begin(struct wrapping *w, const struct span *span)
{
    uint32_t a = span->corner[0], b = span->corner[1], c = span->corner[2], d = span->corner[3];
    /* a, b, c are counter-clockwise as seen from the side away from d. */
    if (vec3_dot(span->normal, vec3_sub(w->point[d], w->point[a])) > 0.0) {
        b = span->corner[2];
        c = span->corner[1];
    }
    add_face(w, a, b, c);
    add_face(w, a, d, b);
    add_face(w, b, d, c);
    add_face(w, c, d, a);
}

static void add_edge(struct wrapping *w, uint32_t from, uint32_t to)
{
    /* An edge between two removed triangles occurs in both directions, and is removed too. */
    for (uint32_t i = 0; i < w->edge_count; i++) {
        if (w->edge[i][0] == to && w->edge[i][1] == from) {
            w->edge_count--;
            memcpy(w->edge[i], w->edge[w->edge_count], sizeof(w->edge[i]));
            return;
        }
    }
    w->edge[w->edge_count][0] = from;
    w->edge[w->edge_count++][1] = to;
}

static void add_point(struct wrapping *w, uint32_t point)
{
    struct vec3 p = w->point[point];
    w->edge_count = 0;
    for (uint32_t i = w->face_count; i > 0; i--) {
        const struct convex_hull_face *face = &w->face[i - 1];
        if (!is_above(w, face, p))
            continue;
        for (int k = 0; k < 3; k++)
            add_edge(w, face->corner[k], face->corner[(k + 1) % 3]);
        w->face[i - 1] = w->face[--w->face_count];
    }
    for (uint32_t i = 0; i < w->edge_count; i++)
        add_face(w, w->edge[i][0], w->edge[i][1], point);
}

/* Adds the points from `from` on. 0; -1 with errno ERANGE. */
static int add_points(struct wrapping *w, uint32_t from)
{
    for (uint32_t i = from; i < w->count; i++) {
        add_point(w, i);
        if (w->face_count > CONVEX_HULL_FACES_MAX) {
            errno = ERANGE;
            return -1;
        }
    }
    return 0;
}

/* The sum of the pyramids from one vertex of the hull to all triangles. */
static double volume_of(const struct wrapping *w)
{
    struct vec3 tip = w->point[w->face[0].corner[0]];
    double volume = 0.0;
    for (uint32_t i = 0; i < w->face_count; i++) {
        const struct convex_hull_face *face = &w->face[i];
        volume += face->area_m2 * (face->offset_m - vec3_dot(face->normal, tip));
    }
    return volume / 3.0;
}

/* Copies the hull, with new indices of its points, into memory of the right size. */
static int finish(struct convex_hull *hull, const struct wrapping *w)
{
    uint32_t *number = calloc(w->count, sizeof(*number)); /* new index + 1; 0: not a vertex */
    hull->point = malloc(w->count * sizeof(*hull->point));
    hull->face = malloc(w->face_count * sizeof(*hull->face));
    if (number == NULL || hull->point == NULL || hull->face == NULL) {
        free(number);
        convex_hull_free(hull);
        return -1;
    }
    hull->face_count = w->face_count;
    memcpy(hull->face, w->face, w->face_count * sizeof(*hull->face));
    for (uint32_t i = 0; i < hull->face_count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t *corner = &hull->face[i].corner[k];
            if (number[*corner] == 0) {
                hull->point[hull->point_count++] = w->point[*corner];
                number[*corner] = hull->point_count;
            }
            *corner = number[*corner] - 1;
        }
    }
    free(number);
    for (uint32_t i = 0; i < hull->point_count; i++)
        hull->middle = vec3_add(hull->middle, hull->point[i]);
    hull->middle = vec3_scale(hull->middle, 1.0 / hull->point_count);
    hull->volume_m3 = volume_of(w);
    return 0;
}

/* Allocates room for count points. A closed surface of triangles over n points has 2 n - 4
 * triangles, and each has three edges. */
static int open_wrapping(struct wrapping *w, uint32_t count)
{
    uint32_t faces = count < CONVEX_HULL_FACES_MAX / 2 ? 2 * count : CONVEX_HULL_FACES_MAX + 2;
    memset(w, 0, sizeof(*w));
    w->count = count;
    w->point = malloc(count * sizeof(*w->point));
    w->face = malloc(faces * sizeof(*w->face));
    w->edge = malloc((size_t)faces * 3 * sizeof(*w->edge));
    return w->point != NULL && w->face != NULL && w->edge != NULL ? 0 : -1;
}

static void close_wrapping(struct wrapping *w)
{
    free(w->point);
    free(w->face);
    free(w->edge);
}

/* --- points ------------------------------------------------------------------------------------*/

struct ranked {
    struct vec3 point;
    double out; /* square of its distance from the middle */
};

static int compare_ranked(const void *left, const void *right)
{
    const struct ranked *a = left, *b = right;
    if (a->out > b->out || a->out < b->out)
        return a->out > b->out ? -1 : 1;
    return convex_hull_compare(&a->point, &b->point);
}

/* Snaps the points to the lattice, the furthest from their middle first: then most of the others
 * are inside. */
static int rank_points(struct vec3 *to, const struct vec3 *point, uint32_t count)
{
    struct ranked *ranked = malloc(count * sizeof(*ranked));
    struct vec3 middle = {0.0, 0.0, 0.0};
    if (ranked == NULL)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        middle = vec3_add(middle, point[i]);
    middle = vec3_scale(middle, 1.0 / count);
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 out = vec3_sub(point[i], middle);
        ranked[i] = (struct ranked){point[i], vec3_dot(out, out)};
    }
    qsort(ranked, count, sizeof(*ranked), compare_ranked);
    for (uint32_t i = 0; i < count; i++)
        to[i] = snap(ranked[i].point);
    free(ranked);
    return 0;
}

static int convex_hull_ranked(struct wrapping *w, struct convex_hull *hull)
{
    struct span span = span_of(w->point, w->count, CONVEX_HULL_THIN_M);
    if (span.axes < 3) {
        errno = EDOM;
        return -1;
    }
    begin(w, &span);
    return add_points(w, 0) == 0 ? finish(hull, w) : -1;
}

int convex_hull_points(struct convex_hull *hull, const struct vec3 *point, uint32_t count)
{
    struct wrapping w;
    int result = -1;
    memset(hull, 0, sizeof(*hull));
    if (count == 0) {
        errno = EDOM;
        return -1;
    }
    if (open_wrapping(&w, count) == 0 && rank_points(w.point, point, count) == 0)
        result = convex_hull_ranked(&w, hull);
    close_wrapping(&w);
    return result;
}

void convex_hull_free(struct convex_hull *hull)
{
    free(hull->point);
    free(hull->face);
    memset(hull, 0, sizeof(*hull));
}

/* --- two hulls ---------------------------------------------------------------------------------*/

/* Begins with the hull that has more points and adds the points of the other. */
static int add_both(struct wrapping *w, const struct convex_hull *a, const struct convex_hull *b)
{
    const struct convex_hull *large = a->point_count >= b->point_count ? a : b;
    const struct convex_hull *small = large == a ? b : a;
    memcpy(w->point, large->point, large->point_count * sizeof(*w->point));
    memcpy(w->point + large->point_count, small->point, small->point_count * sizeof(*w->point));
    memcpy(w->face, large->face, large->face_count * sizeof(*w->face));
    w->face_count = large->face_count;
    return add_points(w, large->point_count);
}

int convex_hull_both(struct convex_hull *hull, const struct convex_hull *a,
                     const struct convex_hull *b)
{
    struct wrapping w;
    int result = -1;
    memset(hull, 0, sizeof(*hull));
    if (open_wrapping(&w, a->point_count + b->point_count) == 0 && add_both(&w, a, b) == 0)
        result = finish(hull, &w);
    close_wrapping(&w);
    return result;
}

int convex_hull_volume(double *volume_m3, const struct convex_hull *a, const struct convex_hull *b)
{
    struct wrapping w;
    int result = -1;
    if (open_wrapping(&w, a->point_count + b->point_count) == 0 && add_both(&w, a, b) == 0) {
        *volume_m3 = volume_of(&w);
        result = 0;
    }
    close_wrapping(&w);
    return result;
}

double convex_hull_growth(const struct convex_hull *hull, struct vec3 point)
{
    double growth = 0.0;
    for (uint32_t i = 0; i < hull->face_count; i++) {
        const struct convex_hull_face *face = &hull->face[i];
        double above = vec3_dot(face->normal, point) - face->offset_m;
        if (above > 0.0)
            growth += above * face->area_m2;
    }
    return growth / 3.0;
}

bool convex_hull_holds(const struct convex_hull *outer, const struct convex_hull *inner,
                       double slack_m)
{
    for (uint32_t i = 0; i < inner->point_count; i++) {
        for (uint32_t k = 0; k < outer->face_count; k++) {
            const struct convex_hull_face *face = &outer->face[k];
            if (vec3_dot(face->normal, inner->point[i]) - face->offset_m > slack_m)
                return false;
        }
    }
    return true;
}
