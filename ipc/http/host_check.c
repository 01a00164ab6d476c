/* Checks of the headers Host and Origin. */
#include "ipc/http/host_check.h"

#include <string.h>
#include <strings.h>

bool http_host_local(const char *host)
{
    static const char *const names[] = {"localhost", "127.0.0.1", "[::1]"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        size_t length = strlen(names[i]);
        if (strncasecmp(host, names[i], length) == 0 &&
            (host[length] == '\0' || host[length] == ':'))
            return true;
    }
    return strncmp(host, "127.", 4) == 0 && host[strspn(host, "0123456789.:")] == '\0';
}

bool http_host_numeric(const char *host)
{
    if (host[0] != '[')
        return host[0] != '\0' && host[strspn(host, "0123456789.:")] == '\0';
    size_t length = 1 + strspn(host + 1, "0123456789abcdefABCDEF:.");
    return host[length] == ']' &&
           host[length + 1 + strspn(host + length + 1, "0123456789:")] == '\0';
}

bool http_origin_is(const char *origin, const char *host)
{
    static const char scheme[] = "http://";
    size_t length = sizeof scheme - 1;
    return strncmp(origin, scheme, length) == 0 && strcasecmp(origin + length, host) == 0;
}
