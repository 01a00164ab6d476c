/* What the recorder keeps of a run: the log of commands, that of events, checkpoints. */
#ifndef JOLON_RECORDER_RECORD_H
#define JOLON_RECORDER_RECORD_H

#include "ipc/log.h"
#include "recorder/brake.h"
#include "recorder/checkpoint.h"
#include "recorder/command_log.h"
#include "recorder/event_log.h"
#include "recorder/options.h"

struct recorder {
    struct options options;
    struct view view;
    struct command_log commands;
    struct event_log events;
    struct checkpoint checkpoint;
    struct brake brake;
};

/* Opens what the options ask for, in the view that is attached; what cannot be opened ends the
 * process with the reason. */
void record_open(struct recorder *recorder);

/* One look at everything that is new at this frame. Writes; true when there is more to do at once.
 */
bool record_turn(struct recorder *recorder, uint64_t frame);

/* Writes the ends. What could not be written is said, and is an error. */
enum exit_code record_close(struct recorder *recorder);

#endif
