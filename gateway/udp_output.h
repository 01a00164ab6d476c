/* A way out to the network: one address, and counters of what was sent there. */
#ifndef JOLON_GATEWAY_UDP_OUTPUT_H
#define JOLON_GATEWAY_UDP_OUTPUT_H

#include "gateway/udp/udp_address.h"

struct udp_output {
    int socket;
    struct udp_address to;
    const char *what; /* "PDUs" */
    uint64_t sent, octets, failed;
    uint64_t failed_told;
    int cause; /* errno of the last that failed, 0: it was too long */
};

/* Opens the socket. key: the scenario's, for the reason. interface: by which multicast leaves
 * (udp_interface.h). what: a constant, for people. Returns 0, or -1 with the reason. */
int udp_output_open(struct udp_output *output, const char *key, const char *address, uint16_t port,
                    unsigned interface, const char *what, struct error_text *error);

/* Sends a datagram; 0 octets is one that was too long to write. One that cannot be sent is
 * counted, as the network may lose any. */
void udp_output_send(struct udp_output *output, const void *bytes, size_t size);

/* Tells the log how many could not be sent (gateway/notices.h). output: a struct udp_output. */
bool udp_output_tell(void *output, uint64_t now_ns);

#endif
