/* Requests that change something: joining, orders, ending processes. Under the console's lock, in
 * the server's thread. */
#ifndef JOLON_CLIENTS_CONSOLE_POST_REQUESTS_H
#define JOLON_CLIENTS_CONSOLE_POST_REQUESTS_H

#include "clients/console/request.h"

/* Is there something to change at the path? */
bool post_requests_find(const char *path);

/* Checks the request and does it. True with the answer; false: the answer comes with the request's
 * ticket, until which its connection is to be suspended. */
bool post_requests_handle(struct request *request, const char *path, struct http_answer *answer);

#endif
