/* Names by which a server on this machine alone is asked for in good faith. A page elsewhere can
 * have its own name lead to 127.0.0.1 (DNS rebinding); the Host that its requests carry tells. */
#ifndef JOLON_IPC_HTTP_HOST_CHECK_H
#define JOLON_IPC_HTTP_HOST_CHECK_H

#include <stdbool.h>
#include <stdint.h>

/* Is host, as the header has it, a name of this machine, with any port or none? */
bool http_host_local(const char *host);

/* Is host a numeric address, with any port or none? Nobody else's page has one for a name. */
bool http_host_numeric(const char *host);

/* Is origin, as the header has it, "http://" and then host to the letter? */
bool http_origin_is(const char *origin, const char *host);

#endif
