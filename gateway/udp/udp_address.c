/* Addresses of UDP. */
#include "gateway/udp/udp_address.h"

#include "world/runtime/parse_number.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>

/* Reads the host of an address without brackets. */
static bool host_of(struct udp_address *address, const char *host, uint16_t port)
{
    memset(address, 0, sizeof *address);
    if (inet_pton(AF_INET, host, &address->v4.sin_addr) == 1) {
        address->v4.sin_family = AF_INET;
        address->v4.sin_port = htons(port);
        return true;
    }
    memset(address, 0, sizeof *address);
    if (inet_pton(AF_INET6, host, &address->v6.sin6_addr) != 1)
        return false;
    address->v6.sin6_family = AF_INET6;
    address->v6.sin6_port = htons(port);
    return true;
}

int udp_address_parse(struct udp_address *address, const char *text, uint16_t port,
                      struct error_text *error)
{
    char host[UDP_ADDRESS_TEXT];
    if (strlen(text) < sizeof host) {
        (void)snprintf(host, sizeof host, "%s", text);
        if (host_of(address, host, port)) /* also IPv6 without a port */
            return 0;
        uint64_t number;
        char *colon = strrchr(host, ':'), *name = host;
        if (colon && parse_whole(colon + 1, 1, 65535, &number)) {
            *colon = '\0';
            port = (uint16_t)number;
        }
        size_t length = strlen(name);
        bool brackets = name[0] == '[' && name[length - 1] == ']';
        if (brackets) {
            name[length - 1] = '\0';
            name++;
        }
        /* IPv6 with a port has brackets, and IPv4 has none. */
        if ((strchr(name, ':') != NULL) == brackets && host_of(address, name, port))
            return 0;
    }
    return error_text_set(error, "must be an address in numbers with or without a port, such as "
                                 "127.0.0.1, 127.0.0.1:3000, ::1 or [::1]:3000");
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
