/* Unix sockets in the runtime folder (ipc/segment/runtime_folder.h). The socket WORLD.SUFFIX
 * belongs to a role of that world. No other user can enter the folder. Even so, both sides ask the
 * kernel for the user of the other side. */
#ifndef JOLON_IPC_SEGMENT_LOCAL_SOCKET_H
#define JOLON_IPC_SEGMENT_LOCAL_SOCKET_H

#include <stdbool.h>
#include <sys/types.h>

struct error_text;
struct ucred;

#define LOCAL_SOCKET_SUFFIX_MAX 16 /* with the NUL */

/* Listens on WORLD.SUFFIX and replaces a socket that a dead process left there. The caller holds
 * the role that the socket belongs to, so no live process listens on it. type is SOCK_STREAM or
 * SOCK_SEQPACKET, and SOCK_NONBLOCK if wanted. The descriptor is always closed on exec. The socket
 * file stays when the process ends, and is removed with the world. To be called before a sandbox is
 * entered. Returns the descriptor, or -1 with the reason. */
int local_socket_listen(const char *world, const char *suffix, int type, int backlog,
                        struct error_text *error);

/* Connects to WORLD.SUFFIX. Returns the descriptor, or -1 with errno and the reason: ENOENT or
 * ECONNREFUSED when no process listens, EACCES when a process of another user does, EAGAIN when the
 * backlog is full and type has SOCK_NONBLOCK. Without SOCK_NONBLOCK a full backlog blocks. */
int local_socket_connect(const char *world, const char *suffix, int type, struct error_text *error);

/* Reads the user and the process of the other side, as they were when it connected. Returns false
 * when the kernel cannot tell. */
bool local_socket_peer(int fd, struct ucred *peer);

/* Returns true if the other side of a connected Unix socket is a process of this user, false also
 * when the kernel cannot tell. Calls getsockopt(SO_PEERCRED) only. */
bool local_socket_peer_is(int fd, uid_t user);

#endif
