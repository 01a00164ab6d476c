/* Receives PDUs from the network: reads each datagram (gateway/pdu), counts, leaves out what is not
 * for us, and hands every other PDU to a handler. Nothing that comes in is trusted, and a pass
 * reads a bounded number of datagrams: what a sender sends beyond that the system drops. */
#ifndef JOLON_GATEWAY_PDU_INPUT_H
#define JOLON_GATEWAY_PDU_INPUT_H

#include "gateway/entity_ids.h"
#include "gateway/pdu/pdu_read.h"
#include "gateway/udp/udp_socket.h"
#include "world/gateway_lists.h"

#define PDU_INPUT_NONE "none" /* of gateway.listen */

/* Datagrams that one call of pdu_input_receive() reads at most. */
#define PDU_INPUT_DATAGRAMS 256u

/* Takes a PDU that is good, of our exercise and not our own. from: the sender's address. now_ns:
 * the time of the clock at which it was read. */
typedef void pdu_input_handler(void *context, const struct pdu *pdu, const struct udp_address *from,
                               uint64_t now_ns);

struct pdu_input {
    int socket; /* -1: nothing is received */
    struct udp_address at;
    uint8_t exercise;
    struct entity_ids own;            /* what these identifiers issued is our own, come back */
    struct gateway_lists_peers peers; /* from whom datagrams are taken */
    struct pdu_counts counts;         /* of what is taken */
    uint64_t strangers;               /* datagrams of others */
    uint64_t strangers_logged_ns, strangers_logged;
    uint64_t foreign; /* PDUs of other exercises */
    uint64_t foreign_logged_ns;
    uint64_t echoes; /* our own, come back */
    uint64_t bad;    /* PDUs and datagrams with a fault; counts.result has which */
    uint64_t fault_logged_ns, bad_logged;
};

/* Opens the socket at the address "ADDRESS" or "ADDRESS:PORT"; for PDU_INPUT_NONE none is opened.
 * exercise, own and peers are set. Returns 0, or -1 with the reason. */
int pdu_input_open(struct pdu_input *input, const char *listen, struct error_text *error);

/* Reads what has come, at most PDU_INPUT_DATAGRAMS, and hands it to the handler. Faults and
 * strangers are logged once a second at most, another exercise once a minute. Returns the number of
 * datagrams. */
uint32_t pdu_input_receive(struct pdu_input *input, pdu_input_handler *handler, void *context,
                           uint64_t now_ns);

#endif
