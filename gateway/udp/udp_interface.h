/* Interfaces of this machine, by which multicast leaves and is joined. Not inside a sandbox. */
#ifndef JOLON_GATEWAY_UDP_UDP_INTERFACE_H
#define JOLON_GATEWAY_UDP_UDP_INTERFACE_H

#include "world/runtime/error_text.h"

#define UDP_INTERFACE_ANY "any" /* the system's choice */

/* Finds an interface by its name, such as "eth0", or by an address that it has. Writes its number,
 * or 0 for UDP_INTERFACE_ANY. Returns 0, or -1 with the reason, which has no name of a key. */
int udp_interface_find(unsigned *number, const char *text, struct error_text *error);

#endif
