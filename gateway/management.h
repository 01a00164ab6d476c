/* Simulation management: Start/Resume and Stop/Freeze of other simulations, obeyed where the
 * scenario allows it (gateway.control), and acknowledged.
 *
 * The world is paused and resumed by commands over the world's command socket, as by jolon ctl: so
 * they are in the log, and a replay does the same. A request is carried out when it comes, whatever
 * its number: a simulation that starts anew counts from the beginning again, and pausing a paused
 * world changes nothing. Only what the network has doubled or delayed is not, and that is known by
 * the time stamps of the last MANAGEMENT_NETWORK_S. A request that waits for its time is in the
 * role's notes, so that a gateway that starts anew carries it out. */
#ifndef JOLON_GATEWAY_MANAGEMENT_H
#define JOLON_GATEWAY_MANAGEMENT_H

#include "gateway/entity_ids.h"
#include "gateway/management_notes.h"
#include "gateway/pdu_output.h"
#include "ipc/topics/command_client.h"
#include "world/gateway_lists.h"

#define MANAGEMENT_REQUESTS MANAGEMENT_NOTES /* that are remembered */

/* What the network doubles or delays comes within this time [s]. */
#define MANAGEMENT_NETWORK_S 2.0

/* A request for a later time than this is not taken. */
#define MANAGEMENT_AHEAD_S 3600.0

/* Without an answer of the mover within this time a request counts as not carried out. */
#define MANAGEMENT_ANSWER_NS 3000000000u

enum management_state {
    MANAGEMENT_FREE,
    MANAGEMENT_WAITS, /* for its time; it has been acknowledged */
    MANAGEMENT_SENT,  /* the command is on its way */
    MANAGEMENT_DONE
};

struct management_request {
    struct pdu_id from, as; /* the sender, and the identifier that acknowledges */
    uint32_t number;
    uint8_t type; /* enum pdu_type */
    uint8_t state;
    uint16_t response; /* enum pdu_response, when done */
    uint32_t owed;     /* acknowledgements to send, when the command is answered */
    uint32_t stamp;    /* the time stamp of its PDU, and when that came */
    uint64_t heard_ns;
    double due_s;               /* since 1970, UTC */
    uint64_t sequence, late_ns; /* of the command, and when its answer is late */
};

struct management {
    struct pdu_output *output;
    struct entity_ids ids;
    struct gateway_lists_control control;
    struct command_client client;
    struct management_notes *notes;
    struct management_request request[MANAGEMENT_REQUESTS];
    uint32_t next;                /* where the search for the place of the next request begins */
    uint64_t refused, done, full; /* requests of others; that were answered; without a place */
    /* For the log: the last of each, and what it has told. */
    struct management_request refused_last, done_last;
    const char *done_why;
    uint64_t refused_told, done_told;
};

/* Takes the settings, an open link for commands, and the notes of a predecessor, whose requests it
 * takes over. Returns 0, or -1 with the reason. */
int management_open(struct management *management, struct pdu_output *output, struct entity_ids ids,
                    const char *control, struct command_link link, struct management_notes *notes,
                    struct error_text *error);

/* Takes a PDU. Those that are none of Create, Remove, Start/Resume and Stop/Freeze, and those for
 * others, are left out. now_ns is CLOCK_MONOTONIC, utc_s the seconds since 1970. */
void management_receive(struct management *management, const struct pdu *pdu, uint64_t now_ns,
                        double utc_s);

/* Carries out requests whose time has come, and acknowledges those that the mover has answered. */
void management_poll(struct management *management, uint64_t now_ns, double utc_s);

/* Tell the log of requests that were answered, and of those that are ignored (gateway/notices.h).
 * management: a struct management. Return true if there was something new. */
bool management_tell_done(void *management, uint64_t now_ns);
bool management_tell_refused(void *management, uint64_t now_ns);

#endif
