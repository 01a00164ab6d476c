/* Single contacts under impulses: fixed objects that give way, restitution and friction, and the
 * damage by the lost energy. */
#include "collider/response/contact_impulse.h"

#include "collider/response/damage.h"
#include "collider/response/impact_damage.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

/* A contact that would leave slower than this along the normal does not bounce [m/s]. */
#define STOP_MPS 0.2

static const struct kind *kind_of(const struct response_context *context, uint32_t row)
{
    return &context->world->kinds[context->next->entities.kind[row]];
}

static const struct kind *fixed_kind_of(const struct response_context *context, uint32_t body)
{
    return &context->world->kinds[context->world->fixed[body & ~PAIR_FIXED].kind];
}

const struct kind *contact_impulse_kind(const struct response_context *context, uint32_t body)
{
    return body & PAIR_FIXED ? fixed_kind_of(context, body) : kind_of(context, body);
}

/* --- objects that give way ---------------------------------------------------------------------*/

/* A bush bends: it takes up its share of the momentum. */
static void bend(struct response_context *context, struct island_contact *met,
                 const struct kind *fixed)
{
    const struct impact *impact = &met->impact;
    double mass_kg = kind_of(context, impact->a)->mass_kg;
    double keeps = mass_kg / (mass_kg + fixed->mass_kg);
    met->outcome.response = RESPONSE_SLOW;
    met->outcome.impulse_ns = mass_kg * impact->closing_mps * (1.0 - keeps);
    path_change_slow(context, impact->a, impact->time, keeps);
}

/* The object breaks: that costs its resistance, and the body keeps the rest of the energy. */
static void break_through(struct response_context *context, struct island_contact *met,
                          const struct kind *fixed, double yields_j)
{
    const struct impact *impact = &met->impact;
    double mass_kg = kind_of(context, impact->a)->mass_kg;
    double speed = vec3_length(entities_velocity(&context->next->entities, impact->a));
    double whole = 0.5 * mass_kg * speed * speed;
    double share = sqrt(maths_max(0.0, 1.0 - yields_j / whole));
    met->outcome.response = RESPONSE_SLOW;
    met->outcome.impulse_ns = mass_kg * speed * (1.0 - share);
    path_change_slow(context, impact->a, impact->time, share);
    impact_damage_row(context, impact->a, impact, -1.0, yields_j * fixed->rigidity, NULL);
}

bool contact_impulse_gives_way(struct response_context *context, struct island_contact *met)
{
    const struct impact *impact = &met->impact;
    const struct kind *fixed = fixed_kind_of(context, impact->b);
    double mass_kg = kind_of(context, impact->a)->mass_kg;
    double energy = 0.5 * mass_kg * impact->closing_mps * impact->closing_mps;
    if (fixed->rigidity < YIELDING_RIGIDITY) {
        bend(context, met, fixed);
    } else {
        double yields_j = fixed->resistance_j * damage_high_share(context, fixed);
        if (met->leans ||
            damage_fixed_object(context, impact->b & ~PAIR_FIXED, energy) < DAMAGE_HIGH ||
            energy < yields_j)
            return false;
        break_through(context, met, fixed, yields_j);
    }
    if (!met->leans)
        write_collision_event(context, &met->report, impact, &met->outcome);
    return true;
}

/* --- contacts for the solver -------------------------------------------------------------------*/

struct vec3 contact_impulse_velocity(const struct solver_body *body, struct vec3 point)
{
    struct vec3 r = vec3_sub(point, body->centre), w = body->spin;
    return vec3_add(body->velocity, vec3_cross(w, r));
}

struct solver_contact contact_impulse_contact(const struct response_context *context,
                                              const struct island_contact *met,
                                              const struct solver_body bodies[2])
{
    const struct impact *impact = &met->impact;
    const struct kind *ka = kind_of(context, impact->a),
                      *kb = contact_impulse_kind(context, impact->b);
    struct solver_contact contact = {.point = impact->point,
                                     .normal = impact->normal,
                                     .friction = sqrt(ka->friction * kb->friction)};
    struct vec3 closing = vec3_sub(contact_impulse_velocity(&bodies[0], contact.point),
                                   contact_impulse_velocity(&bodies[1], contact.point));
    double restitution = maths_min(ka->restitution, kb->restitution);
    if (!met->leans && restitution * vec3_dot(closing, contact.normal) > STOP_MPS)
        contact.restitution = restitution;
    return contact;
}

/* --- afterwards --------------------------------------------------------------------------------*/

void contact_impulse_damage(struct response_context *context, struct island_contact *met,
                            const struct solver_contact *contact)
{
    const struct impact *impact = &met->impact;
    const struct kind *ka = kind_of(context, impact->a);
    const struct contact_spring_impact *spring = met->spring.depth_m > 0.0 ? &met->spring : NULL;
    if (met->leans)
        return;
    met->outcome.impulse_ns = vec3_length(contact->impulse);
    met->outcome.response = contact->restitution > 0.0 ? RESPONSE_BOUNCE : RESPONSE_STOP;
    if (impact->b & PAIR_FIXED) {
        const struct kind *fixed = fixed_kind_of(context, impact->b);
        impact_damage_row(context, impact->a, impact, -1.0, contact->lost_j * fixed->rigidity,
                          spring);
    } else { /* the larger mass damages the smaller one more (row 30) */
        const struct kind *kb = kind_of(context, impact->b);
        double share_a = kb->mass_kg / (ka->mass_kg + kb->mass_kg);
        impact_damage_row(context, impact->a, impact, -1.0, contact->lost_j * share_a, spring);
        impact_damage_row(context, impact->b, impact, 1.0, contact->lost_j * (1.0 - share_a),
                          spring);
    }
    write_collision_event(context, &met->report, impact, &met->outcome);
}
