/* Addresses of UDP in numbers (world/runtime/internet_address.h), as sockets take them. */
#ifndef JOLON_GATEWAY_UDP_UDP_ADDRESS_H
#define JOLON_GATEWAY_UDP_UDP_ADDRESS_H

#include "world/runtime/internet_address.h"

#include <netinet/in.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct udp_address {
    union {
        struct sockaddr any;
        struct sockaddr_in v4;
        struct sockaddr_in6 v6;
    };
};

#define UDP_ADDRESS_TEXT 64u /* room for any address with its port */

/* Reads an address. A text without a port has the given one. Returns 0, or -1 with the reason in
 * error. */
int udp_address_parse(struct udp_address *address, const char *text, uint16_t port,
                      struct error_text *error);

/* Writes the address and its port into text, cut where the size ends. Returns text. */
const char *udp_address_text(const struct udp_address *address, char *text, size_t size);

/* Returns the address as lists of addresses take it. */
struct internet_address udp_address_internet(const struct udp_address *address);

uint16_t udp_address_port(const struct udp_address *address);
socklen_t udp_address_bytes(const struct udp_address *address);
bool udp_address_multicast(const struct udp_address *address);
/* Returns true for an address of IPv6 that means something on one link alone, and needs an
 * interface: fe80::/10, ff01::/16 and ff02::/16. */
bool udp_address_link_local(const struct udp_address *address);

/* Gives such an address its interface, by its number. Leaves others as they are. */
void udp_address_scope(struct udp_address *address, unsigned interface);

/* Returns true for 0.0.0.0 and ::, all addresses of this machine. */
bool udp_address_wildcard(const struct udp_address *address);

bool udp_address_loopback(const struct udp_address *address);

/* Returns true if both have the same host; the ports may differ. */
bool udp_address_same_host(const struct udp_address *a, const struct udp_address *b);

#endif
