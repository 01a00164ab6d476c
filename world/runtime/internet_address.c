/* Addresses of the Internet in numbers. */
#include "world/runtime/internet_address.h"

#include "world/runtime/parse_number.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>

#define TEXT_MAX 64u /* room for any address with its port or its bits */

/* Reads the host of an address without brackets. */
static bool read_host(struct internet_address *address, const char *host, uint16_t port)
{
    *address = (struct internet_address){.port = port};
    if (inet_pton(AF_INET, host, address->bytes) == 1)
        return true;
    address->ipv6 = inet_pton(AF_INET6, host, address->bytes) == 1;
    return address->ipv6;
}

int internet_address_read(struct internet_address *address, const char *text, uint16_t port,
                          struct error_text *error)
{
    char host[TEXT_MAX];
    if (strlen(text) < sizeof host) {
        (void)snprintf(host, sizeof host, "%s", text);
        if (read_host(address, host, port)) /* also IPv6 without a port */
            return 0;
        uint64_t number;
        char *colon = strrchr(host, ':'), *name = host;
        if (colon && parse_whole(colon + 1, 1, UINT16_MAX, &number)) {
            *colon = '\0';
            port = (uint16_t)number;
        }
        size_t length = strlen(name);
        bool brackets = length > 0 && name[0] == '[' && name[length - 1] == ']';
        if (brackets) {
            name[length - 1] = '\0';
            name++;
        }
        /* IPv6 with a port has brackets, and IPv4 has none. */
        if ((strchr(name, ':') != NULL) == brackets && read_host(address, name, port))
            return 0;
    }
    return error_text_set(error, "must be an address in numbers with or without a port, such as "
                                 "127.0.0.1, 127.0.0.1:3000, ::1 or [::1]:3000");
}

int internet_address_range_read(struct internet_address_range *range, const char *text,
                                struct error_text *error)
{
    char host[TEXT_MAX];
    uint64_t bits;
    if (strlen(text) < sizeof host) {
        (void)snprintf(host, sizeof host, "%s", text);
        char *slash = strchr(host, '/');
        if (slash)
            *slash = '\0';
        if (read_host(&range->address, host, 0)) {
            uint64_t most = range->address.ipv6 ? 128 : 32;
            range->bits = (uint8_t)most;
            if (!slash)
                return 0;
            if (parse_whole(slash + 1, 0, most, &bits)) {
                range->bits = (uint8_t)bits;
                return 0;
            }
        }
    }
    return error_text_set(error, "must be an address in numbers or a range, such as 10.0.0.7, "
                                 "10.1.0.0/16, ::1 or fd00::/8");
}

bool internet_address_in(const struct internet_address *address,
                         const struct internet_address_range *range)
{
    static const uint8_t mapped[12] = {[10] = 0xff, [11] = 0xff};
    struct internet_address plain = *address;
    if (plain.ipv6 && !range->address.ipv6 && memcmp(plain.bytes, mapped, sizeof mapped) == 0) {
        plain.ipv6 = false;
        memmove(plain.bytes, plain.bytes + sizeof mapped, 4);
    }
    if (plain.ipv6 != range->address.ipv6)
        return false;
    for (unsigned i = 0; i < range->bits; i++) {
        uint8_t mask = (uint8_t)(0x80u >> i % 8);
        if ((plain.bytes[i / 8] ^ range->address.bytes[i / 8]) & mask)
            return false;
    }
    return true;
}
