/* One pair at a time: spheres in closed form, hulls by conservative advancement. */
#include "collider/narrow_phase/narrow_phase.h"

#include "collider/method/method.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

/* Fills the contact of two spheres at its time. With equal centres any normal would do: it points
 * upwards. */
static void impact_of_spheres(struct vec3 a, struct vec3 b, double radius_a, double reach,
                              struct hull_contact *impact)
{
    struct vec3 between = vec3_sub(b, a);
    double distance = vec3_length(between);
    impact->normal =
        distance > 0.0 ? vec3_scale(between, 1.0 / distance) : (struct vec3){0.0, 1.0, 0.0};
    impact->point = vec3_add(a, vec3_scale(impact->normal, radius_a));
    impact->depth_m = maths_max(0.0, reach - distance);
}

static bool touch_spheres(const struct method_input *detect, const struct pair *pair, double from,
                          bool discrete, struct hull_contact *impact)
{
    const struct path *path = detect->path, *a = &path[pair->a];
    double radius = pair_filter_row_reach(detect, pair->a), reach = radius;
    struct path still, *b = &still;
    if (pair->b & PAIR_FIXED) {
        const struct fixed_object *object = &detect->world->fixed[pair->b & ~PAIR_FIXED];
        still = (struct path){.at = fixed_position(object)};
        reach += pair_filter_fixed_reach(detect->world, object);
    } else {
        still = path[pair->b];
        reach += pair_filter_row_reach(detect, pair->b);
    }
    if (discrete)
        impact->toi = 1.0;
    else if (!analytic_impact_spheres(a, b, reach, from, &impact->toi))
        return false;
    impact_of_spheres(path_at(a, impact->toi), path_at(b, impact->toi), radius, reach, impact);
    return true;
}

/* Returns true if the spheres around two bodies show that they do not touch at this time. */
static bool far_apart(const struct swept_body *a, const struct swept_body *b, double time)
{
    struct vec3 between = vec3_sub(path_at(&b->path, time), path_at(&a->path, time));
    double reach = a->bound_m + b->bound_m + SKIN_M;
    return vec3_dot(between, between) > reach * reach;
}

/* Returns the body with the one hull around it, or with one around each part if the parts have left
 * their places in the model. */
static struct swept_body outer_of(const struct swept_body *body)
{
    struct swept_body outer = *body;
    bool parts = body->turret.outers > 0;
    outer.hull = parts ? body->turret.outer : body->outer;
    outer.hull_count = parts ? body->turret.outers : 1;
    return outer;
}

/* Tests the bodies with one outer hull each first, so that bodies that pass each other cost one
 * pair of hulls and not dozens. The pieces within touch no sooner than the outer hulls, and may
 * meet at once where these touch already. Returns false if the outer hulls never touch; else *from
 * is when. */
static bool outer_impact(const struct swept_body *a, const struct swept_body *b, double *from)
{
    struct swept_body outer_a, outer_b;
    struct hull_contact impact;
    if (a->hull_count * b->hull_count == 1)
        return true;
    outer_a = outer_of(a);
    outer_b = outer_of(b);
    if (!far_apart(&outer_a, &outer_b, *from) &&
        time_of_impact_within(&outer_a, &outer_b, *from, SKIN_M))
        return true;
    if (!time_of_impact_find(&outer_a, &outer_b, *from, &impact))
        return false;
    *from = impact.toi;
    return true;
}

static bool touch_hulls(const struct body_motion *motion, const struct pair *pair, double from,
                        struct hull_contact *impact)
{
    struct free_turn turn_a, turn_b;
    struct swept_body a = body_motion_body(motion, pair->a, &turn_a);
    struct swept_body b = body_motion_side(motion, pair->b, &turn_b);
    return !time_of_impact_excluded(&a, &b, from) && outer_impact(&a, &b, &from) &&
           time_of_impact_find(&a, &b, from, impact);
}

bool narrow_phase_lets_in(const struct world *world, bool through_fixed, uint32_t object)
{
    return through_fixed || world->kinds[world->fixed[object].kind].rigidity < YIELDING_RIGIDITY;
}

bool narrow_phase_find(const struct method_input *input, const struct body_motion *motion,
                       bool through_fixed, const struct pair *pair, double from,
                       struct hull_contact *impact)
{
    const struct world *world = input->world;
    const struct collision_params *how = &world->params->collision;
    bool discrete = method_discrete((enum method)how->method);
    bool hulls = how->shape == SHAPE_MODEL && !discrete;
    if (hulls ? !touch_hulls(motion, pair, from, impact)
              : !touch_spheres(input, pair, from, discrete, impact))
        return false;
    if (discrete || !(pair->b & PAIR_FIXED))
        return true;
    /* A body that is inside already was reported when it entered. Hulls within their skin of each
     * other count as inside. */
    bool inside = impact->toi <= from && (hulls || impact->depth_m > 0.0 || from > 0.0);
    return !(inside && narrow_phase_lets_in(world, through_fixed, pair->b & ~PAIR_FIXED));
}
