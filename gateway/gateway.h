/* The gateway: the ways out and the way in, and what is done with what comes. main.c is its
 * process. One thread. */
#ifndef JOLON_GATEWAY_GATEWAY_H
#define JOLON_GATEWAY_GATEWAY_H

#include "gateway/entity_output.h"
#include "gateway/event_output.h"
#include "gateway/management.h"
#include "gateway/notices.h"
#include "gateway/pdu_input.h"
#include "gateway/remote_input.h"
#include "ipc/topics/command_socket.h"

struct gateway {
    struct view view;
    struct type_table types;
    struct pdu_output output;
    struct pdu_input input;
    struct remote_input remotes;
    uint64_t without_effect; /* PDUs that were received and that nothing here acts on */
    struct cot_output cot;
    struct command_socket commands; /* of management; connected when somebody may control us */
    struct management management;
    struct entity_output entities;
    struct event_output events;
    struct notices notices;
    uint64_t postponed_told, gaps_told;
};

/* Reads the types and opens the sockets, by the parameters of the world of that name. The view is
 * attached. Returns 0, or -1 with the reason. */
int gateway_open(struct gateway *gateway, const char *world, struct error_text *error);

/* Sends what is due, as the role's work on the last frame. */
void gateway_send(struct gateway *gateway);

/* Between two of these: sends what has become due of the entities that turn fast. */
void gateway_follow(struct gateway *gateway);

/* Receives until due_ns (CLOCK_MONOTONIC), or until the process is to stop. */
void gateway_receive(struct gateway *gateway, uint64_t due_ns);

/* Sends a last state of every entity if the run is over, and closes. */
void gateway_close(struct gateway *gateway);

#endif
