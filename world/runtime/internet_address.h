/* Addresses of the Internet in numbers, as people write them: 127.0.0.1, 127.0.0.1:3000, ::1,
 * [::1]:3000, and ranges such as 10.1.0.0/16. Names are not looked up, because that takes files and
 * sockets that a sandbox forbids. Pure; any thread. */
#ifndef JOLON_WORLD_RUNTIME_INTERNET_ADDRESS_H
#define JOLON_WORLD_RUNTIME_INTERNET_ADDRESS_H

#include "world/runtime/error_text.h"

#include <stdbool.h>
#include <stdint.h>

struct internet_address {
    bool ipv6;
    uint8_t bytes[16]; /* in the order of the network; IPv4 has the first 4 */
    uint16_t port;
};

/* The addresses whose first bits are those of an address. */
struct internet_address_range {
    struct internet_address address;
    uint8_t bits; /* 0..32, 0..128 */
};

/* Reads an address. A text without a port has the given one. Returns 0, or -1 with the reason in
 * error. */
int internet_address_read(struct internet_address *address, const char *text, uint16_t port,
                          struct error_text *error);

/* Reads an address without a port (a range of one), or an address with the number of bits that
 * count, such as 10.1.0.0/16. Returns 0, or -1 with the reason in error. */
int internet_address_range_read(struct internet_address_range *range, const char *text,
                                struct error_text *error);

/* Returns true if the range holds the address. An address of IPv4 inside one of IPv6
 * (::ffff:10.0.0.1), as sockets of both kinds show it, counts as that of IPv4. */
bool internet_address_in(const struct internet_address *address,
                         const struct internet_address_range *range);

#endif
