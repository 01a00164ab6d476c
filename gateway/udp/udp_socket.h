/* Sockets of UDP for PDUs: unicast, broadcast and multicast. No call blocks but udp_socket_wait().
 */
#ifndef JOLON_GATEWAY_UDP_UDP_SOCKET_H
#define JOLON_GATEWAY_UDP_UDP_SOCKET_H

#include "gateway/udp/udp_address.h"

#define UDP_SOCKET_BYTES_MAX 65536u /* room for any datagram */
#define UDP_SOCKET_AT_ONCE   32u    /* datagrams by one call */

/* Opens a socket that sends to an address, which is none of 0.0.0.0 and ::. interface: the number
 * of the interface by which multicast leaves; 0: the system's choice. Multicast stays within the
 * network (TTL 1). Returns the descriptor, or -1 with the reason in error. */
int udp_socket_sender(const struct udp_address *to, unsigned interface, struct error_text *error);

/* Opens a socket that receives what is sent to an address of this machine, to a broadcast, or to a
 * group of multicast, which it joins by the interface. What is sent to an address of this machine
 * has one receiver: it is refused when another program has it. Groups and broadcasts may have
 * several. */
int udp_socket_listener(const struct udp_address *at, unsigned interface, struct error_text *error);

/* Returns true if an address is that of a broadcast on a network of this machine. */
bool udp_socket_broadcast(const struct udp_address *address);

/* Gives a new socket the port from which it sends: this one, or another where that is 0 or is in
 * use. Returns the port, 0 when there is none. */
uint16_t udp_socket_port(int socket, uint16_t wanted);

/* Sends a datagram. Returns 0, or -1 with errno. A host that says that nobody receives is no error.
 */
int udp_socket_send(int socket, const struct udp_address *to, const void *bytes, size_t size);

/* Receives a datagram into bytes. Returns its size, -1 when there is none. */
int udp_socket_receive(int socket, void *bytes, size_t size, struct udp_address *from);

/* A datagram of several that are received by one call. */
struct udp_datagram {
    struct udp_address from;
    uint8_t *bytes; /* the caller's memory */
    size_t room;    /* of it; a longer datagram is cut off there */
    size_t size;    /* out */
};

/* Receives the datagrams that have come, at most count and UDP_SOCKET_AT_ONCE. Sets from and size
 * of each. Returns their number. */
uint32_t udp_socket_receive_many(int socket, struct udp_datagram *datagrams, uint32_t count);

/* Waits for a datagram, at most for a time. Returns true when there is one. */
bool udp_socket_wait(int socket, uint64_t wait_ns);

#endif
