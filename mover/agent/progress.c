/* Compares the speed of a vehicle with its throttle. */
#include "mover/agent/progress.h"

#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define STALLED_S  3.0
#define DRIVES_MPS 1.0  /* it wants at least this speed */
#define SLOW_MPS   0.3  /* and reaches less than this, */
#define SLOW_SHARE 0.06 /* or than this share of it */
#define WAY_SHARE  5.0  /* a ship needs the time of so much of that speed to reverse its way */
#define SIDE_RAD   1.05 /* most off the way back */
#define TRIES_S    3.0  /* who is stuck again tries so long */
#define PERIOD_S   12.0 /* in each of these */

/* The column stalled: a count of decisions, and how often the vehicle has been stuck since it last
 * got on. */
#define STALLED_COUNT 0x3fu
#define STALLED_ONCE  0x40u /* it backs off */
#define STALLED_AGAIN 0x80u /* it rests most of the time */

bool progress_stalled(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double wanted = fabs((double)m->throttle[i]) * kind->max_speed_mps;
    double least = maths_max(SLOW_MPS, SLOW_SHARE * wanted);
    uint8_t before = m->stalled[i] & (uint8_t)~STALLED_COUNT;
    if (kind->domain == DOMAIN_AIR || wanted < DRIVES_MPS) {
        m->stalled[i] = before;
        return false;
    }
    if (m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i] >= least * least) {
        m->stalled[i] = 0;
        return false;
    }
    uint32_t count = (m->stalled[i] & STALLED_COUNT) + 1u;
    double patience = STALLED_S;
    if (kind->domain == DOMAIN_SEA)
        patience += WAY_SHARE * least / maths_max(kind->acceleration_mps2, 0.01);
    if (count * context->think_frames * context->dt_s < patience && count < STALLED_COUNT) {
        m->stalled[i] = (uint8_t)(before | count);
        return false;
    }
    m->stalled[i] = before ? STALLED_AGAIN : STALLED_ONCE;
    return true;
}

bool progress_stuck(const struct step_context *context, uint32_t i)
{
    return (context->m->stalled[i] & STALLED_AGAIN) != 0;
}

bool progress_rests(const struct step_context *context, uint32_t i)
{
    double middle_s = ((double)context->tick - 0.5) * context->dt_s; /* of the frame */
    double periods = (middle_s + (double)(context->m->id[i] % 12u)) / PERIOD_S;
    return progress_stuck(context, i) && periods - floor(periods) >= TRIES_S / PERIOD_S;
}

double progress_way_out(const struct step_context *context, uint32_t i, bool tried)
{
    const struct entities *m = context->m;
    uint64_t decision = (context->tick - 1) / context->think_frames; /* the same at any rate */
    double side =
        random_between(context->world->params->seed, decision, m->id[i], RANDOM_STUCK, -1, 1);
    double back = m->heading[i] + (m->throttle[i] < 0.0f ? 0.0 : PI);
    return back + side * (tried ? PI : SIDE_RAD);
}
