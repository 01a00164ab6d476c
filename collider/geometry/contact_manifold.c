/* The foremost vertices of each body along the normal have a convex outline. The manifold is one
 * outline clipped by the other (Sutherland and Hodgman 1974), which is widened by the slack. */
#include "collider/geometry/contact_manifold.h"

#include "collider/geometry/vertex_reach.h"
#include "world/entity/hull.h"

#define MERGE_M    1e-6 /* nearer vertices are merged: an edge between them has no direction */
#define ROUNDING_M 1e-9 /* of a vertex's reach, for bodies of up to 100 m */
#define LINES_MAX  (CONTACT_MANIFOLD_POINTS_MAX + 4)

struct uv {
    double u, v;
};

struct outline {
    struct uv point[CONTACT_MANIFOLD_MAX];
    uint32_t count;
};

/* The half-plane u * along.u + v * along.v <= offset. */
struct line {
    struct uv along; /* unit, outwards */
    double offset;
};

/* The plane of projection, across the normal. */
struct view {
    struct vec3 u, v, normal;
};

static struct view view_along(struct vec3 normal)
{
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    struct vec3 least = x <= y && x <= z ? (struct vec3){1.0, 0.0, 0.0}
                        : y <= z         ? (struct vec3){0.0, 1.0, 0.0}
                                         : (struct vec3){0.0, 0.0, 1.0};
    struct vec3 u = vec3_cross(normal, least);
    u = vec3_scale(u, 1.0 / vec3_length(u));
    return (struct view){u, vec3_cross(normal, u), normal};
}

static void add(struct outline *outline, struct uv p)
{
    for (uint32_t i = 0; i < outline->count; i++) {
        double u = outline->point[i].u - p.u, v = outline->point[i].v - p.v;
        if (u * u + v * v < MERGE_M * MERGE_M)
            return;
    }
    if (outline->count < CONTACT_MANIFOLD_POINTS_MAX)
        outline->point[outline->count++] = p;
}

/* Collects the vertices within slack_m of the foremost in a direction, projected relative to
 * origin. *reach is the extent of the foremost in that direction [m]. Most vertices are far behind
 * it, which their reach in the body's own axes shows without turning them. */
static void foremost(const struct convex *convex, struct vec3 origin, const struct view *view,
                     double side, double slack_m, double *reach, struct outline *outline)
{
    struct vec3 direction = vec3_scale(view->normal, side);
    struct vec3 own = rotation_back(&convex->turn, direction);
    double ahead[HULL_VERTICES_MAX];
    uint32_t best = vertex_reach_each(convex->vertex, convex->count, own, ahead);
    struct vec3 most = gjk_vertex(convex, best);
    double edge = vec3_dot(most, direction) - slack_m;
    double least = ahead[best] - (slack_m + ROUNDING_M) / convex->scale;
    struct vec3 at = vec3_sub(convex->at, origin);
    outline->count = 0;
    for (uint32_t i = 0; i < convex->count; i++) {
        if (ahead[i] < least)
            continue;
        struct vec3 p = gjk_vertex(convex, i);
        if (vec3_dot(p, direction) < edge)
            continue;
        p = vec3_add(p, at);
        add(outline, (struct uv){vec3_dot(p, view->u), vec3_dot(p, view->v)});
    }
    *reach = vec3_dot(vec3_add(most, at), view->normal);
}

static double left_of(struct uv a, struct uv b, struct uv p)
{
    return (b.u - a.u) * (p.v - a.v) - (p.u - a.u) * (b.v - a.v);
}

/* Sorts by u, then v: few points. */
static void sort(struct outline *outline)
{
    for (uint32_t i = 1; i < outline->count; i++) {
        struct uv p = outline->point[i];
        uint32_t j = i;
        for (; j > 0; j--) {
            struct uv q = outline->point[j - 1];
            if (q.u < p.u || (q.u == p.u && q.v <= p.v))
                break;
            outline->point[j] = q;
        }
        outline->point[j] = p;
    }
}

/* Reduces the points to their convex outline, anticlockwise (Andrew 1979). */
static void wrap(struct outline *outline)
{
    struct uv chain[2 * CONTACT_MANIFOLD_POINTS_MAX];
    uint32_t count = 0, points = outline->count;
    if (points < 3)
        return;
    sort(outline);
    for (uint32_t pass = 0; pass < 2; pass++) {
        uint32_t first = count;
        for (uint32_t i = 0; i < points; i++) {
            struct uv p = outline->point[pass == 0 ? i : points - 1 - i];
            while (count >= first + 2 && left_of(chain[count - 2], chain[count - 1], p) <= 0.0)
                count--;
            chain[count++] = p;
        }
        count--; /* the other chain begins with this point */
    }
    for (uint32_t i = 0; i < count; i++)
        outline->point[i] = chain[i];
    outline->count = count;
}

static struct line line_through(struct uv p, double along_u, double along_v)
{
    double length = sqrt(along_u * along_u + along_v * along_v);
    struct uv along = {along_u / length, along_v / length};
    return (struct line){along, along.u * p.u + along.v * p.v + CONTACT_MANIFOLD_SLACK_M};
}

/* What bounds an outline, widened by the slack. */
static uint32_t lines_of(const struct outline *outline, struct line line[LINES_MAX])
{
    uint32_t lines = 0;
    if (outline->count == 1) {
        line[lines++] = line_through(outline->point[0], 1.0, 0.0);
        line[lines++] = line_through(outline->point[0], -1.0, 0.0);
        line[lines++] = line_through(outline->point[0], 0.0, 1.0);
        line[lines++] = line_through(outline->point[0], 0.0, -1.0);
        return lines;
    }
    for (uint32_t i = 0; i < outline->count; i++) {
        struct uv p = outline->point[i], q = outline->point[(i + 1) % outline->count];
        line[lines++] = line_through(p, q.v - p.v, p.u - q.u);
        if (outline->count == 2) /* an edge also needs bounds at its ends */
            line[lines++] = line_through(q, q.u - p.u, q.v - p.v);
    }
    return lines;
}

static double beyond(const struct line *line, struct uv p)
{
    return line->along.u * p.u + line->along.v * p.v - line->offset;
}

/* Cuts off what is beyond the line, by way of the buffer cut. */
static void clip(struct outline *outline, const struct line *line, struct outline *cut)
{
    cut->count = 0;
    for (uint32_t i = 0; i < outline->count && cut->count + 2 <= CONTACT_MANIFOLD_MAX; i++) {
        struct uv p = outline->point[i], q = outline->point[(i + 1) % outline->count];
        double out_p = beyond(line, p), out_q = beyond(line, q);
        if (out_p <= 0.0)
            cut->point[cut->count++] = p;
        if ((out_p < 0.0 && out_q > 0.0) || (out_p > 0.0 && out_q < 0.0)) {
            double t = out_p / (out_p - out_q);
            cut->point[cut->count++] = (struct uv){p.u + (q.u - p.u) * t, p.v + (q.v - p.v) * t};
        }
    }
    for (uint32_t i = 0; i < cut->count; i++)
        outline->point[i] = cut->point[i];
    outline->count = cut->count;
}

static struct uv middle_of(const struct outline *outline)
{
    struct uv sum = {0.0, 0.0};
    double length = 0.0;
    for (uint32_t i = 0; i < outline->count; i++) {
        struct uv p = outline->point[i], q = outline->point[(i + 1) % outline->count];
        double edge = sqrt((q.u - p.u) * (q.u - p.u) + (q.v - p.v) * (q.v - p.v));
        sum.u += 0.5 * (p.u + q.u) * edge;
        sum.v += 0.5 * (p.v + q.v) * edge;
        length += edge;
    }
    return length > 0.0 ? (struct uv){sum.u / length, sum.v / length} : outline->point[0];
}

bool contact_manifold_between(const struct convex *a, const struct convex *b, struct vec3 normal,
                              struct contact_manifold *patch)
{
    return contact_manifold_within(a, b, normal, CONTACT_MANIFOLD_SLACK_M, patch);
}

bool contact_manifold_within(const struct convex *a, const struct convex *b, struct vec3 normal,
                             double slack_m, struct contact_manifold *patch)
{
    struct view view = view_along(normal);
    struct outline outline[2], cut;
    struct line line[LINES_MAX];
    double reach_a, reach_b;
    foremost(a, a->at, &view, 1.0, slack_m, &reach_a, &outline[0]);
    foremost(b, a->at, &view, -1.0, slack_m, &reach_b, &outline[1]);
    wrap(&outline[0]);
    wrap(&outline[1]);
    bool swap = outline[1].count < outline[0].count; /* a point on a face remains a point */
    struct outline *left = &outline[swap], *by = &outline[!swap];
    uint32_t lines = lines_of(by, line);
    for (uint32_t i = 0; i < lines && left->count > 0; i++)
        clip(left, &line[i], &cut);
    if (left->count == 0)
        return false;
    struct vec3 plane = vec3_add(a->at, vec3_scale(normal, 0.5 * (reach_a + reach_b)));
    struct uv middle = middle_of(left);
    patch->count = left->count;
    for (uint32_t i = 0; i < left->count; i++)
        patch->corner[i] = vec3_add(plane, vec3_add(vec3_scale(view.u, left->point[i].u),
                                                    vec3_scale(view.v, left->point[i].v)));
    patch->middle =
        vec3_add(plane, vec3_add(vec3_scale(view.u, middle.u), vec3_scale(view.v, middle.v)));
    return true;
}
