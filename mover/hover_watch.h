/* The rows that rest in the air: helicopters that hover by their order to stand, alone, so that
 * they have nothing to decide until an aircraft comes near them or something happens to them.
 *
 * This is a part of the cache of rows that rest (resting_rows.h). Agents keep aircraft apart. A
 * helicopter that has an aircraft in the reach of this rule is not alone, and decides in its turns.
 * An aircraft that comes into the reach does not rest. So before rows move each aircraft that does
 * not rest wakes those that hover around it. Some rows are woken without need, none is missed. */
#ifndef JOLON_MOVER_HOVER_WATCH_H
#define JOLON_MOVER_HOVER_WATCH_H

#include "mover/context/step_context.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define HOVER_WATCH_SIDE 128u /* squares along an edge of the map, of 391 m in 50 km */

struct hover_watch {
    uint64_t *hovers; /* [capacity / 64] of the rows that rest, those that hover */
    double side_m;    /* of the world */
    double reach_m;   /* those that hover are woken by an aircraft that is so near */
    uint32_t frames;  /* since the squares were found */
    /* A bit for each square in which a row hovers, or has hovered since. */
    _Atomic uint64_t squares[HOVER_WATCH_SIDE * HOVER_WATCH_SIDE / 64];
};

/* words: of 64 rows; side_m: of the world. Returns 0, or -1 with errno ENOMEM; must be freed in
 * either case. */
int hover_watch_init(struct hover_watch *watch, uint32_t words, double side_m);
void hover_watch_free(struct hover_watch *watch);

/* Wakes the rows that hover near an aircraft that does not rest or that cruises: clears their bits
 * in resting. The index of neighbours is that of this frame. */
void hover_watch_wake(struct hover_watch *watch, uint64_t *resting, const uint64_t *cruising,
                      const struct step_context *context);

/* Returns true if no aircraft is so near to row i, which hovers, that it is kept from it. */
bool hover_watch_alone(const struct step_context *context, uint32_t i);

/* Notes how row i rests. Any thread; the rows of a word by one thread. */
void hover_watch_note(struct hover_watch *watch, const struct step_context *context, uint32_t i,
                      bool hovers);

/* Returns true if the row hovered when it last came to rest. */
static inline bool hover_watch_hovers(const struct hover_watch *watch, uint32_t i)
{
    return watch->hovers[i / 64] >> i % 64 & 1;
}

#endif
