/* Opens the socket of the verbs that receive, and reads --interface. One thread. */
#ifndef JOLON_GATEWAY_TOOL_LISTENER_H
#define JOLON_GATEWAY_TOOL_LISTENER_H

struct udp_address;

/* Returns a socket that receives what comes to the value of --listen, which is also written to *at.
 * interface: the value of --interface, or NULL. Ends the program with a message if that cannot be.
 */
int listener_open(const char *listen, const char *interface, struct udp_address *at);

/* Returns the number of the interface that is the value of --interface (udp_interface.h), 0 for
 * NULL. Ends the program with a message if there is none. */
unsigned listener_interface(const char *interface);

#endif
