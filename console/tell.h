/* The answers that are read from the world: JSON as docs/console.md describes it. Each checks what
 * is asked, is bounded, and says what it left out. Under the console's lock. */
#ifndef JOLON_CONSOLE_TELL_H
#define JOLON_CONSOLE_TELL_H

#include "console/answer.h"
#include "console/desk.h"
#include "console/players.h"
#include "console/watch.h"

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
    struct watch *watch;
    const struct players *players;
    const struct desk *desk;
    const struct player *player; /* NULL: a spectator */
    struct query query;
    uint64_t now_ns;
};

/* There is a world that can be read; else false, with the answer. The second copies it too. */
bool tell_there(const struct tell *tell, struct answer *answer);
bool tell_copied(const struct tell *tell, struct answer *answer);

void tell_world(const struct tell *tell, struct answer *answer);
void tell_state(const struct tell *tell, struct answer *answer);
void tell_list(const struct tell *tell, struct answer *answer);
void tell_events(const struct tell *tell, struct answer *answer);
void tell_processes(const struct tell *tell, struct answer *answer);

/* Who drives a row: 0 nobody, 1 somebody, 2 the player. */
uint32_t tell_driver(const struct tell *tell, uint32_t row);

#endif
