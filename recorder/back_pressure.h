/* Back-pressure: recorder.when_full = "pause". Pauses the world before the event ring overwrites
 * what is not written yet, and lets it go on when all is. Both are commands, by a ring of the
 * recorder's own, so that a replay has them too. */
#ifndef JOLON_RECORDER_BACK_PRESSURE_H
#define JOLON_RECORDER_BACK_PRESSURE_H

#include "ipc/frame/event_cursor.h"

#include <stdbool.h>
#include <stdint.h>

#define BACK_PRESSURE_SOURCE 0x7265636f72646572u /* "recorder" */

struct back_pressure {
    bool on;                    /* the scenario asks for it */
    struct event_cursor cursor; /* to see who pauses and resumes */
    uint32_t holder;            /* ring that holds the world paused; COMMAND_RING_COUNT: none */
};

/* Looks through the ring for who holds the world: a recorder before this one may have. */
void back_pressure_open(struct back_pressure *pressure, const struct view *view);

/* written: the oldest event that is not safe in every log. Never blocks. A pause that somebody else
 * wants too is not ended here. */
void back_pressure_turn(struct back_pressure *pressure, struct view *view, uint64_t written);

/* Does the recorder hold the world paused? */
bool back_pressure_holds(const struct back_pressure *pressure);

#endif
