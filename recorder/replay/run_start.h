/* Remaking: the world that a log of commands begins with, in this process's own memory. */
#ifndef JOLON_RECORDER_REPLAY_RUN_START_H
#define JOLON_RECORDER_REPLAY_RUN_START_H

#include "recorder/replay/log_replay.h"

/* From the scenario, or from the image that the world went on from. segment_abandon frees it. Ends
 * the process (exit 1) with what differs from then: the build, the scenario or what it is made of,
 * the image, or any byte of what never changes. */
void run_start_world(struct view *view, const struct log_replay *replay);

/* log_replay_open(), or ends the process (exit 1) with the reason. A torn end is said. */
void run_start_open(struct log_replay *replay, const char *path);

#endif
