/* The list of intents of the frame. */
#include "mover/context/serial_context.h"

#include "world/entity/event.h"
#include "world/params.h"
#include "world/state.h"
#include "world/cruise_pose.h"
#include "world/world.h"

#include <string.h>

struct event *serial_context_intent(struct serial_context *context, enum event_type type)
{
    struct state_head *head = context->moved->head;
    if (head->intent_count >= context->step->world->params->intents_per_frame) {
        head->tally.events_dropped++;
        return NULL;
    }
    struct event *intent = &context->moved->intents[head->intent_count++];
    memset(intent, 0, sizeof *intent); /* padding too: the event digest covers every byte */
    intent->type = type;
    return intent;
}

struct event_party serial_context_party(const struct serial_context *context, uint32_t row)
{
    const struct entities *m = &context->moved->entities;
    return (struct event_party){
        .id = m->row[row].id, .kind = m->row[row].kind, .fixed = 0, .damage = m->row[row].damage};
}

void serial_context_stop(struct serial_context *context, uint32_t row, uint64_t tick)
{
    const struct step_context *step = context->step;
    cruise_pose_end(&context->writer, step->world, step->craters, row, tick, tick);
}
