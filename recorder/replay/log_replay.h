/* The replay of a log: a log of commands (docs/replay.md) in memory, checked, and played onto a
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
    struct record_place start;
    uint64_t layout, scenario_hash, static_hash, origin;
    struct command_record *record; /* after the first */
    uint32_t count;
    uint32_t next;        /* the record to play next */
    uint64_t known_frame; /* the log knows every command until then, this frame included */
    bool torn, gap;       /* its last line is not whole: a kill's; it stops at a gap */
};

/* Reads the whole file and checks every record: its checksum, that its numbers go on from those
 * before. 0, or -1 with the reason, which names the line. */
int log_replay_open(struct log_replay *replay, const char *path, struct error_text *error);
void log_replay_close(struct log_replay *replay);

/* Does the file begin like a log of commands? */
bool log_replay_is_one(const char *path);

/* The record that ends the log; NULL when the recorder was killed. */
const struct command_record *log_replay_end(const struct log_replay *replay);

/* Commands of the run until the end of this frame, as far as the log knows. */
uint64_t log_replay_commands(const struct log_replay *replay, uint64_t frame);

/* The value of the recipe's first text with this key, NULL when there is none. */
const char *log_replay_provenance(const struct log_replay *replay, const char *key);

enum log_replay_step {
    LOG_REPLAY_STEPPED,
    LOG_REPLAY_OVER,  /* the run cannot go on: it was quit, its last frame is made, or it is paused
                   and  the log has no command for the next frame */
    LOG_REPLAY_WRONG, /* it does not fit the world; the reason says where */
};

/* Makes the next frame of the stepper's world with the log's commands of that frame, and holds it
 * against the log's marks. The world is the one that the log begins with, or was stepped so far
 * with it; before the first step its rings are emptied. */
enum log_replay_step log_replay_step(struct log_replay *replay, struct frame_stepper *stepper,
                                     struct error_text *error);

#endif
