/* A request to the renderer over its Unix socket, with a time limit. */
#ifndef JOLON_CLIENTS_CONSOLE_RENDERER_CLIENT_H
#define JOLON_CLIENTS_CONSOLE_RENDERER_CLIENT_H

#include "clients/console/picture_proxy.h"

/* Sends GET target to the world's first renderer. after: number of the picture that must be
 * exceeded, 0: none. Returns a copy with one holder, whose status is 0 if the renderer is absent,
 * belongs to another user, or does not answer in time with HTTP; NULL: no memory. Blocks at most
 * until until_ns (CLOCK_MONOTONIC). */
struct picture_copy *renderer_client(const char *world, const char *target, uint64_t after,
                                     uint64_t until_ns);

/* Finds the parts of the answer in bytes[count]. Returns false if it is malformed. Pure. */
bool renderer_client_read(struct picture_copy *copy);

#endif
