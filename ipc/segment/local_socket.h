/* Unix sockets in the runtime folder (ipc/segment/runtime_folder.h). The socket WORLD.SUFFIX
 * belongs to a role of that world. Only processes of the same user reach it, because nobody else
 * can enter the folder; both sides ask the kernel for the user of the other side all the same. */
#ifndef JOLON_IPC_SEGMENT_LOCAL_SOCKET_H
#define JOLON_IPC_SEGMENT_LOCAL_SOCKET_H

#include <stdbool.h>
#include <sys/types.h>

struct error_text;
struct ucred;

#define LOCAL_SOCKET_SUFFIX_MAX 16 /* with the NUL */

/* Listens on WORLD.SUFFIX and takes the place of a socket that a dead process left there: the
 * caller holds the role that the socket belongs to, so that no live process listens on it. type is
 * SOCK_STREAM or SOCK_SEQPACKET, with SOCK_NONBLOCK if wanted; the descriptor is always closed on
 * exec. The socket file stays when the process ends, and goes with the world. To be called before a
 * sandbox is entered. -1 with the reason. */
int local_socket_listen(const char *world, const char *suffix, int type, int backlog,
                        struct error_text *error);

/* Connects to it. -1 with errno and the reason: ENOENT or ECONNREFUSED when nobody listens, EACCES
 * when a process of another user does, EAGAIN when the backlog is full and type has SOCK_NONBLOCK.
 * Without SOCK_NONBLOCK a full backlog blocks. */
int local_socket_connect(const char *world, const char *suffix, int type, struct error_text *error);

/* Asks the kernel for the user and the process of the other side, as they were when it connected;
 * false when it cannot tell. */
bool local_socket_peer(int fd, struct ucred *peer);

/* Is the other side of a connected unix socket a process of this user? False when the kernel cannot
 * tell. Asks for nothing but getsockopt(SO_PEERCRED). */
bool local_socket_peer_is(int fd, uid_t user);

#endif
