/* Which rows begin to cruise. */
#include "mover/context/cruise_start.h"

#include "world/entity/table_write.h"
#include "world/world.h"

#define SPREAD      7u   /* frames between the turns of two neighbouring groups: no divisor of 30 */
#define GROUP_BITS  4u   /* the least group has 16 rows */
#define GROUPS_MOST 256u /* of rows that are not a block */
#define TRY_FRAMES  10u  /* after so many frames rows that do not cruise try again */
#define TRY_SOONER  5u   /* the same in a crowd */
#define DECISIONS   4u   /* after so many decisions that changed nothing an agent looks again */
#define NEAR_GOAL_M 40.0 /* nearer to its goal stretches are short: it decides when there */

uint32_t cruise_start_group_bits(uint32_t capacity)
{
    uint32_t bits = GROUP_BITS;
    while (1u << bits < CHECKSUM_ROWS && (uint64_t)GROUPS_MOST << bits < capacity)
        bits++;
    return bits;
}

uint32_t cruise_start_longest(double dt_s, uint32_t think_frames)
{
    uint32_t least = cruise_frames(dt_s), most = (uint32_t)(CRUISE_LONG_S / dt_s + 0.5);
    uint32_t frames = DECISIONS * think_frames;
    if (least == 1 || frames <= least)
        return least;
    return frames < most ? frames : most;
}

/* Returns how many frames ago row i's group had its turn. */
static uint32_t since_turn(const struct step_context *context, uint32_t i)
{
    uint32_t group = i >> context->cruise_group_bits;
    return (context->cruise_phase + group * SPREAD) % context->cruise_frames;
}

/* Returns how many frames ago something was due that row i's agent does every `period` frames. */
static uint32_t since_due(const struct step_context *context, uint32_t i, uint32_t period)
{
    return ((uint32_t)context->tick + context->m->row[i].id) % period;
}

/* Returns true if the row is on its way by its order. */
static bool is_under_way(const struct entities *m, uint32_t i)
{
    return m->row[i].state == ENTITY_ACTIVE &&
           (m->row[i].behaviour == BEHAVIOUR_PATROL || m->row[i].behaviour == BEHAVIOUR_ROUTE ||
            m->row[i].behaviour == BEHAVIOUR_WITHDRAW ||
            m->row[i].behaviour == BEHAVIOUR_BACK_OFF || m->row[i].behaviour == BEHAVIOUR_FLEE);
}

bool cruise_start_crowd(const struct step_context *context)
{
    return context->think_frames >= context->cruise_short;
}

/* Returns true if the row avoids nothing and need not slow down, or would hold its way and its
 * speed for a stretch anyway. */
static bool holds_its_way(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return (m->row[i].dodge == 0.0f && m->row[i].ease == 0.0f) || cruise_start_crowd(context);
}

/* Returns true if nothing has happened to the row, and it aims at nothing. */
static bool is_undisturbed(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    bool aims =
        m->row[i].target_id != 0 && context->world->kinds[m->row[i].kind].munition != KIND_NONE;
    return !aims && m->row[i].threat_id == 0 && m->row[i].bumped == 0 && m->row[i].trigger == 0 &&
           !(m->row[i].flags & (ENTITY_FLAG_BURST | ENTITY_FLAG_CHASSIS)) &&
           m->row[i].turret == 0.0f && m->row[i].gun == 0.0f && m->row[i].spin_x == 0.0 &&
           m->row[i].spin_y == 0.0 && m->row[i].spin_z == 0.0;
}

/* Returns true if row i's vehicle is where it can cruise: not one that is aground or has landed,
 * and not an aircraft that keeps from another one by its height
 * (mover/agent/aircraft_separation.h), unless it would not look out sooner anyway. */
static bool cruises(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    enum domain domain = (enum domain)context->world->kinds[m->row[i].kind].domain;
    if (domain == DOMAIN_AIR)
        return !(m->row[i].flags & ENTITY_FLAG_LANDED) &&
               (m->row[i].climb == 0.0f || cruise_start_crowd(context));
    return domain == DOMAIN_LAND || !(m->row[i].flags & ENTITY_FLAG_AGROUND);
}

/* Returns true if row i's stretch has ended by itself just now. */
static bool has_ended(const struct step_context *context, uint32_t i)
{
    return context->m->row[i].cruise_tick != 0 &&
           context->m->row[i].cruise_tick + 1u == (uint32_t)context->tick;
}

/* Returns the frames from this one to the group's next turn if row i may try to cruise now; else
 * 0. A row that something has stopped or that was refused tries again some frames later. Where
 * stretches are longer than decisions are apart, it does not decide before its turn: it tries a
 * stretch that ends before, and a longer one when it decides. */
static uint32_t tries_for(const struct step_context *context, uint32_t i)
{
    const bool lasts = context->cruise_frames > context->cruise_short;
    const uint32_t again = cruise_start_crowd(context) ? TRY_SOONER : TRY_FRAMES;
    uint32_t since = since_turn(context, i);
    uint32_t left = context->cruise_frames - since;
    if (since == 0 || (left >= CRUISE_START_LEAST && has_ended(context, i)) ||
        (lasts && left >= again && step_context_thinks(context, i)))
        return left;
    if (since % again != 0)
        return 0;
    if (lasts) {
        uint32_t rest = context->think_frames - since_due(context, i, context->think_frames);
        left = rest < left ? rest : left;
    }
    return left >= again ? left : 0;
}

/* Returns the frames from this one to the next decision of row i's agent if it decides in this
 * frame; else 0. So few that a stretch does not pay count as none. Aircraft that avoid something
 * are moved in each frame: they climb and turn while they do. */
static uint32_t decides_for(const struct step_context *context, uint32_t i)
{
    bool flies = context->world->kinds[context->m->row[i].kind].domain == DOMAIN_AIR;
    return !flies && context->think_frames >= CRUISE_START_LEAST && step_context_thinks(context, i)
               ? context->think_frames
               : 0;
}

/* Returns true if row i drives on land, or flies in a crowd, and does not come to its goal within
 * so many frames. */
static bool travels_far(const struct step_context *context, uint32_t i, uint32_t frames)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    double way_m = kind->max_speed_mps * context->dt_s * (double)frames + NEAR_GOAL_M;
    return (kind->domain == DOMAIN_LAND ||
            (kind->domain == DOMAIN_AIR && cruise_start_crowd(context))) &&
           dx * dx + dz * dz > way_m * way_m;
}

uint32_t cruise_start_frames(const struct step_context *context, uint32_t i)
{
    if (context->cruise_frames == 1)
        return 0;
    uint32_t frames = holds_its_way(context, i) ? tries_for(context, i) : decides_for(context, i);
    if (frames == 0 || !is_under_way(context->m, i) || !is_undisturbed(context, i) ||
        !cruises(context, i))
        return 0;
    return frames > context->cruise_short && !travels_far(context, i, frames)
               ? context->cruise_short
               : frames;
}

bool cruise_start_due(const struct step_context *context, uint32_t i, uint32_t period)
{
    uint32_t frames = cruise_start_frames(context, i);
    uint32_t past = since_due(context, i, period);
    return frames > 0 && (past == 0 || period - past < frames);
}

uint32_t cruise_start_think_frames(const struct step_context *context, uint32_t i)
{
    uint32_t frames = cruise_start_frames(context, i);
    return frames > context->think_frames ? frames : context->think_frames;
}
