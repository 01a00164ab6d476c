/* Names of renderers' sockets. */
#include "ipc/pictures.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

socklen_t pictures_address(struct sockaddr_un *address, const char *world, enum role role)
{
    *address = (struct sockaddr_un){.sun_family = AF_UNIX};
    char *name = address->sun_path + 1; /* a leading NUL makes it abstract */
    size_t room = sizeof address->sun_path - 1;
    int used = snprintf(name, room, "jolon.%u.%s.pictures", (unsigned)geteuid(), world);
    if (role > ROLE_RENDERER)
        used +=
            snprintf(name + used, room - (size_t)used, "-%u", (unsigned)(role - ROLE_RENDERER) + 1);
    return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)used);
}

bool pictures_peer_is(int fd, uid_t user)
{
    struct ucred peer;
    socklen_t bytes = sizeof peer;
    return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &bytes) == 0 && bytes == sizeof peer &&
           peer.uid == user;
}
