/* Names of the renderers' sockets. */
#include "ipc/segment/picture_socket.h"

#include <stdio.h>

void picture_socket_suffix(char suffix[LOCAL_SOCKET_SUFFIX_MAX], enum role role)
{
    if (role > ROLE_RENDERER)
        snprintf(suffix, LOCAL_SOCKET_SUFFIX_MAX, "pictures-%u",
                 (unsigned)(role - ROLE_RENDERER) % ROLE_COUNT + 1);
    else
        snprintf(suffix, LOCAL_SOCKET_SUFFIX_MAX, "pictures");
}
