/* Where a renderer gives pictures to who asks (docs/pictures.md): a unix socket in the runtime
 * folder (ipc/segment/local_socket.h), which needs no port and which no other user reaches. */
#ifndef JOLON_IPC_SEGMENT_PICTURE_SOCKET_H
#define JOLON_IPC_SEGMENT_PICTURE_SOCKET_H

#include "ipc/segment/local_socket.h"
#include "ipc/segment/role.h"

/* The suffix of a renderer's socket: "pictures", that of renderer-2 "pictures-2". */
void picture_socket_suffix(char suffix[LOCAL_SOCKET_SUFFIX_MAX], enum role role);

#endif
