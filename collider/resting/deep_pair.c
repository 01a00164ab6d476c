/* Capsules in the inner shapes of bodies. */
#include "collider/resting/deep_pair.h"

#include "collider/response/contact_impulse.h"
#include "collider/resting/begun_bodies.h"
#include "collider/resting/resting.h"
#include "world/world.h"

/* Capsules nearer than this share of the sum of their radii are deep in each other. */
#define DEEP 0.9

/* Of bodies whose capsules overlap by so many times DEEP_PAIR_M it is enough that they overlap. */
#define SURELY -2.0

/* Bodies whose capsules are nearer may overlap: most of them have square corners [m]. */
#define NEAR_M 1.0

/* A body whose up axis has a smaller upward part leans too much to cover the capsule: by 60
 * degrees. */
#define STANDS_UP 0.5

/* The least level part of a face's normal, squared: a lesser one is rounding. */
#define LEVEL_FACE 1e-12

/* Places inside two bodies that are looked at. */
#define INSIDE_POINTS 4u

/* Bodies at one place part as if they were so far apart, times the root of their ids [m]. */
#define COINCIDENT_M 1e-4
#define GOLDEN_ANGLE 2.399963229728653 /* [rad] */

/* Returns true if the body covers its capsule. Aircraft do not, because they are fuselages with
 * wings and rotors, nor do ships, whose bows are narrow, nor does a wreck on its side. */
static bool fills_capsule(const struct kind *kind, double up)
{
    return kind->domain == DOMAIN_LAND && up >= STANDS_UP;
}

void deep_pair_place(const struct response_context *context, uint32_t row, double *x, double *z)
{
    double id = context->next->entities.row[row].id, sine, cosine;
    struct vec3 at = context->path[row].at;
    maths_sincos(maths_wrap_turn(GOLDEN_ANGLE * id), &sine, &cosine);
    double far = COINCIDENT_M * sqrt(id);
    *x = at.x + far * cosine;
    *z = at.z + far * sine;
}

double deep_pair_level(const struct response_context *context, uint32_t row)
{
    const struct entities *e = body_motion_before(context->motion, row);
    double sine, nose, side;
    maths_sincos(e->row[row].pitch, &sine, &nose);
    maths_sincos(e->row[row].roll, &sine, &side);
    return maths_max(STANDS_UP, nose * side);
}

struct capsule deep_pair_capsule(const struct response_context *context, uint32_t row)
{
    const struct entities *e = body_motion_before(context->motion, row);
    const struct kind *kind = contact_impulse_kind(context, row);
    double sine, cosine, nose, side, wide = maths_min(kind->width_m, kind->length_m);
    maths_sincos(e->row[row].pitch, &sine, &nose);
    maths_sincos(e->row[row].roll, &sine, &side);
    if (!fills_capsule(kind, nose * side))
        return (struct capsule){.radius_m = 0.0};
    double half = 0.5 * DEEP * (kind->length_m - wide) * nose;
    struct capsule capsule = {.radius_m = 0.5 * wide * nose * side};
    maths_sincos(e->row[row].heading, &sine, &cosine);
    capsule.along_x = half * sine;
    capsule.along_z = -half * cosine;
    deep_pair_place(context, row, &capsule.x, &capsule.z);
    return capsule;
}

/* Returns where on a capsule's line the point is nearest, -1 to 1. */
static double nearest_on(const struct capsule *capsule, double x, double z)
{
    double square = capsule->along_x * capsule->along_x + capsule->along_z * capsule->along_z;
    if (square == 0.0)
        return 0.0;
    double dot = (x - capsule->x) * capsule->along_x + (z - capsule->z) * capsule->along_z;
    return maths_clamp(dot / square, -1.0, 1.0);
}

/* Finds the nearest points of two lines that do not cross: one of them is an end. Returns the
 * square of their distance. */
static double nearest(const struct capsule *a, const struct capsule *b, struct vec3 *on_a,
                      struct vec3 *on_b)
{
    double least = INFINITY;
    for (int i = 0; i < 4; i++) {
        const struct capsule *p = i < 2 ? a : b, *q = i < 2 ? b : a;
        double end = i & 1 ? 1.0 : -1.0;
        struct vec3 from = {p->x + end * p->along_x, 0.0, p->z + end * p->along_z};
        double share = nearest_on(q, from.x, from.z);
        struct vec3 to = {q->x + share * q->along_x, 0.0, q->z + share * q->along_z};
        struct vec3 off = vec3_sub(to, from);
        double square = vec3_dot(off, off);
        if (square < least) {
            least = square;
            *on_a = i < 2 ? from : to;
            *on_b = i < 2 ? to : from;
        }
    }
    return least;
}

/* Returns true if the lines cross. Parallel ones do not, nor does one without a length. */
static bool cross(const struct capsule *a, const struct capsule *b)
{
    double x = b->x - a->x, z = b->z - a->z;
    double turn = a->along_x * b->along_z - a->along_z * b->along_x;
    double on_a = x * b->along_z - z * b->along_x, on_b = x * a->along_z - z * a->along_x;
    return turn != 0.0 && fabs(on_a) <= fabs(turn) && fabs(on_b) <= fabs(turn);
}

/* Returns the distance along the normal, below 0 if the capsules overlap. Lines that cross part
 * along the line between their middles. */
static double capsule_gap(const struct capsule *a, const struct capsule *b, struct vec3 *normal,
                          struct vec3 *middle)
{
    double radii = a->radius_m + b->radius_m;
    struct vec3 on_a = {a->x, 0.0, a->z}, on_b = {b->x, 0.0, b->z};
    bool crossing = cross(a, b);
    if (!crossing)
        nearest(a, b, &on_a, &on_b);
    struct vec3 line = vec3_sub(on_b, on_a);
    double distance = vec3_length(line);
    *normal = distance > 0.0 ? vec3_scale(line, 1.0 / distance) : (struct vec3){1.0, 0.0, 0.0};
    *middle = vec3_lerp(on_a, on_b, 0.5);
    return crossing ? -radii : distance - radii;
}

/* Returns how far inside a hull a point is: a ball of this radius around it is within all faces, or
 * a level disc, which a level face hardly bounds. up: the world's up axis for a disc, else NULL;
 * all on the body's axes. Ends with 0 if the radius is no more than least_m. */
static inline double radius_within(const struct hull_plane *plane, uint32_t planes, struct vec3 at,
                                   const struct vec3 *up, double least_m)
{
    double square = INFINITY, level = 1.0; /* the radius is the root of their ratio */
    for (uint32_t i = 0; i < planes; i++) {
        double depth = plane[i].offset_m - vec3_dot(plane[i].normal, at), share = 1.0;
        if (up) {
            double steep = vec3_dot(plane[i].normal, *up);
            share = maths_max(1.0 - steep * steep, LEVEL_FACE);
        }
        if (depth <= 0.0 || depth * depth <= least_m * least_m * share)
            return 0.0;
        if (depth * depth * level < square * share) {
            square = depth * depth;
            level = share;
        }
    }
    return sqrt(square / level);
}

/* Returns how far inside one of the body's hulls the point is, or more than enough_m, wherever its
 * turret points [m]. */
static inline double depth_within(const struct begun_body *begun, struct vec3 point, bool discs,
                                  double enough_m)
{
    const struct swept_body *body = &begun->body;
    struct vec3 at = rotation_back(&begun->began, vec3_sub(point, body->path.at));
    struct vec3 up = rotation_back(&begun->began, (struct vec3){0.0, 1.0, 0.0});
    double deepest = 0.0;
    for (uint32_t i = 0; i < body->hull_count && deepest <= enough_m; i++) {
        const struct hull *hull = &body->hull[i];
        const struct hull_plane *plane = body->planes + hull->first_plane;
        if (hull->part == HULL_PART_BODY)
            deepest = maths_max(
                deepest, radius_within(plane, hull->plane_count, at, discs ? &up : NULL, deepest));
    }
    return deepest;
}

/* Returns true if the bodies overlap by more than depth_m along any level normal, because one of
 * these points is so far inside both. */
static inline bool prove_deep(const struct begun_body *a, const struct begun_body *b,
                              const struct vec3 point[INSIDE_POINTS], bool discs, double depth_m)
{
    for (uint32_t i = 0; i < INSIDE_POINTS; i++) {
        double in_a = depth_within(a, point[i], discs, depth_m);
        double left_m = maths_max(0.0, depth_m - in_a);
        if (in_a > 0.0 && depth_within(b, point[i], discs, left_m) > left_m)
            return true;
    }
    return false;
}

/* Returns true if the bodies themselves are so deep in each other when the frame begins. A hull may
 * be narrower than the capsule at its height: the bonnet of a truck, the trails of a howitzer.
 * Mostly a point over `inside`, which is as deep in both capsules, is inside both bodies, which
 * proves it sooner than a search. */
static bool are_deep(const struct begun_body *a, const struct begun_body *b, struct vec3 inside,
                     struct vec3 up, double height_m, double depth_m)
{
    static const double share[INSIDE_POINTS] = {0.35, 0.5, 0.2, 0.65};
    struct vec3 point[INSIDE_POINTS];
    for (uint32_t i = 0; i < INSIDE_POINTS; i++)
        point[i] = vec3_add(inside, vec3_scale(up, share[i] * height_m));
    if (prove_deep(a, b, point, false, depth_m) || prove_deep(a, b, point, true, depth_m))
        return true;
    const struct turned_body turned_a = {&a->body, a->began}, turned_b = {&b->body, b->began};
    struct level_gap deepest;
    return level_gap_deepest(&turned_a, &turned_b, depth_m, depth_m, &deepest);
}

/* Returns the body's own up axis, along which bodies on one slope stand above each other. */
static struct vec3 up_of(const struct begun_body *body)
{
    return rotation_apply(&body->began, (struct vec3){0.0, 1.0, 0.0});
}

bool deep_pair_measure(const struct response_context *context, const struct pair *pair,
                       const struct begun_body *a, const struct begun_body *b,
                       struct resting_gap *found)
{
    double radii = a->capsule.radius_m + b->capsule.radius_m;
    if (a->capsule.radius_m == 0.0 || b->capsule.radius_m == 0.0)
        return false;
    const struct kind *ka = contact_impulse_kind(context, pair->a);
    const struct kind *kb = contact_impulse_kind(context, pair->b);
    struct vec3 at_a = context->path[pair->a].at, at_b = context->path[pair->b].at;
    struct vec3 up = vec3_lerp(up_of(a), up_of(b), 0.5), normal, middle;
    double gap = capsule_gap(&a->capsule, &b->capsule, &normal, &middle);
    if (gap > (DEEP - 1.0) * radii ||
        fabs(vec3_dot(vec3_sub(at_b, at_a), up)) > DEEP * 0.5 * (ka->height_m + kb->height_m))
        return false;
    middle.y = 0.5 * (at_a.y + at_b.y);
    double half = maths_max(0.0, 0.5 * (gap + radii)); /* of the way between the lines */
    double off = maths_clamp(0.5 * (a->capsule.radius_m - b->capsule.radius_m), -half, half);
    struct vec3 inside = vec3_add(middle, vec3_scale(normal, off));
    double enough_m = gap < SURELY * DEEP_PAIR_M ? RESTING_PARTS_M : DEEP_PAIR_M;
    if (!are_deep(a, b, inside, up, maths_min(ka->height_m, kb->height_m), enough_m))
        return false;
    found->count = 1;
    found->gap[0] =
        (struct level_gap){.normal = normal, .gap_m = gap, .point = {middle}, .points = 1};
    return true;
}

bool deep_pair_is_near(const struct begun_body *a, const struct begun_body *b)
{
    struct vec3 normal, middle;
    return a->capsule.radius_m > 0.0 && b->capsule.radius_m > 0.0 &&
           capsule_gap(&a->capsule, &b->capsule, &normal, &middle) < NEAR_M;
}
