/* Which targets suit a munition, and the times of reaction. */
#include "mover/agent/fire_control.h"

#include "mover/agent/behaviour_table.h"
#include "world/entity/armour.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <stddef.h>

#define SLOWEST_SHARE 0.98 /* of crews; the others would take very long */

/* Shares of the range at which a gun that is not meant for aircraft fires at them. */
#define HOVERING_SHARE     0.5
#define FLYING_SHARE       0.3
#define SLOW_MPS           15.0 /* a faster helicopter is as hard to hit as a jet */
#define KEPT_SHARE         0.64 /* of its rounds: the rest of a tank's 55 is 20 for half an hour */
#define KEPT_REACH         0.3  /* share of the range at which it fires the rounds that it keeps */
#define CLOSE_SHARE        0.15 /* so near it also fires at what it harms only from behind */
#define SPREADS            1.25 /* errors of the aim that a target is wide and high where it fires */
#define OUTRANGES          1.15 /* of the reach of air defence, from which a helicopter fires at it */
#define SELF_DEFENCE       0.4   /* share of the range at which air defence fires at the ground */
#define ENGAGED_M          300.0 /* it chooses targets so far beyond its reach, and drives closer */
#define POSITION_S         5.0 /* guns that load faster change their place about so often, times 2-4 */
#define PASSES             2u  /* missiles of a jet's sortie */
#define AMBUSHES           12u /* rockets of a helicopter's */
#define JUST_FIRED         0.7 /* share of the time to load that is left at least */
#define SUPPRESSED_LEAST_S 10.0
#define SUPPRESSED_MOST_S  30.0

bool fire_control_suits(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    uint16_t munition = kinds[context->m->row[i].kind].munition;
    const struct kind *other = &kinds[context->committed->entities.row[target].kind];
    if (munition != KIND_NONE && kinds[munition].delivery == DELIVERY_ARC)
        return false; /* howitzers fire by missions */
    if (munition == KIND_NONE || other->domain != DOMAIN_AIR)
        return true;
    switch ((enum aircraft_targets)kinds[munition].air_targets) {
    case AIR_TARGETS_NONE:
        return false;
    case AIR_TARGETS_SLOW:
        return other->min_speed_mps == 0.0 &&
               vec3_length(step_context_velocity(context, &context->committed->entities, target)) <
                   SLOW_MPS;
    default:
        return true;
    }
}

bool fire_control_harms(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    const struct kind *other = &kinds[context->committed->entities.row[target].kind];
    uint16_t munition = kind_munition_at(kind, other);
    return munition == KIND_NONE ||
           armour_yields(other, &kinds[munition], kind->domain == DOMAIN_AIR);
}

/* Returns true if row i drives into what it attacks. An aircraft that charges flies over it. */
static bool rams(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    return behaviour_tables[kind->doctrine].manner == MANNER_CHARGE &&
           kind->domain == DOMAIN_LAND &&
           kinds[context->committed->entities.row[target].kind].domain == DOMAIN_LAND;
}

bool fire_control_fights(const struct step_context *context, uint32_t i, uint32_t target)
{
    return fire_control_suits(context, i, target) &&
           (fire_control_harms(context, i, target) || rams(context, i, target));
}

bool fire_control_air_defence(const struct step_context *context, uint32_t i)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->committed->entities.row[i].kind];
    const struct kind *round = kind->munition != KIND_NONE ? &kinds[kind->munition] : NULL;
    return kind->doctrine == DOCTRINE_FLAK ||
           (round && round->guidance == GUIDANCE_HOMING && round->air_targets == AIR_TARGETS_ALL);
}

double fire_control_outranges_m(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    const struct kind *other = &kinds[context->committed->entities.row[target].kind];
    double safe_m = OUTRANGES * other->range_m;
    bool outranges = kind->doctrine == DOCTRINE_HELICOPTER && other->doctrine == DOCTRINE_FLAK &&
                     kind->range_m > safe_m;
    return outranges ? safe_m : 0.0;
}

static bool keeps_rounds(const struct entities *m, uint32_t i, const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND && kind->doctrine != DOCTRINE_FLAK &&
           (double)m->row[i].rounds <= KEPT_SHARE * (double)kind->rounds;
}

/* Returns from how near a gun hits the other kind. The crew of one that is more accurate when it
 * stands aims, and waits until the errors of its aim, as it drives, are not much larger than the
 * target. The others, machine guns, spread their rounds over more than the target. [m] */
static double hits_from_m(const struct kind *round, const struct kind *other)
{
    if (round->dispersion_moving_rad <= round->dispersion_rad)
        return INFINITY;
    return sqrt(other->width_m * other->height_m) / (SPREADS * round->dispersion_moving_rad);
}

double fire_control_effective_m(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    const struct kind *other = &kinds[context->committed->entities.row[target].kind];
    if (kind->domain != DOMAIN_LAND || kind->munition == KIND_NONE ||
        !fire_control_harms(context, i, target))
        return INFINITY;
    const struct kind *round = &kinds[kind_munition_at(kind, other)];
    double harms_m = maths_max(armour_reach_m(other, round), CLOSE_SHARE * kind->range_m);
    return maths_min(harms_m, hits_from_m(round, other));
}

double fire_control_reach_m(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    const struct kind *other = &kinds[context->committed->entities.row[target].kind];
    bool homing = kind->munition != KIND_NONE && kinds[kind->munition].guidance == GUIDANCE_HOMING;
    double reach = kind->range_m;
    if (kind->doctrine == DOCTRINE_FLAK && other->domain != DOMAIN_AIR)
        reach *= SELF_DEFENCE;
    if (kind->doctrine != DOCTRINE_FLAK && !homing && other->domain == DOMAIN_AIR)
        reach *= other->min_speed_mps > 0.0 ? FLYING_SHARE : HOVERING_SHARE;
    if (keeps_rounds(context->m, i, kind))
        reach *= KEPT_REACH;
    return maths_min(reach, fire_control_effective_m(context, i, target));
}

bool fire_control_spares(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct vec3 off =
        vec3_sub(step_context_position(context, &context->committed->entities, target),
                 entities_position(context->m, i));
    double reach = fire_control_reach_m(context, i, target);
    return keeps_rounds(context->m, i, kind) && off.x * off.x + off.z * off.z > reach * reach;
}

bool fire_control_worth(const struct step_context *context, uint32_t i, uint32_t target,
                        double square)
{
    if (context->world->kinds[context->m->row[i].kind].munition == KIND_NONE)
        return true;
    if (!fire_control_suits(context, i, target))
        return false;
    double reach = fire_control_reach_m(context, i, target) + ENGAGED_M;
    return square < reach * reach;
}

/* Rounds from one place, or of one sortie: two to four of a tank, more of guns that load faster. */
static uint32_t salvo_of(const struct kind *kind, uint32_t id)
{
    if (kind->domain == DOMAIN_AIR)
        return kind->min_speed_mps > 0.0 ? PASSES : AMBUSHES;
    return (2 + id % 3) * (uint32_t)maths_max(1.0, POSITION_S / maths_max(kind->reload_s, 0.1));
}

bool fire_control_salvo_over(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (m->row[i].rounds == 0 || m->row[i].rounds >= kind->rounds)
        return false;
    double left_s =
        ((double)m->row[i].reload_tick - (double)(uint32_t)context->tick) * context->dt_s;
    return (kind->rounds - m->row[i].rounds) % salvo_of(kind, m->row[i].id) == 0 &&
           left_s <= kind->reload_s && left_s > JUST_FIRED * kind->reload_s;
}

double fire_control_suppress(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    double time_s = random_between(context->world->params->seed, context->tick, m->row[i].id,
                                   RANDOM_SUPPRESSED, SUPPRESSED_LEAST_S, SUPPRESSED_MOST_S);
    uint32_t ready = (uint32_t)(context->tick + (uint64_t)(time_s / context->dt_s));
    if (ready > m->row[i].reload_tick)
        m->row[i].reload_tick = ready;
    return time_s;
}

/* A log-logistic time: it has the median and the long tail of the log-normal times that are
 * measured with drivers and crews, and needs no logarithm. Its quantile is m sqrt(u / (1 - u)). */
static double reaction_s(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double least = FIRE_CONTROL_LEAST_S;
    double median = maths_max(context->world->kinds[m->row[i].kind].reaction_s, least);
    double u = SLOWEST_SHARE * random_unit(context->world->params->seed, context->tick,
                                           m->row[i].id, RANDOM_REACTION);
    return least + (median - least) * sqrt(u / (1.0 - u));
}

void fire_control_acquire(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    double frames = reaction_s(context, i) / context->dt_s;
    uint32_t ready = (uint32_t)(context->tick + (uint64_t)frames + 1);
    if (ready > m->row[i].reload_tick)
        m->row[i].reload_tick = ready;
}
