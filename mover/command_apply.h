/* Commands of players and programs: each is applied once, in the order of its ring, and answered
 * by an event. */
#ifndef JOLON_MOVER_COMMAND_APPLY_H
#define JOLON_MOVER_COMMAND_APPLY_H

#include "mover/context/serial_context.h"

/* One command ring as the step sees it: the commands before end may be taken. */
struct command_source {
    const struct command *slot;
    uint64_t slots; /* power of two */
    uint64_t end;   /* sequence number */
};

/* Applies the commands of all rings [COMMAND_RING_COUNT], before any row moves. */
void command_apply_all(struct serial_context *context, const struct command_source *sources);

#endif
