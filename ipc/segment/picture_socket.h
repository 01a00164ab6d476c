/* The socket on which a renderer serves pictures (docs/pictures.md): a Unix socket in the runtime
 * folder (ipc/segment/local_socket.h), which needs no port and which no other user can reach. */
#ifndef JOLON_IPC_SEGMENT_PICTURE_SOCKET_H
#define JOLON_IPC_SEGMENT_PICTURE_SOCKET_H

#include "ipc/segment/local_socket.h"
#include "ipc/segment/role.h"

/* Writes the suffix of a renderer's socket: "pictures" for renderer, "pictures-2" for
 * renderer-2. */
void picture_socket_suffix(char suffix[LOCAL_SOCKET_SUFFIX_MAX], enum role role);

#endif
