/* Figure 8 of the thesis (p. 22), with its gaps closed (row 27).
 *
 * Its constants severe_rad, bounce_keep and fast_mps belong to the kinds of the two vehicles. An
 * impact is severe if its angle is within the wider of their two severe_rad of a quarter turn; both
 * are destroyed if either is faster than its own kind's fast_mps; a bounce leaves each its own
 * kind's bounce_keep. So no rule depends on the order of the two or on which is heavier. "Large",
 * "moving quickly" and constant1..3 are the scenario's; the last may also be a kind's own
 * (damage.c). */
#include "collider/response/damage.h"
#include "collider/response/impact_damage.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

/* Headings are not exact to the last bit. A ten-thousandth of a degree keeps angles of 5 and 85
 * degrees severe. */
#define ANGLE_SLACK_RAD (1e-4 * RAD_PER_DEG)

static const struct kind *kind_of(const struct response_context *context, uint32_t row)
{
    return &context->world->kinds[context->next->entities.row[row].kind];
}

static bool severe(const struct kind *a, const struct kind *b, double angle_rad)
{
    double off = maths_wrap_half(4.0 * angle_rad) * 0.25; /* distance to the nearest quarter turn */
    return fabs(off) <= maths_max(a->severe_rad, b->severe_rad) + ANGLE_SLACK_RAD;
}

static bool fast(const struct response_context *context, const struct kind *kind, double speed_mps)
{
    double scenario = context->world->params->collision.fast_vehicle_mps;
    return speed_mps > (kind->fast_mps > 0.0 ? kind->fast_mps : scenario);
}

/* Reflects a velocity into the plane of contact, and makes it slower. */
static struct vec3 bounced(struct vec3 velocity, struct vec3 normal, double keep)
{
    double into = vec3_dot(velocity, normal);
    if (into > 0.0)
        velocity = vec3_sub(velocity, vec3_scale(normal, 2.0 * into));
    return vec3_scale(velocity, keep);
}

static double energy_of(const struct kind *kind, struct vec3 velocity)
{
    return 0.5 * kind->mass_kg * vec3_dot(velocity, velocity);
}

static void meet_moving(struct response_context *context, const struct impact *impact,
                        struct outcome *outcome)
{
    const struct entities *e = &context->next->entities;
    const struct kind *ka = kind_of(context, impact->a), *kb = kind_of(context, impact->b);
    struct vec3 va = entities_velocity(e, impact->a), vb = entities_velocity(e, impact->b);
    double before = energy_of(ka, va) + energy_of(kb, vb);
    if (severe(ka, kb, impact->angle_rad)) {
        if (fast(context, ka, vec3_length(va)) || fast(context, kb, vec3_length(vb))) {
            response_mps.moving(context, impact, outcome); /* "Kill both" */
            return;
        }
        outcome->response = RESPONSE_STOP;
        va = vb = (struct vec3){0.0, 0.0, 0.0};
    } else {
        outcome->response = RESPONSE_BOUNCE;
        va = bounced(va, impact->normal, ka->bounce_keep);
        vb = bounced(vb, vec3_scale(impact->normal, -1.0), kb->bounce_keep);
    }
    double lost = before - energy_of(ka, va) - energy_of(kb, vb);
    path_change_stay(context, impact->a, impact->time, va);
    path_change_stay(context, impact->b, impact->time, vb);
    /* The larger mass damages the smaller one more (row 30). */
    double share_a = kb->mass_kg / (ka->mass_kg + kb->mass_kg);
    impact_damage_row(context, impact->a, impact, -1.0, lost * share_a, NULL);
    impact_damage_row(context, impact->b, impact, 1.0, lost * (1.0 - share_a), NULL);
}

static void damage_object(struct response_context *context, uint32_t object, double mass_kg,
                          double joules)
{
    if (context->world->params->collision.measure == MEASURE_MASS)
        damage_fixed_mass(context, object, mass_kg);
    else
        damage_fixed_object(context, object, joules);
}

static void meet_fixed(struct response_context *context, const struct impact *impact,
                       struct outcome *outcome)
{
    const struct world *world = context->world;
    const struct collision_params *limits = &world->params->collision;
    uint32_t object = impact->b & ~PAIR_FIXED;
    double fixed_kg = world->kinds[world->fixed[object].kind].mass_kg;
    double mass_kg = kind_of(context, impact->a)->mass_kg;
    double energy = 0.5 * mass_kg * impact->closing_mps * impact->closing_mps;
    double speed = vec3_length(entities_velocity(&context->next->entities, impact->a));
    damage_object(context, object, mass_kg, energy);
    if (fixed_kg >= limits->large_fixed_kg && speed > limits->fast_fixed_mps) {
        outcome->response = RESPONSE_DESTROYED;
        path_change_stay(context, impact->a, impact->time, (struct vec3){0.0, 0.0, 0.0});
        damage_destroy(context, impact->a, impact->time);
        return;
    }
    outcome->response = RESPONSE_SLOW;
    path_change_slow(context, impact->a, impact->time, mass_kg / (mass_kg + fixed_kg));
    path_change_swept(context, &impact->a, 1, impact->time);
    impact_damage_row(context, impact->a, impact, -1.0, energy * fixed_kg / (mass_kg + fixed_kg),
                      NULL);
}

const struct response_functions response_figure8 = {.moving = meet_moving, .fixed = meet_fixed};
