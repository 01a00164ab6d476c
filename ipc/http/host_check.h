/* Checks of the names by which a client asks a server. A page elsewhere can make its own name lead
 * to 127.0.0.1 (DNS rebinding); the Host header of its requests shows that. */
#ifndef JOLON_IPC_HTTP_HOST_CHECK_H
#define JOLON_IPC_HTTP_HOST_CHECK_H

#include <stdbool.h>
#include <stdint.h>

/* Returns true if the header's host is a name of this machine, with any port or none. */
bool http_host_local(const char *host);

/* Returns true if host is a numeric address, with any port or none. No other page can have such a
 * name. */
bool http_host_numeric(const char *host);

/* Returns true if the header's origin is exactly "http://" and host. */
bool http_origin_is(const char *origin, const char *host);

#endif
