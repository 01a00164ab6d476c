/* Compares the speed of a vehicle with its throttle, and finds those that wait for ever. */
#include "mover/agent/driving/progress.h"

#include "world/entity/persistent_contact.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define STALLED_S  3.0
#define DRIVES_MPS 1.0  /* it wants at least this speed */
#define SLOW_MPS   0.3  /* and reaches less than this, */
#define SLOW_SHARE 0.06 /* or than this share of it */
#define SCRAPES    0.25 /* of the wanted speed: one that touches something and is slower scrapes */
#define TOUCHES_S  2.0  /* by a contact that has lasted so long */
#define WAITS_S    6.0  /* a land vehicle waits so long where no way is free */
#define WAITS_EASE 0.5f /* share of its speed that it gives up there */
#define WAITS_TURN 8u   /* one of so many decisions counts */
#define GIVES_UP   0.1  /* share of its tries after which one gives up: after two minutes */
#define WAY_SHARE  5.0  /* a ship needs the time of so much of that speed to reverse its way */
#define SIDE_RAD   1.05 /* most off the way back */
#define TRIES_S    3.0  /* who is stuck again tries so long */
#define TRIED_S    2.0  /* and such a try is in vain after this time */
#define PERIOD_S   12.0 /* in each of these */

/* The field stalled: a count of decisions, and how often the vehicle has been stuck since it last
 * got on. */
#define STALLED_COUNT 0x3fu
#define STALLED_ONCE  0x40u /* it backs off */
#define STALLED_AGAIN 0x80u /* it rests most of the time */
#define STALLED_FAST  0xc0u /* it has given up */

/* Returns how a vehicle is stuck after it has not got on once more. */
static uint8_t stuck_again(const struct step_context *context, uint32_t i, uint8_t before)
{
    if (before == 0)
        return STALLED_ONCE;
    double draw = random_unit(context->world->params->seed, context->tick, context->m->row[i].id,
                              RANDOM_GIVES_UP);
    return before == STALLED_AGAIN && draw < GIVES_UP ? STALLED_FAST : STALLED_AGAIN;
}

/* Counts a decision. Returns true when they have taken every_s seconds each for patience_s. */
static bool count_on(const struct step_context *context, uint32_t i, double every_s,
                     double patience_s)
{
    struct entities *m = context->m;
    uint8_t before = m->row[i].stalled & (uint8_t)~STALLED_COUNT;
    uint32_t count = (m->row[i].stalled & STALLED_COUNT) + 1u;
    if (count * every_s < patience_s && count < STALLED_COUNT) {
        m->row[i].stalled = (uint8_t)(before | count);
        return false;
    }
    m->row[i].stalled = stuck_again(context, i, before);
    return true;
}

/* Returns true if a land vehicle would drive, and stands because no way before it is free. */
static bool waits(const struct entities *m, uint32_t i, const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND && m->row[i].behaviour != BEHAVIOUR_DRIVEN &&
           m->row[i].ease > WAITS_EASE;
}

/* Returns true if row i has touched another body for a while and presses on it. */
static bool touches(const struct step_context *context, uint32_t i)
{
    const struct state *committed = context->committed;
    const uint32_t id = context->m->row[i].id, tick = (uint32_t)committed->head->tick;
    const uint32_t frames = (uint32_t)(TOUCHES_S / context->dt_s);
    for (uint32_t n = 0; n < committed->head->contact_count; n++) {
        const struct persistent_contact *contact = &committed->contacts[n];
        if ((contact->a_id == id || contact->b_id == id) && tick - contact->begin_tick >= frames &&
            tick - contact->pressed_tick < frames)
            return true;
    }
    return false;
}

/* Returns true if a vehicle gets on at this speed. A land vehicle that scrapes along something does
 * not. */
static bool gets_on(const struct step_context *context, uint32_t i, double speed, double wanted)
{
    if (speed < maths_max(SLOW_MPS, SLOW_SHARE * wanted))
        return false;
    return !(context->m->row[i].flags & ENTITY_FLAG_CHASSIS) || speed >= SCRAPES * wanted ||
           !touches(context, i);
}

/* Returns true if it is on the way back from where a step of its script did not get on. */
static bool is_aside(const struct entities *m, uint32_t i)
{
    return m->row[i].behaviour == BEHAVIOUR_BACK_OFF && m->row[i].order == BEHAVIOUR_SCRIPT;
}

bool progress_stalled(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const double think_s = context->think_frames * context->dt_s;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double wanted = fabs((double)m->row[i].throttle) * kind->max_speed_mps;
    bool drives = kind->domain != DOMAIN_AIR && wanted >= DRIVES_MPS;
    if (!drives && !waits(m, i, kind)) {
        m->row[i].stalled &= (uint8_t)~STALLED_COUNT;
        return false;
    }
    if (gets_on(context, i, sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz),
                wanted)) {
        m->row[i].stalled &= is_aside(m, i) ? (uint8_t)~STALLED_COUNT : 0u;
        return false;
    }
    if (!drives)
        return (context->tick / context->think_frames + m->row[i].id) % WAITS_TURN == 0 &&
               count_on(context, i, WAITS_TURN * think_s,
                        progress_stuck(context, i) ? TRIED_S : WAITS_S);
    double patience = progress_stuck(context, i) ? TRIED_S : STALLED_S;
    if (kind->domain == DOMAIN_SEA)
        patience += WAY_SHARE * maths_max(SLOW_MPS, SLOW_SHARE * wanted) /
                    maths_max(kind->acceleration_mps2, 0.01);
    return count_on(context, i, think_s, patience);
}

bool progress_backed_off(const struct step_context *context, uint32_t i)
{
    return (context->m->row[i].stalled & ~STALLED_COUNT) != 0;
}

bool progress_stuck(const struct step_context *context, uint32_t i)
{
    return (context->m->row[i].stalled & STALLED_AGAIN) != 0;
}

bool progress_gives_up(const struct step_context *context, uint32_t i)
{
    return (context->m->row[i].stalled & STALLED_FAST) == STALLED_FAST;
}

bool progress_rests(const struct step_context *context, uint32_t i)
{
    double middle_s = ((double)context->tick - 0.5) * context->dt_s; /* of the frame */
    double periods = (middle_s + (double)(context->m->row[i].id % 12u)) / PERIOD_S;
    return progress_stuck(context, i) && periods - floor(periods) >= TRIES_S / PERIOD_S;
}

double progress_way_out(const struct step_context *context, uint32_t i, bool tried)
{
    const struct entities *m = context->m;
    uint64_t decision = (context->tick - 1) / context->think_frames; /* the same at any rate */
    double side =
        random_between(context->world->params->seed, decision, m->row[i].id, RANDOM_STUCK, -1, 1);
    double back = m->row[i].heading + (m->row[i].throttle < 0.0f ? 0.0 : PI);
    return back + side * (tried ? PI : SIDE_RAD);
}
