/* A request that is answered from the world: the query and what it is read from. Each answer checks
 * the query, has a bounded length and says what it left out (docs/console.md). Functions that take
 * a struct world_query are called under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_WORLD_QUERY_H
#define JOLON_CLIENTS_CONSOLE_WORLD_QUERY_H

#include "clients/console/command_queue.h"
#include "clients/console/http_answer.h"
#include "clients/console/players.h"
#include "clients/console/world_reader.h"

struct world_query {
    struct world_reader *reader;
    const struct players *players;
    const struct command_queue *queue;
    const struct player *player; /* NULL: a spectator */
    struct query arguments;
    uint64_t now_ns;
};

/* Returns true if a world is attached; otherwise false, and answer says why there is none. */
bool world_query_attached(const struct world_query *asked, struct http_answer *answer);

/* Also brings the reader's snapshot up to date. Returns false, with the answer, if there is no
 * whole frame to read. */
bool world_query_copied(const struct world_query *asked, struct http_answer *answer);

/* Also brings its motions up to date. */
bool world_query_told(const struct world_query *asked, struct http_answer *answer);

/* Returns the driver of a row's vehicle: 0 no client, 1 another client, 2 the requesting player. */
uint32_t world_query_driver(const struct world_query *asked, uint32_t row);

#endif
