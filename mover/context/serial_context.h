/* The data that the serial part of the step shares. That part creates entities, fires shots and
 * answers commands. It runs on one thread, in the order of the rows. */
#ifndef JOLON_MOVER_CONTEXT_SERIAL_CONTEXT_H
#define JOLON_MOVER_CONTEXT_SERIAL_CONTEXT_H

#include "mover/context/step_context.h"
#include "world/entity/event.h"
#include "world/entity/table_write.h"

struct remote_index;

struct serial_context {
    const struct step_context *step;
    struct moved *moved;
    struct table_writer writer; /* every change of moved's rows goes through this */
    struct remote_index *remotes;
};

/* Appends an intent and returns it, zero except its type. NULL when the frame has no room. */
struct event *serial_context_intent(struct serial_context *context, enum event_type type);

/* A row as events name it. */
struct event_party serial_context_party(const struct serial_context *context, uint32_t row);

/* Ends the stretch of a row where it is at the tick, if it cruises then: before the rows have moved
 * the tick of the committed world, and then that of the step. */
void serial_context_stop(struct serial_context *context, uint32_t row, uint64_t tick);

#endif
