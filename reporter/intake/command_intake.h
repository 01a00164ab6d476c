/* The way of a command from a client into the command ring, and of its reply back.
 *
 * A command is done once however often it comes and whenever this process is killed: the ring and
 * the events tell a successor what was taken and what was answered, and a client repeats what was
 * not answered. One thread. */
#ifndef JOLON_REPORTER_INTAKE_COMMAND_INTAKE_H
#define JOLON_REPORTER_INTAKE_COMMAND_INTAKE_H

#include "ipc/frame/event_cursor.h"
#include "reporter/intake/client_sockets.h"
#include "reporter/intake/command_history.h"
#include "world/entity/event.h"

#define INTAKE_EVENTS_AT_ONCE 128u

struct command_intake {
    struct client_sockets clients;
    struct admission admission;
    struct command_history history;
    struct event_cursor cursor; /* of the answers */
    struct event event[INTAKE_EVENTS_AT_ONCE];
    uint64_t refused_logged_ns, full_logged_ns;
};

/* Finds out what a predecessor took, then listens for clients. 0, or -1 with the reason. */
int command_intake_open(struct command_intake *intake, const struct view *view,
                        struct error_text *error);
void command_intake_close(struct command_intake *intake);

/* Answers what was committed, receives, and puts what is admitted into the ring. Does not block.
 * Once the run is over, commands are refused. */
void command_intake_poll(struct command_intake *intake, struct view *view, uint64_t now_ns);

/* True when a command waits for its turn or for its answer. */
bool command_intake_busy(const struct command_intake *intake);

#endif
