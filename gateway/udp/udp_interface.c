/* Names and addresses of interfaces. */
#include "gateway/udp/udp_interface.h"

#include "gateway/udp/udp_address.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <stddef.h>
#include <string.h>

/* Returns the number of the interface that has an address, 0 when none has. */
static unsigned with_address(const struct udp_address *address)
{
    struct ifaddrs *list = NULL;
    unsigned number = 0;
    if (getifaddrs(&list) != 0)
        return 0;
    for (const struct ifaddrs *one = list; one && number == 0; one = one->ifa_next) {
        struct udp_address own = {0};
        if (!one->ifa_addr || one->ifa_addr->sa_family != address->any.sa_family)
            continue;
        memcpy(&own, one->ifa_addr,
               one->ifa_addr->sa_family == AF_INET6 ? sizeof own.v6 : sizeof own.v4);
        if (udp_address_same_host(&own, address))
            number = if_nametoindex(one->ifa_name);
    }
    freeifaddrs(list);
    return number;
}

int udp_interface_find(unsigned *number, const char *text, struct error_text *error)
{
    struct udp_address address;
    struct error_text reason;
    *number = 0;
    if (strcmp(text, UDP_INTERFACE_ANY) == 0)
        return 0;
    *number = if_nametoindex(text);
    if (*number == 0 && udp_address_parse(&address, text, 1, &reason) == 0)
        *number = with_address(&address);
    if (*number != 0)
        return 0;
    return error_text_set(error, "is no interface of this machine; right would be its name, such "
                                 "as eth0, or an address that it has (ip address lists them)");
}
