/* Access control: which requests are allowed, and how many a second. The functions run in the
 * server's thread under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_ACCESS_CONTROL_H
#define JOLON_CLIENTS_CONSOLE_ACCESS_CONTROL_H

#include "clients/console/request.h"

/* The player whose key the request has, or NULL. Notes the time of the player's request. */
struct player *access_control_player(struct request *request, uint64_t now_ns);

/* Returns true if the request comes from the console's own page and within its rate; otherwise
 * false, with the answer. */
bool access_control_open(struct request *request, const struct player *player, uint64_t now_ns,
                         struct http_answer *answer);

/* The same for a request that changes something. Such a request must also have the token, a JSON
 * body of at most REQUEST_BODY bytes, and keep within a rate of its own. */
bool access_control_open_to_change(struct request *request, struct player *player, uint64_t now_ns,
                                   struct http_answer *answer);

#endif
