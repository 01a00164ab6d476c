/* POST requests: joining, commands, ending processes. Called under the console's lock, in the
 * server's thread. */
#ifndef JOLON_CLIENTS_CONSOLE_POST_REQUESTS_H
#define JOLON_CLIENTS_CONSOLE_POST_REQUESTS_H

#include "clients/console/request.h"

/* Returns true if the path is one of a POST request. */
bool post_requests_find(const char *path);

/* Checks the request and executes it. Returns true with the answer; false if the answer comes with
 * the request's pending command, until which the connection is to be suspended. */
bool post_requests_handle(struct request *request, const char *path, struct http_answer *answer);

#endif
