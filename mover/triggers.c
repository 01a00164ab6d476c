/* Requests that rows left in their field `trigger` while they moved. */
#include "mover/triggers.h"

#include "mover/agent/agent.h"
#include "mover/motion/ground/landing.h"
#include "mover/motion/ground/wreck.h"
#include "mover/motion/ship.h"
#include "mover/weapon/fire.h"
#include "mover/weapon/spawn.h"
#include "world/entity/event.h"
#include "world/entity/table_write.h"
#include "world/state.h"
#include "world/world.h"

static void tell_change(struct serial_context *context, uint32_t i, enum agent_reason because)
{
    const struct entities *w = &context->step->committed->entities;
    const struct entities *m = &context->moved->entities;
    struct event *event = serial_context_intent(context, EVENT_AGENT);
    if (event)
        event->agent = (struct event_agent){serial_context_party(context, i), w->row[i].behaviour,
                                            m->row[i].behaviour, (uint32_t)because};
    context->moved->head->tally.agent_changes++;
}

/* Removes a row that has crossed the edge of the world. */
static void leave_world(struct serial_context *context, uint32_t i)
{
    tell_change(context, i, REASON_LEFT_WORLD);
    spawn_remove(context, i);
}

static void tell_grounded(struct serial_context *context, uint32_t i)
{
    if (context->step->world->kinds[context->moved->entities.row[i].kind].domain == DOMAIN_SEA)
        ship_tell_aground(context, i);
    else
        landing_tell_hard(context, i);
}

void triggers_pull(struct serial_context *context, uint32_t i)
{
    const struct entities *m = &context->moved->entities;
    uint8_t trigger = m->row[i].trigger;
    if (trigger == 0)
        return;
    table_set_trigger(&context->writer, i, 0);
    if (trigger == TRIGGER_BROKEN) {
        wreck_tell_broken(context, i);
        return;
    }
    if (trigger == TRIGGER_AGROUND) {
        tell_grounded(context, i);
        return;
    }
    if (trigger == TRIGGER_LEFT_WORLD) {
        leave_world(context, i);
        return;
    }
    if (trigger >> TRIGGER_REASON_SHIFT)
        tell_change(context, i, (enum agent_reason)((trigger >> TRIGGER_REASON_SHIFT) - 1));
    if ((trigger & TRIGGER_FIRE) && entities_alive(m, m->row[i].target_slot, m->row[i].target_id))
        fire_shoot(context, i, m->row[i].target_slot, KIND_NONE);
    if (trigger & TRIGGER_FIRE_AT)
        fire_shoot_at(context, i, m->row[i].goal_x, m->row[i].goal_z, KIND_NONE);
}
