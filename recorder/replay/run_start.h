/* The start of a recorded run: makes the world that a command log begins with, in this process's
 * own memory. */
#ifndef JOLON_RECORDER_REPLAY_RUN_START_H
#define JOLON_RECORDER_REPLAY_RUN_START_H

#include "recorder/replay/log_replay.h"

/* Makes the world from its scenario, or from the image that it continued. segment_abandon() frees
 * it. Ends the process (exit 1) if something differs from the recorded world, and says what: the
 * build, the scenario or its files, the image, or a byte of the static regions. */
void run_start_make(struct view *view, const struct log_replay *replay);

/* Calls log_replay_open(), or ends the process (exit 1) with the reason. Warns about a torn end. */
void run_start_open(struct log_replay *replay, const char *path);

#endif
