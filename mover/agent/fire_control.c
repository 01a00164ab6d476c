/* Which targets suit a munition, and the times of reaction. */
#include "mover/agent/fire_control.h"

#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define SLOWEST_SHARE 0.98 /* of crews; the others would take very long */

bool fire_control_suits(const struct step_context *context, uint32_t i, uint32_t target)
{
    const struct kind *kinds = context->world->kinds;
    uint16_t munition = kinds[context->m->kind[i]].munition;
    const struct kind *other = &kinds[context->committed->entities.kind[target]];
    if (munition != KIND_NONE && kinds[munition].delivery == DELIVERY_ARC)
        return false; /* howitzers fire by missions */
    if (munition == KIND_NONE || other->domain != DOMAIN_AIR)
        return true;
    switch ((enum aircraft_targets)kinds[munition].air_targets) {
    case AIR_TARGETS_NONE:
        return false;
    case AIR_TARGETS_SLOW:
        return other->min_speed_mps == 0.0;
    default:
        return true;
    }
}

/* A log-logistic time: it has the median and the long tail of the log-normal times that are
 * measured with drivers and crews, and needs no logarithm. Its quantile is m sqrt(u / (1 - u)). */
static double reaction_s(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double least = FIRE_CONTROL_LEAST_S;
    double median = maths_max(context->world->kinds[m->kind[i]].reaction_s, least);
    double u = SLOWEST_SHARE *
               random_unit(context->world->params->seed, context->tick, m->id[i], RANDOM_REACTION);
    return least + (median - least) * sqrt(u / (1.0 - u));
}

void fire_control_acquire(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    double frames = reaction_s(context, i) / context->dt_s;
    uint32_t ready = (uint32_t)(context->tick + (uint64_t)frames + 1);
    if (ready > m->reload_tick[i])
        m->reload_tick[i] = ready;
}
