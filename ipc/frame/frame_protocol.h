/* The frame protocol (ipc/README.md has its rules). Each role's loop is
 *
 *     while (frame_..._begin(&frame, &view) == 0) { step; frame_..._end(&frame, &view); }
 *
 * begin blocks in bounded waits, and writes the slot's heartbeat after each. It returns -1 when the
 * process was asked to stop or the run's last frame is committed. A damaged world ends the process
 * with one line that names the damage (exit 1). */
#ifndef JOLON_IPC_FRAME_FRAME_PROTOCOL_H
#define JOLON_IPC_FRAME_FRAME_PROTOCOL_H

#include "ipc/segment/segment.h"

struct frame_protocol {
    uint64_t number;   /* the frame being made */
    uint64_t begun_ns; /* CLOCK_MONOTONIC at the start of the stage's work */
    uint64_t command_head[COMMAND_RING_COUNT]; /* mover: it takes the commands before these */
    bool in_time; /* mover: the previous frame was committed before this one was due */
};

int frame_protocol_mover_begin(struct frame_protocol *frame, struct view *view);
void frame_protocol_mover_end(struct frame_protocol *frame, struct view *view);

int frame_protocol_collider_begin(struct frame_protocol *frame, struct view *view);
void frame_protocol_collider_end(struct frame_protocol *frame, struct view *view);

/* For readers: waits for a frame later than seen, at most until until_ns (CLOCK_MONOTONIC). It
 * waits on the commit word itself (a futex, which works on a read-only mapping); renderers wait on
 * their doorbell. Returns the last committed frame. */
uint64_t frame_protocol_wait(const struct view *view, uint64_t seen, uint64_t until_ns);

/* Returns the end of the commands that frame number takes from a ring whose head is given. A frame
 * that segment_repair() has made again takes the commands that it took the first time and no
 * more. */
uint64_t frame_protocol_commands_end(const struct view *view, uint64_t number, int ring,
                                     uint64_t head);

/* Returns true if the run has ended: its last frame is committed, or a command has ended it. */
bool frame_protocol_finished(const struct view *view);

/* Writes the heartbeat of the view's role. */
void frame_protocol_beat(struct view *view);

/* Writes the work of the view's role on a frame into its slot. */
void frame_protocol_stage_done(struct view *view, uint64_t number, uint64_t stage_ns);

#endif
