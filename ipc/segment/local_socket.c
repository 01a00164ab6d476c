/* Unix sockets. They are addressed through the runtime folder's descriptor, because
 * "/proc/self/fd/N/NAME" is short and a socket's address has room for 107 bytes only. */
#include "ipc/segment/local_socket.h"

#include "ipc/segment/runtime_folder.h"
#include "ipc/segment/segment.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

struct location {
    int folder;
    char name[SEGMENT_NAME_MAX + LOCAL_SOCKET_SUFFIX_MAX];
    struct sockaddr_un address;
};

static int find_location(struct location *location, const char *world, const char *suffix,
                         struct error_text *error)
{
    CHECK(segment_name_ok(world) && strlen(suffix) < LOCAL_SOCKET_SUFFIX_MAX);
    location->folder = runtime_folder_open(error);
    if (location->folder < 0)
        return -1;
    snprintf(location->name, sizeof location->name, "%s.%s", world, suffix);
    location->address = (struct sockaddr_un){.sun_family = AF_UNIX};
    snprintf(location->address.sun_path, sizeof location->address.sun_path, "/proc/self/fd/%d/%s",
             location->folder, location->name);
    return 0;
}

/* Closes the descriptors and writes what failed, and why, into error. Keeps errno. */
static int failed(const struct location *location, int fd, const char *what,
                  struct error_text *error)
{
    int cause = errno;
    char folder[RUNTIME_FOLDER_MAX];
    if (fd >= 0)
        close(fd);
    close(location->folder);
    if (runtime_folder(folder, error) == 0)
        error_text_set(error, "%s/%s: cannot %s: %s", folder, location->name, what,
                       strerror(cause));
    errno = cause;
    return -1;
}

int local_socket_listen(const char *world, const char *suffix, int type, int backlog,
                        struct error_text *error)
{
    struct location location;
    if (find_location(&location, world, suffix, error) != 0)
        return -1;
    if (unlinkat(location.folder, location.name, 0) != 0 && errno != ENOENT)
        return failed(&location, -1, "remove the socket of a dead process", error);
    int fd = socket(AF_UNIX, type | SOCK_CLOEXEC, 0);
    /* The mode of a socket before bind() is the mode of its file, less the umask. */
    if (fd < 0 || fchmod(fd, 0600) != 0 ||
        bind(fd, (const struct sockaddr *)&location.address, sizeof location.address) != 0 ||
        listen(fd, backlog) != 0)
        return failed(&location, fd, "listen", error);
    close(location.folder);
    return fd;
}

int local_socket_connect(const char *world, const char *suffix, int type, struct error_text *error)
{
    struct location location;
    if (find_location(&location, world, suffix, error) != 0) {
        errno = EACCES;
        return -1;
    }
    int fd = socket(AF_UNIX, type | SOCK_CLOEXEC, 0);
    if (fd < 0 ||
        connect(fd, (const struct sockaddr *)&location.address, sizeof location.address) != 0)
        return failed(&location, fd, "connect", error);
    if (!local_socket_peer_is(fd, geteuid())) {
        errno = EACCES;
        return failed(&location, fd, "connect to a process of another user", error);
    }
    close(location.folder);
    return fd;
}

bool local_socket_peer(int fd, struct ucred *peer)
{
    socklen_t bytes = sizeof *peer;
    return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, peer, &bytes) == 0 && bytes == sizeof *peer;
}

bool local_socket_peer_is(int fd, uid_t user)
{
    struct ucred peer;
    return local_socket_peer(fd, &peer) && peer.uid == user;
}
