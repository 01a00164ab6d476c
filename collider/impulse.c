/* Impulses along the contact normal with restitution: momentum is kept, kinetic energy never grows,
 * and what is lost harms the bodies. */
#include "collider/respond.h"

/* What would leave slower than this along the normal does not bounce at all. */
#define STOP_MPS 0.2

static const struct kind *kind_of(const struct respond *respond, uint32_t row)
{
    return &respond->world->kinds[respond->next->entities.kind[row]];
}

/* The restitution of this impact: soft ones have none, so that bodies come to rest. */
static double bounce_of(const struct kind *a, const struct kind *b, double closing_mps)
{
    double restitution = maths_min(a->restitution, b->restitution);
    return restitution * closing_mps > STOP_MPS ? restitution : 0.0;
}

int impulse_moving(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct entities *e = &respond->next->entities;
    const struct kind *ka = kind_of(respond, impact->a), *kb = kind_of(respond, impact->b);
    double restitution = bounce_of(ka, kb, impact->closing_mps);
    double reduced = ka->mass_kg * kb->mass_kg / (ka->mass_kg + kb->mass_kg);
    double impulse = (1.0 + restitution) * reduced * impact->closing_mps;
    double lost = 0.5 * reduced * impact->closing_mps * impact->closing_mps *
                  (1.0 - restitution * restitution);
    struct vec3 va = vec3_sub(entities_velocity(e, impact->a),
                              vec3_scale(impact->normal, impulse / ka->mass_kg));
    struct vec3 vb = vec3_add(entities_velocity(e, impact->b),
                              vec3_scale(impact->normal, impulse / kb->mass_kg));
    double share_a = kb->mass_kg / (ka->mass_kg + kb->mass_kg);
    outcome->impulse_ns = impulse;
    outcome->response = restitution > 0.0 ? RESPONSE_BOUNCE : RESPONSE_STOP;
    if (respond_stay(respond, impact->a, impact->time, va) != 0 ||
        respond_stay(respond, impact->b, impact->time, vb) != 0 ||
        harm_row(respond, impact->a, lost * share_a, impact->time) != 0)
        return -1;
    return harm_row(respond, impact->b, lost * (1.0 - share_a), impact->time);
}

int impulse_fixed(struct respond *respond, const struct impact *impact, struct outcome *outcome)
{
    const struct world *world = respond->world;
    const struct kind *kind = kind_of(respond, impact->a);
    uint32_t object = impact->b & ~PAIR_FIXED;
    const struct kind *fixed = &world->kinds[world->fixed[object].kind];
    double energy = 0.5 * kind->mass_kg * impact->closing_mps * impact->closing_mps;
    if (fixed->rigidity < YIELDING_RIGIDITY) { /* a bush: it takes its share of the momentum */
        double keeps = kind->mass_kg / (kind->mass_kg + fixed->mass_kg);
        outcome->response = RESPONSE_SLOW;
        outcome->impulse_ns = kind->mass_kg * impact->closing_mps * (1.0 - keeps);
        return respond_slow(respond, impact->a, impact->time, keeps);
    }
    double yields = fixed->resistance_j * world->params->collision.damage_high;
    if (harm_fixed(respond, object, energy) >= DAMAGE_HIGH && energy >= yields) {
        /* It gives way: breaking it costs its resistance, the rest goes on. */
        double speed = vec3_length(entities_velocity(&respond->next->entities, impact->a));
        double whole = 0.5 * kind->mass_kg * speed * speed;
        double share = sqrt(maths_max(0.0, 1.0 - yields / whole));
        outcome->response = RESPONSE_SLOW;
        outcome->impulse_ns = kind->mass_kg * speed * (1.0 - share);
        if (respond_slow(respond, impact->a, impact->time, share) != 0)
            return -1;
        return harm_row(respond, impact->a, yields * fixed->rigidity, impact->time);
    }
    double restitution = bounce_of(kind, fixed, impact->closing_mps);
    double impulse = (1.0 + restitution) * kind->mass_kg * impact->closing_mps;
    struct vec3 velocity = vec3_sub(entities_velocity(&respond->next->entities, impact->a),
                                    vec3_scale(impact->normal, impulse / kind->mass_kg));
    outcome->impulse_ns = impulse;
    outcome->response = restitution > 0.0 ? RESPONSE_BOUNCE : RESPONSE_STOP;
    if (respond_stay(respond, impact->a, impact->time, velocity) != 0)
        return -1;
    return harm_row(respond, impact->a,
                    energy * (1.0 - restitution * restitution) * fixed->rigidity, impact->time);
}
