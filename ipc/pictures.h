/* Where a renderer gives pictures to who asks (docs/pictures.md): an abstract Unix socket, which is
 * nothing on disk, needs no port, and is gone with the renderer. */
#ifndef JOLON_IPC_PICTURES_H
#define JOLON_IPC_PICTURES_H

#include "ipc/role.h"

#include <stdbool.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/un.h>

/* The address of this user's renderer of a world: "\0jolon.UID.WORLD.pictures", that of renderer-2
 * "...pictures-2". Returns its length for bind() and connect(). */
socklen_t pictures_address(struct sockaddr_un *address, const char *world, enum role role);

/* Is the other side of a connected Unix socket a process of this user (geteuid())? Any user may
 * bind and connect to an abstract name, so both sides ask. A kernel that cannot tell makes it
 * false. */
bool pictures_peer_is(int fd, uid_t user);

#endif
