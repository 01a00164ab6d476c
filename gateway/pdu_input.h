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
    uint64_t foreign;                 /* PDUs of other exercises */
    uint64_t echoes;                  /* our own, come back */
    uint64_t bad;                     /* PDUs and datagrams with a fault; counts.result has which */
    uint16_t sender_port;             /* from which our own are sent; 0: unknown */
    uint64_t twins;                   /* PDUs with our own numbers that another sender has sent */
    /* The last of each, for the log, and what it has told. */
    struct udp_address stranger_from, foreign_from, twin_from, bad_from;
    uint8_t foreign_exercise;
    uint64_t strangers_told, foreign_told, twins_told, bad_told;
    uint64_t foreign_told_ns, twins_told_ns;
};

/* Opens the socket at the address "ADDRESS" or "ADDRESS:PORT"; for PDU_INPUT_NONE none is opened.
 * interface: by which a group of multicast is joined (udp_interface.h). exercise, own and peers are
 * set. Returns 0, or -1 with the reason. */
int pdu_input_open(struct pdu_input *input, const char *listen, unsigned interface,
                   struct error_text *error);

/* Returns true if the input hears what others send to the address to which we send, as far as that
 * is a group or a broadcast. */
bool pdu_input_hears(const struct pdu_input *input, const struct udp_address *to);

/* Reads what has come, at most PDU_INPUT_DATAGRAMS, and hands it to the handler. Returns the number
 * of datagrams. */
uint32_t pdu_input_receive(struct pdu_input *input, pdu_input_handler *handler, void *context,
                           uint64_t now_ns);

/* Tell the log what was left out and why (gateway/notices.h): strangers, faults, other exercises
 * (once a minute), and others who use our own numbers (once a minute). input: a struct pdu_input.
 * Return true if there was something new. */
bool pdu_input_tell_strangers(void *input, uint64_t now_ns);
bool pdu_input_tell_faults(void *input, uint64_t now_ns);
bool pdu_input_tell_foreign(void *input, uint64_t now_ns);
bool pdu_input_tell_twins(void *input, uint64_t now_ns);

#endif
