/* Compares every tank with every other that is near. */
#include "tests/bench/heap_overlap.h"

#include "supervisor/physics/hull_overlap.h"

static struct vec3 vector(const double v[3])
{
    return (struct vec3){v[0], v[1], v[2]};
}

static struct rigid_pose pose_of(const struct heap_body *body)
{
    return (struct rigid_pose){vector(body->at), vector(body->forward), vector(body->up),
                               vector(body->right)};
}

/* A search for hulls that are deeper than least_m ends with the first axis that shows they are not.
 */
static double pair_deepest(const struct heap_hulls *hulls, const struct rigid_pose *a,
                           const struct rigid_pose *b, double least_m)
{
    const struct relative_place place = hull_overlap_place(a, b, 1.0);
    for (uint32_t i = 0; i < hulls->count; i++) {
        for (uint32_t j = 0; j < hulls->count; j++) {
            const struct hull_shape *p = &hulls->shape[i], *q = &hulls->shape[j];
            struct vec3 axis = {0.0, 0.0, 0.0};
            if (!hull_overlap_far(p, q, &place, -least_m, &axis))
                least_m = maths_max(least_m, -hull_overlap_find(p, q, &place, -least_m, &axis));
        }
    }
    return least_m;
}

double heap_overlap_deepest(const struct heap_hulls *hulls, const struct heap_body *body,
                            uint32_t count, double least_m)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct rigid_pose a = pose_of(&body[i]);
        for (uint32_t j = i + 1; j < count; j++) {
            const struct rigid_pose b = pose_of(&body[j]);
            if (vec3_length(vec3_sub(b.at, a.at)) < 2.0 * hulls->reach_m)
                least_m = pair_deepest(hulls, &a, &b, least_m);
        }
    }
    return least_m;
}
