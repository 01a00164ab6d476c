/* Replays a command log (docs/replay.md): reads it into memory, checks it, and applies it to a
 * world frame by frame. */
#ifndef JOLON_RECORDER_REPLAY_LOG_REPLAY_H
#define JOLON_RECORDER_REPLAY_LOG_REPLAY_H

#include "ipc/segment/segment.h"
#include "recorder/log/command_record.h"
#include "recorder/replay/frame_stepper.h"

#include <stdbool.h>
#include <stdint.h>

struct log_replay {
    const char *path; /* the caller's */
    char *text;       /* the file */
    cJSON *begin;     /* its first record */
    struct record_position start;
    uint64_t layout, scenario_hash, static_hash, origin;
    struct command_record *record; /* [count] the records after the first */
    uint32_t count;
    uint32_t next;        /* index of the record to apply next */
    uint64_t known_frame; /* the log holds every command up to this frame, inclusive */
    bool torn, gap; /* torn: its last line is incomplete, as after a kill; gap: commands are lost */
};

/* Reads the whole file. Checks each record's checksum and that its numbers continue those of the
 * record before. Returns 0, or -1 with the reason, which names the line. */
int log_replay_open(struct log_replay *replay, const char *path, struct error_text *error);
void log_replay_close(struct log_replay *replay);

/* Returns true if the file begins like a command log. */
bool log_replay_is_command_log(const char *path);

/* Returns the record that ends the log, or NULL if the recorder was killed. */
const struct command_record *log_replay_end(const struct log_replay *replay);

/* Returns the number of commands of the run up to the end of this frame, from the log's last record
 * up to then. */
uint64_t log_replay_commands(const struct log_replay *replay, uint64_t frame);

/* Returns the value of the first text of the provenance with this key, or NULL. */
const char *log_replay_provenance(const struct log_replay *replay, const char *key);

enum log_replay_step {
    LOG_REPLAY_STEPPED,
    LOG_REPLAY_OVER, /* the run cannot go on: it was quit, or reached its last frame, or is paused
                        and the log has no command for the next frame */
    LOG_REPLAY_MISMATCH, /* the log does not fit the world; the reason says where */
};

/* Computes the next frame of the stepper's world with the log's commands of that frame, and
 * compares it with the log's marks. The world must be the one that the log begins with, stepped
 * only by this function. The first call empties its command rings. */
enum log_replay_step log_replay_step(struct log_replay *replay, struct frame_stepper *stepper,
                                     struct error_text *error);

#endif
