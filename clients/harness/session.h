/* The session with the program: its lines carried out, and what the world says told. */
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
    bool has_merge; /* the tail is open: events were wanted once */
    struct command_client client;
    struct command_route route; /* of the caller */
    struct input input;
    struct output output;
    struct leases leases;
    struct command_queue queue;
    struct subscription subscription;
    uint64_t run;  /* of the world that was told last */
    bool released; /* at the end: what it drove is given back */
    int wake_fd;   /* readable when something came over DDS */
};

/* Opens the link and all that is read from the start. -1 with the reason. */
int session_open(struct session *session, struct error_text *error);
void session_close(struct session *session);

/* Waits until the world says what it is, at most the options' timeout. False: it does not. */
bool session_wait_for_world(struct session *session);

/* One turn: lines, answers, states, events. Does not block. */
void session_turn(struct session *session, uint64_t now_ns);

/* Waits for the next turn. */
void session_wait(struct session *session);

/* Has everything been said and answered, or can it be told to nobody? */
bool session_finished(const struct session *session);

#endif
