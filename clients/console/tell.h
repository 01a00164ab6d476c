/* The answers that are read from the world: JSON as docs/console.md describes it. Each checks what
 * is asked, is bounded, and says what it left out. Under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_TELL_H
#define JOLON_CLIENTS_CONSOLE_TELL_H

#include "clients/console/http_answer.h"
#include "clients/console/command_queue.h"
#include "clients/console/players.h"
#include "clients/console/world_reader.h"

#define TELL_ENTITIES     2000u /* by default, and at most */
#define TELL_ENTITIES_MAX 20000u
#define TELL_NAMES_MAX    5000u
#define TELL_EVENTS       100u
#define TELL_EVENTS_MAX   500u
#define TELL_ROWS         50u
#define TELL_ROWS_MAX     500u
#define TELL_FROM_MAX     10000u

/* Who asks of what. */
struct tell {
    struct world_reader *watch;
    const struct players *players;
    const struct command_queue *desk;
    const struct player *player; /* NULL: a spectator */
    struct query query;
    uint64_t now_ns;
};

/* There is a world that can be read; else false, with the answer. The second copies it too. */
bool tell_there(const struct tell *tell, struct http_answer *answer);
bool tell_copied(const struct tell *tell, struct http_answer *answer);

void world_json(const struct tell *tell, struct http_answer *answer);
void state_json(const struct tell *tell, struct http_answer *answer);
void vehicles_json(const struct tell *tell, struct http_answer *answer);
void events_json(const struct tell *tell, struct http_answer *answer);
void tell_processes(const struct tell *tell, struct http_answer *answer);

/* Who drives a row: 0 nobody, 1 somebody, 2 the player. */
uint32_t tell_driver(const struct tell *tell, uint32_t row);

#endif
