/* The gate: who may ask, and how often. Under the console's lock, in the server's thread. */
#ifndef JOLON_CONSOLE_GATE_H
#define JOLON_CONSOLE_GATE_H

#include "console/request.h"

/* The player whose key the request has, who is heard of with that; NULL: none. */
struct player *gate_player(struct request *request, uint64_t now_ns);

/* May anything be asked for: not by another site's page, not too often?
 * False with the answer. */
bool gate_open(struct request *request, const struct player *player, uint64_t now_ns,
               struct answer *answer);

/* The same to change something: also a body of JSON that is not too long, the token, and its own
 * rate. */
bool gate_open_to_change(struct request *request, struct player *player, uint64_t now_ns,
                         struct answer *answer);

#endif
