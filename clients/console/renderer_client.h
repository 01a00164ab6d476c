/* One question to the renderer, over its Unix socket, with an end in time. */
#ifndef JOLON_CLIENTS_CONSOLE_RENDERER_CLIENT_H
#define JOLON_CLIENTS_CONSOLE_RENDERER_CLIENT_H

#include "clients/console/picture_proxy.h"

/* GET target of the world's first renderer; after: a picture's number, 0: none. A copy with one
 * holder, whose status is 0 when the renderer is away, is not ours, or answers too late or with
 * what is no HTTP; NULL: no memory. Blocks until until_ns (CLOCK_MONOTONIC) at most. */
struct picture_copy *renderer_client(const char *world, const char *target, uint64_t after,
                                     uint64_t until_ns);

/* Finds the parts of a whole answer, bytes[count], and says whether it is one. Pure. */
bool renderer_client_read(struct picture_copy *copy);

#endif
