/* Discs about the positions of bodies that are deep inside each other. */
#include "collider/resting/parting.h"

#include "collider/response/contact_impulse.h"
#include "world/world.h"

/* No body is moved apart faster than this. */
#define PUSHED_MOST_MPS 10.0
#define PUSHED_MOST_RPS 0.2

/* Positions nearer than this share of both bodies' least reach are within each other. */
#define DEEP 0.9

/* A body that leans more does not cover the disc of its least reach [rad]. */
#define STANDS_RAD 0.5

/* Bodies at one place part as if they were so far apart, times the root of their ids [m]. */
#define COINCIDENT_M 1e-4
#define GOLDEN_ANGLE 2.399963229728653 /* [rad] */

/* Returns how far the body reaches to each side at least [m]. */
static double inner_reach(const struct kind *kind)
{
    return 0.5 * maths_min(kind->width_m, kind->length_m);
}

/* Returns true if the body covers the disc of its inner reach. Aircraft do not, because they are
 * fuselages with wings and rotors, and no wreck on its side does. */
static bool fills_disc(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return context->world->kinds[e->kind[row]].domain != DOMAIN_AIR &&
           fabs(e->pitch[row]) + fabs(e->roll[row]) <= STANDS_RAD;
}

/* Returns a place near the position, another one for each id. The places of all ids are spread
 * evenly over a disc, so that bodies at one place part in all directions [m]. */
static struct vec3 place_of(const struct response_context *context, uint32_t row)
{
    double id = context->next->entities.id[row], sine, cosine;
    struct vec3 at = context->path[row].at;
    maths_sincos(maths_wrap_turn(GOLDEN_ANGLE * id), &sine, &cosine);
    double far = COINCIDENT_M * sqrt(id);
    return (struct vec3){at.x + far * cosine, at.y, at.z + far * sine};
}

bool parting_measure(const struct response_context *context, const struct pair *pair,
                     struct resting_gap *found)
{
    if (pair->b & PAIR_FIXED || !fills_disc(context, pair->a) || !fills_disc(context, pair->b))
        return false;
    const struct kind *ka = contact_impulse_kind(context, pair->a);
    const struct kind *kb = contact_impulse_kind(context, pair->b);
    struct vec3 a = place_of(context, pair->a), b = place_of(context, pair->b);
    struct vec3 line = {b.x - a.x, 0.0, b.z - a.z};
    double reach = inner_reach(ka) + inner_reach(kb), distance = vec3_length(line);
    if (distance > DEEP * reach || distance == 0.0 ||
        fabs(b.y - a.y) > DEEP * 0.5 * (ka->height_m + kb->height_m))
        return false;
    found->count = 1;
    found->gap[0] = (struct level_gap){.normal = vec3_scale(line, 1.0 / distance),
                                       .gap_m = distance - reach,
                                       .point = {vec3_lerp(a, b, 0.5)},
                                       .points = 1};
    return true;
}

void parting_limit(struct level_motion *pushed)
{
    double speed = sqrt(pushed->x * pushed->x + pushed->z * pushed->z);
    double keep = speed > PUSHED_MOST_MPS ? PUSHED_MOST_MPS / speed : 1.0;
    pushed->x *= keep;
    pushed->z *= keep;
    pushed->spin = maths_clamp(pushed->spin, -PUSHED_MOST_RPS, PUSHED_MOST_RPS);
}
