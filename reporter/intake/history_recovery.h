/* What a new holder of a command ring has to know before it takes its first command. */
#ifndef JOLON_REPORTER_INTAKE_HISTORY_RECOVERY_H
#define JOLON_REPORTER_INTAKE_HISTORY_RECOVERY_H

#include "reporter/intake/command_history.h"
#include "ipc/segment/segment.h"

/* Fills the history as the predecessor's was: with the answers that the event ring holds, and with
 * the commands that wait in the ring. Without this a repeated command, which the ring's memory has
 * lost or loses to the next one put, would be done again. Reads the whole event ring: some
 * milliseconds. 0; -1 with errno EBADMSG when the world is damaged. */
int history_recover(struct command_history *history, const struct view *view,
                    enum command_ring ring);

#endif
