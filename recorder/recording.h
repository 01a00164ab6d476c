/* What the recorder keeps of a run: the log of commands, that of events, checkpoints. */
#ifndef JOLON_RECORDER_RECORDING_H
#define JOLON_RECORDER_RECORDING_H

#include "ipc/process/log.h"
#include "recorder/back_pressure.h"
#include "recorder/checkpoint.h"
#include "recorder/log/command_log.h"
#include "recorder/log/event_log.h"
#include "recorder/options.h"

struct recorder {
    struct options options;
    struct view view;
    struct command_log commands;
    struct event_log events;
    struct checkpoint checkpoint;
    struct back_pressure pressure;
};

/* Opens what the options ask for, in the view that is attached; what cannot be opened ends the
 * process with the reason. */
void recording_open(struct recorder *recorder);

/* One look at everything that is new at this frame. Writes; true when there is more to do at once.
 */
bool recording_turn(struct recorder *recorder, uint64_t frame);

/* Writes the ends. What could not be written is said, and is an error. */
enum exit_code recording_close(struct recorder *recorder);

#endif
