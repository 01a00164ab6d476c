/* Requests that change something: joining, orders, ending processes. Under the console's lock, in
 * the server's thread. */
#ifndef JOLON_CONSOLE_CHANGE_H
#define JOLON_CONSOLE_CHANGE_H

#include "console/request.h"

/* Is there something to change at the path? */
bool change_find(const char *path);

/* Checks the request and does it. True with the answer; false: the answer comes with the request's
 * ticket, until which its connection is to be suspended. */
bool change_world(struct request *request, const char *path, struct answer *answer);

#endif
