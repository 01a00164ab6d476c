/* Requests that rows left in their column `trigger` while they moved. */
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

#include <string.h>

static void tell_change(struct serial_context *context, uint32_t i, enum agent_reason because)
{
    const struct entities *w = &context->step->committed->entities;
    const struct entities *m = &context->moved->entities;
    struct event *event = serial_context_intent(context, EVENT_AGENT);
    if (event)
        event->agent = (struct event_agent){serial_context_party(context, i), w->behaviour[i],
                                            m->behaviour[i], (uint32_t)because};
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
    if (context->step->world->kinds[context->moved->entities.kind[i]].domain == DOMAIN_SEA)
        ship_tell_aground(context, i);
    else
        landing_tell_hard(context, i);
}

static void pull_trigger(struct serial_context *context, uint32_t i)
{
    const struct entities *m = &context->moved->entities;
    uint8_t trigger = m->trigger[i];
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
    if ((trigger & TRIGGER_FIRE) && entities_alive(m, m->target_slot[i], m->target_id[i]))
        fire_shoot(context, i, m->target_slot[i], KIND_NONE);
    if (trigger & TRIGGER_FIRE_AT)
        fire_shoot_at(context, i, m->goal_x[i], m->goal_z[i], KIND_NONE);
}

/* Few rows have a trigger; rows without one are skipped eight at a time. */
void triggers_pull(struct serial_context *context, uint32_t first, uint32_t end)
{
    const uint8_t *trigger = context->moved->entities.trigger;
    for (; first < end; first += 8) {
        uint32_t past = end - first < 8 ? end : first + 8;
        uint64_t eight = 0;
        memcpy(&eight, trigger + first, past - first);
        for (uint32_t i = first; i < past && eight != 0; i++) {
            if (trigger[i] != 0)
                pull_trigger(context, i);
        }
    }
}
