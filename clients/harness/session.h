/* The session with the program: executes its lines and reports the world's state and events. */
#ifndef JOLON_CLIENTS_HARNESS_SESSION_H
#define JOLON_CLIENTS_HARNESS_SESSION_H

#include "clients/harness/command_queue.h"
#include "clients/harness/input.h"
#include "clients/harness/options.h"
#include "clients/harness/subscription.h"
#include "ipc/topics/command_route.h"

struct session {
    struct options options;
    struct dds_link link;
    struct world_mirror mirror;
    struct event_merge merge;
    bool has_merge; /* merge is open, since events were first subscribed to */
    struct command_client client;
    struct command_route route; /* of the client */
    struct input input;
    struct output output;
    struct leases leases;
    struct command_queue queue;
    struct subscription subscription;
    uint64_t run;  /* of the world whose description was written last */
    bool released; /* at the end of input the program's vehicles were released */
    int wake_fd;   /* readable when DDS data has come */
};

/* Opens the link and its readers. Returns 0, or -1 with the error. */
int session_open(struct session *session, struct error_text *error);
void session_close(struct session *session);

/* Waits for the world's description, at most the options' timeout. Returns false if it has not
 * come. */
bool session_wait_for_world(struct session *session);

/* Handles lines, replies, states and events. Does not block. */
void session_turn(struct session *session, uint64_t now_ns);

/* Waits until session_turn() is due, and reads and writes standard input and output. */
void session_wait(struct session *session);

/* Returns true if input has ended and all answers are written, or if the reader has gone. */
bool session_finished(const struct session *session);

#endif
