/* A way out to the network: one address, and counters of what was sent there. */
#ifndef JOLON_GATEWAY_UDP_OUTPUT_H
#define JOLON_GATEWAY_UDP_OUTPUT_H

#include "gateway/udp/udp_address.h"

struct udp_output {
    int socket;
    struct udp_address to;
    const char *what; /* "PDUs" */
    uint64_t sent, octets, failed;
    uint64_t failure_logged_ns;
};

/* Opens the socket. key: the scenario's, for the reason. what: a constant, for people. Returns 0,
 * or -1 with the reason. */
int udp_output_open(struct udp_output *output, const char *key, const char *address, uint16_t port,
                    const char *what, struct error_text *error);

/* Sends a datagram; 0 octets is one that was too long to write. One that cannot be sent is
 * counted, as the network may lose any; the log says so once a second at most. */
void udp_output_send(struct udp_output *output, const void *bytes, size_t size);

#endif
