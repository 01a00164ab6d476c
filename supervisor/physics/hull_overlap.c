/* Separating axes of two hulls, in the axes of the first body, so that numbers are small. */
#include "supervisor/physics/hull_overlap.h"

#define PARALLEL 1e-6 /* sine of the angle between two edges that have no common normal */

struct relative_place hull_overlap_place(const struct rigid_pose *a, const struct rigid_pose *b,
                                         double scale)
{
    return (struct relative_place){.at = rigid_pose_in(a, vec3_sub(b->at, a->at)),
                                   .forward = rigid_pose_in(a, b->forward),
                                   .up = rigid_pose_in(a, b->up),
                                   .right = rigid_pose_in(a, b->right),
                                   .scale = scale};
}

static struct vec3 turned(const struct relative_place *place, struct vec3 body)
{
    return vec3_add(vec3_scale(place->forward, body.x),
                    vec3_add(vec3_scale(place->up, body.y), vec3_scale(place->right, body.z)));
}

static struct vec3 turned_back(const struct relative_place *place, struct vec3 direction)
{
    return (struct vec3){vec3_dot(place->forward, direction), vec3_dot(place->up, direction),
                         vec3_dot(place->right, direction)};
}

static struct vec3 placed(const struct relative_place *place, struct vec3 body)
{
    return vec3_add(place->at, vec3_scale(turned(place, body), place->scale));
}

static struct vec3 reversed(struct vec3 v)
{
    return vec3_scale(v, -1.0);
}

double hull_overlap_along(const struct hull_shape *a, const struct hull_shape *b,
                          const struct relative_place *place, struct vec3 axis)
{
    double back = hull_shape_reach(b, reversed(turned_back(place, axis)));
    return vec3_dot(axis, place->at) - place->scale * back - hull_shape_reach(a, axis);
}

/* The search for the axis of the greatest separation. */
struct search {
    const struct hull_shape *a, *b;
    const struct relative_place *place;
    double enough, best;
    struct vec3 axis;
};

/* Returns true if the search can end. */
static bool take(struct search *search, double separation, struct vec3 axis)
{
    if (separation > search->best) {
        search->best = separation;
        search->axis = axis;
    }
    return search->best > search->enough;
}

static bool try_faces(struct search *search)
{
    const struct hull_shape *a = search->a, *b = search->b;
    const struct relative_place *place = search->place;
    for (uint32_t i = 0; i < a->faces; i++) {
        struct vec3 axis = a->face[i].normal;
        double back = hull_shape_reach(b, reversed(turned_back(place, axis)));
        double nearest = vec3_dot(axis, place->at) - place->scale * back;
        if (take(search, nearest - a->face[i].offset_m, axis))
            return true;
    }
    for (uint32_t i = 0; i < b->faces; i++) {
        struct vec3 axis = reversed(turned(place, b->face[i].normal));
        double nearest = vec3_dot(axis, place->at) - place->scale * b->face[i].offset_m;
        if (take(search, nearest - hull_shape_reach(a, axis), axis))
            return true;
    }
    return false;
}

/* An edge of one hull with the normals of its faces. Those of the second hull are turned round. */
struct arc {
    struct vec3 from, to; /* unit */
    struct vec3 across;   /* from x to: along the edge */
    struct vec3 along;    /* the same, from vertex to vertex */
};

static struct arc arc_of(const struct hull_shape *shape, const struct hull_edge *edge)
{
    struct vec3 p = shape->vertex[edge->vertex[0]], q = shape->vertex[edge->vertex[1]];
    struct vec3 from = shape->face[edge->face[0]].normal;
    struct vec3 to = shape->face[edge->face[1]].normal;
    return (struct arc){from, to, vec3_cross(from, to), vec3_sub(q, p)};
}

static struct arc placed_arc(const struct relative_place *place, struct arc arc)
{
    arc.from = reversed(turned(place, arc.from));
    arc.to = reversed(turned(place, arc.to));
    arc.across = vec3_cross(arc.from, arc.to);
    arc.along = turned(place, arc.along);
    return arc;
}

/* Two edges give a face of the hulls' difference if the arcs between their faces' normals cross on
 * the sphere of directions (Gauss map). Other pairs of edges cannot be the shallowest axis. */
static bool arcs_cross(const struct arc *p, const struct arc *q)
{
    double a = vec3_dot(p->across, q->from), b = vec3_dot(p->across, q->to);
    double c = vec3_dot(q->across, p->from), d = vec3_dot(q->across, p->to);
    return a * b < 0.0 && c * d < 0.0 && a * d > 0.0;
}

/* Returns true if the search can end. */
static bool try_edges(struct search *search, const struct arc *p, const struct arc *q)
{
    struct vec3 axis = vec3_cross(p->along, q->along);
    double length = vec3_length(axis);
    if (length <= PARALLEL * vec3_length(p->along) * vec3_length(q->along))
        return false;
    axis = vec3_scale(axis, 1.0 / length);
    if (vec3_dot(axis, vec3_add(p->from, p->to)) < 0.0)
        axis = reversed(axis); /* outwards from the first hull */
    return take(search, hull_overlap_along(search->a, search->b, search->place, axis), axis);
}

static void try_all_edges(struct search *search)
{
    const struct hull_shape *a = search->a, *b = search->b;
    for (uint32_t i = 0; i < b->edges; i++) {
        const struct arc q = placed_arc(search->place, arc_of(b, &b->edge[i]));
        for (uint32_t j = 0; j < a->edges; j++) {
            const struct arc p = arc_of(a, &a->edge[j]);
            if (arcs_cross(&p, &q) && try_edges(search, &p, &q))
                return;
        }
    }
}

/* Tries the known axis and all faces. Returns true if the search can end. */
static bool try_planes(struct search *search, struct vec3 known)
{
    bool tried = vec3_dot(known, known) > 0.0;
    return (tried &&
            take(search, hull_overlap_along(search->a, search->b, search->place, known), known)) ||
           try_faces(search);
}

bool hull_overlap_far(const struct hull_shape *a, const struct hull_shape *b,
                      const struct relative_place *place, double enough, struct vec3 *axis)
{
    struct search search = {.a = a, .b = b, .place = place, .enough = enough, .best = -HUGE_VAL};
    struct vec3 between = vec3_sub(placed(place, b->centre), a->centre);
    double reach = a->radius_m + b->radius_m * place->scale + enough;
    if (vec3_dot(between, between) > reach * reach)
        return true;
    if (!try_planes(&search, *axis))
        return false;
    *axis = search.axis;
    return true;
}

double hull_overlap_find(const struct hull_shape *a, const struct hull_shape *b,
                         const struct relative_place *place, double enough, struct vec3 *axis)
{
    struct search search = {.a = a, .b = b, .place = place, .enough = enough, .best = -HUGE_VAL};
    /* Hulls that a face separates do not overlap, and no edge has to say so. */
    if (!try_planes(&search, *axis) && search.best <= 0.0)
        try_all_edges(&search);
    *axis = search.axis;
    return search.best;
}
