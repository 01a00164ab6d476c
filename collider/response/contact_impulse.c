/* Single contacts under impulses: fixed objects that give way, restitution and friction, and the
 * damage by the lost energy. */
#include "collider/response/contact_impulse.h"

#include "collider/response/body_push.h"
#include "collider/response/breaking.h"
#include "collider/response/damage.h"
#include "collider/response/debris_push.h"
#include "collider/response/impact_damage.h"
#include "collider/response/joined_walls.h"
#include "collider/response/response.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

/* A contact that would leave slower than this along the normal does not bounce [m/s]. */
#define STOP_MPS 0.2

#define FRICTION_HEAT 0.5 /* share of the work of friction between vehicles that becomes heat */

static const struct kind *kind_of(const struct response_context *context, uint32_t row)
{
    return &context->world->kinds[context->next->entities.row[row].kind];
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

/* The row goes on without what the object took: the speed along the normal changes, and the row
 * turns about the contact. The object's rigidity is the share of the lost energy that the row
 * takes. */
static void go_on(struct response_context *context, struct island_contact *met,
                  const struct breaking *breaking, double harm_share)
{
    const struct impact *impact = &met->impact;
    met->outcome.response = RESPONSE_SLOW;
    met->outcome.impulse_ns = breaking->impulse_ns;
    body_push(context, impact->a, impact->time, impact->point,
              vec3_scale(impact->normal, -breaking->impulse_ns));
    impact_damage_row(context, impact->a, impact, -1.0, breaking->lost_j * harm_share, NULL);
}

/* Lays what broke down, away from its striker. */
static void fall(struct response_context *context, const struct impact *impact,
                 const struct breaking *breaking, double debris_kg)
{
    double x = impact->normal.x, z = impact->normal.z, level = sqrt(x * x + z * z);
    const struct debris_fall fall = {.object = impact->b & ~PAIR_FIXED,
                                     .x = impact->point.x,
                                     .z = impact->point.z,
                                     .away_x = level > 0.0 ? x / level : 0.0,
                                     .away_z = level > 0.0 ? z / level : -1.0,
                                     .speed_mps = breaking->speed_mps * level,
                                     .moving_kg = debris_kg};
    debris_push_add(context, &fall);
}

/* Damages the object and the walls joined to it by the energy of the impact [J]. Returns true if
 * the object breaks, with what that costs, joined walls included. */
static bool breaks(struct response_context *context, uint32_t object, double energy_j,
                   double *strength_j)
{
    const struct kind *fixed = fixed_kind_of(context, object | PAIR_FIXED);
    double own_j = fixed->resistance_j * damage_high_share(context, fixed);
    double kept = joined_walls_find(context, object) > 0 ? 1.0 - JOINED_WALLS_SHARE : 1.0;
    *strength_j = own_j / kept;
    enum damage damage = damage_fixed_object(context, object, energy_j * kept);
    joined_walls_damage(context, maths_min(energy_j, *strength_j) * (1.0 - kept));
    return damage == DAMAGE_HIGH && energy_j >= *strength_j;
}

bool contact_impulse_gives_way(struct response_context *context, struct island_contact *met)
{
    const struct impact *impact = &met->impact;
    uint32_t object = impact->b & ~PAIR_FIXED;
    const struct kind *fixed = fixed_kind_of(context, impact->b);
    bool bends = fixed->rigidity < YIELDING_RIGIDITY;
    double height = impact->point.y - (double)context->world->fixed[object].y;
    struct breaking_input input = {
        .striker_kg = 1.0 / body_push_mobility(context, impact->a, impact->time, impact->point,
                                               impact->normal),
        .closing_mps = impact->closing_mps,
        .debris_kg = breaking_debris_kg(fixed, kind_of(context, impact->a), height)};
    double energy = 0.5 * input.striker_kg * impact->closing_mps * impact->closing_mps;
    if (!bends && (met->leans || !breaks(context, object, energy, &input.strength_j)))
        return false;
    const struct breaking breaking = breaking_of(&input);
    if (!breaking.breaks)
        return false;
    go_on(context, met, &breaking, bends ? 0.0 : fixed->rigidity);
    if (!bends)
        fall(context, impact, &breaking, input.debris_kg);
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

/* Returns the part of the lost energy that bends and breaks [J]: all that is lost along the normal,
 * but not the share of the friction's work that becomes heat. */
static double crushing_j(const struct solver_contact *contact)
{
    double impulse = fabs(vec3_dot(contact->impulse, contact->normal));
    double along = 0.5 * impulse * contact->closing_mps * (1.0 - contact->restitution);
    return contact->lost_j - FRICTION_HEAT * maths_max(0.0, contact->lost_j - along);
}

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
        double crushing = crushing_j(contact), lost_a = crushing * share_a;
        double lost_b = crushing - lost_a;
        impact_damage_vehicle(context, impact->a, impact, -1.0, lost_a, spring);
        impact_damage_vehicle(context, impact->b, impact, 1.0, lost_b, spring);
    }
    write_collision_event(context, &met->report, impact, &met->outcome);
}
