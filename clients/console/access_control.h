/* The gate: who may ask, and how often. Under the console's lock, in the server's thread. */
#ifndef JOLON_CLIENTS_CONSOLE_ACCESS_CONTROL_H
#define JOLON_CLIENTS_CONSOLE_ACCESS_CONTROL_H

#include "clients/console/request.h"

/* The player whose key the request has, who is heard of with that; NULL: none. */
struct player *access_control_player(struct request *request, uint64_t now_ns);

/* May anything be asked for: not by another site's page, not too often?
 * False with the answer. */
bool access_control_open(struct request *request, const struct player *player, uint64_t now_ns,
                         struct http_answer *answer);

/* The same to change something: also a body of JSON that is not too long, the token, and its own
 * rate. */
bool access_control_open_to_change(struct request *request, struct player *player, uint64_t now_ns,
                                   struct http_answer *answer);

#endif
