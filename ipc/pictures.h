/* Where a renderer gives pictures to who asks (docs/pictures.md): a unix socket in the runtime
 * folder (ipc/local_socket.h), which needs no port and which no other user reaches. */
#ifndef JOLON_IPC_PICTURES_H
#define JOLON_IPC_PICTURES_H

#include "ipc/local_socket.h"
#include "ipc/role.h"

/* The suffix of a renderer's socket: "pictures", that of renderer-2 "pictures-2". */
void pictures_suffix(char suffix[LOCAL_SOCKET_SUFFIX_MAX], enum role role);

#endif
