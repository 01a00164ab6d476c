/* Back-pressure, for recorder.when_full = "pause": pauses the world before the event ring
 * overwrites an event that is not written yet, and resumes it when every event is written. Both are
 * commands, sent by the recorder's own ring, so that a replay contains them. */
#ifndef JOLON_RECORDER_BACK_PRESSURE_H
#define JOLON_RECORDER_BACK_PRESSURE_H

#include "ipc/frame/event_cursor.h"

#include <stdbool.h>
#include <stdint.h>

#define BACK_PRESSURE_SOURCE 0x7265636f72646572u /* "recorder" */

struct back_pressure {
    bool on;                    /* the scenario has when_full = "pause" */
    struct event_cursor cursor; /* finds the commands that pause and resume */
    uint32_t holder;            /* ring that holds the world paused; COMMAND_RING_COUNT: none */
};

/* Reads the ring to find which ring holds the world paused. An earlier recorder may have paused
 * it. */
void back_pressure_open(struct back_pressure *pressure, const struct view *view);

/* Pauses or resumes the world if that is due. written: the oldest event that is missing from a log.
 * Does not block. A pause that another ring has requested is not ended. */
void back_pressure_update(struct back_pressure *pressure, struct view *view, uint64_t written);

/* Returns true if the recorder holds the world paused. */
bool back_pressure_holds(const struct back_pressure *pressure);

#endif
