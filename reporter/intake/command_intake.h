/* The path of a command from a client into the command ring, and of its reply back.
 *
 * A command is executed once, however often it comes and whenever this process is killed. A new
 * intake learns from the ring and the events which commands were taken and answered, and a client
 * repeats a command until it is answered. One thread. */
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
    struct event_cursor cursor; /* for the answers */
    struct event event[INTAKE_EVENTS_AT_ONCE];
    uint64_t refused_logged_ns, full_logged_ns;
};

/* Recovers the predecessor's history, then listens for clients. Returns 0, or -1 with the
 * reason. */
int command_intake_open(struct command_intake *intake, const struct view *view,
                        struct error_text *error);
void command_intake_close(struct command_intake *intake);

/* Replies to commands of committed frames, receives commands, and puts admitted commands into the
 * ring. Once the run has ended, commands are refused. Does not block. */
void command_intake_poll(struct command_intake *intake, struct view *view, uint64_t now_ns);

/* Returns true if a command waits for admission or for its answer. */
bool command_intake_busy(const struct command_intake *intake);

#endif
