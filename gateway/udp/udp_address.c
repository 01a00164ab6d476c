/* Addresses of UDP. */
#include "gateway/udp/udp_address.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>

int udp_address_parse(struct udp_address *address, const char *text, uint16_t port,
                      struct error_text *error)
{
    struct internet_address read;
    if (internet_address_read(&read, text, port, error) != 0)
        return -1;
    memset(address, 0, sizeof *address);
    if (read.ipv6) {
        address->v6.sin6_family = AF_INET6;
        address->v6.sin6_port = htons(read.port);
        memcpy(&address->v6.sin6_addr, read.bytes, sizeof address->v6.sin6_addr);
    } else {
        address->v4.sin_family = AF_INET;
        address->v4.sin_port = htons(read.port);
        memcpy(&address->v4.sin_addr, read.bytes, sizeof address->v4.sin_addr);
    }
    return 0;
}

struct internet_address udp_address_internet(const struct udp_address *address)
{
    struct internet_address to = {.ipv6 = address->any.sa_family == AF_INET6,
                                  .port = udp_address_port(address)};
    if (to.ipv6)
        memcpy(to.bytes, &address->v6.sin6_addr, sizeof address->v6.sin6_addr);
    else
        memcpy(to.bytes, &address->v4.sin_addr, sizeof address->v4.sin_addr);
    return to;
}

const char *udp_address_text(const struct udp_address *address, char *text, size_t size)
{
    char host[INET6_ADDRSTRLEN] = "?";
    if (address->any.sa_family == AF_INET6) {
        inet_ntop(AF_INET6, &address->v6.sin6_addr, host, sizeof host);
        snprintf(text, size, "[%s]:%u", host, udp_address_port(address));
    } else {
        inet_ntop(AF_INET, &address->v4.sin_addr, host, sizeof host);
        snprintf(text, size, "%s:%u", host, udp_address_port(address));
    }
    return text;
}

uint16_t udp_address_port(const struct udp_address *address)
{
    return ntohs(address->any.sa_family == AF_INET6 ? address->v6.sin6_port : address->v4.sin_port);
}

socklen_t udp_address_bytes(const struct udp_address *address)
{
    return address->any.sa_family == AF_INET6 ? sizeof address->v6 : sizeof address->v4;
}

bool udp_address_multicast(const struct udp_address *address)
{
    if (address->any.sa_family == AF_INET6)
        return IN6_IS_ADDR_MULTICAST(&address->v6.sin6_addr);
    return IN_MULTICAST(ntohl(address->v4.sin_addr.s_addr));
}

bool udp_address_link_local(const struct udp_address *address)
{
    const struct in6_addr *v6 = &address->v6.sin6_addr;
    return address->any.sa_family == AF_INET6 &&
           (IN6_IS_ADDR_LINKLOCAL(v6) || IN6_IS_ADDR_MC_LINKLOCAL(v6) ||
            IN6_IS_ADDR_MC_NODELOCAL(v6));
}

void udp_address_scope(struct udp_address *address, unsigned interface)
{
    if (udp_address_link_local(address))
        address->v6.sin6_scope_id = interface;
}

bool udp_address_wildcard(const struct udp_address *address)
{
    if (address->any.sa_family == AF_INET6)
        return IN6_IS_ADDR_UNSPECIFIED(&address->v6.sin6_addr);
    return address->v4.sin_addr.s_addr == htonl(INADDR_ANY);
}

bool udp_address_loopback(const struct udp_address *address)
{
    if (address->any.sa_family == AF_INET6)
        return IN6_IS_ADDR_LOOPBACK(&address->v6.sin6_addr);
    return ntohl(address->v4.sin_addr.s_addr) >> 24 == IN_LOOPBACKNET;
}

bool udp_address_same_host(const struct udp_address *a, const struct udp_address *b)
{
    if (a->any.sa_family != b->any.sa_family)
        return false;
    if (a->any.sa_family == AF_INET6)
        return memcmp(&a->v6.sin6_addr, &b->v6.sin6_addr, sizeof a->v6.sin6_addr) == 0;
    return a->v4.sin_addr.s_addr == b->v4.sin_addr.s_addr;
}
