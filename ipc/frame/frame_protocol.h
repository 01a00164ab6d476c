/* The frame protocol (ipc/README.md has its rules). Each role's loop is
 *
 *     while (frame_..._begin(&frame, &view) == 0) { step; frame_..._end(&frame, &view); }
 *
 * begin blocks, in bounded waits that beat the slot's heart; it returns -1 when the process was
 * asked to stop or the run's last frame is committed. A corrupt header ends the process with the
 * names of the fields (exit 1). */
#ifndef JOLON_IPC_FRAME_FRAME_PROTOCOL_H
#define JOLON_IPC_FRAME_FRAME_PROTOCOL_H

#include "ipc/segment/segment.h"

struct frame_protocol {
    uint64_t number;   /* the frame being made */
    uint64_t begun_ns; /* CLOCK_MONOTONIC at the start of the stage's work */
    uint64_t command_head[COMMAND_RING_COUNT]; /* mover: commands there are to take */
    bool in_time; /* mover: the frame before was committed when this one was still to come */
};

int frame_protocol_mover_begin(struct frame_protocol *frame, struct view *view);
void frame_protocol_mover_end(struct frame_protocol *frame, struct view *view);

int frame_protocol_collider_begin(struct frame_protocol *frame, struct view *view);
void frame_protocol_collider_end(struct frame_protocol *frame, struct view *view);

/* Readers: waits for a frame later than seen, at most until until_ns (CLOCK_MONOTONIC), on the
 * commit word itself (a futex; works on a read-only mapping). Returns the last committed frame. */
uint64_t frame_protocol_wait(const struct view *view, uint64_t seen, uint64_t until_ns);

/* Up to where frame number takes a ring's commands, of head that there are: a frame that a repair
 * has made again takes what it took the first time and no more (segment_repair()). */
uint64_t frame_protocol_commands_end(const struct view *view, uint64_t number, int ring,
                                     uint64_t head);

/* Has the run ended: its last frame committed, or quit by command? */
bool frame_protocol_finished(const struct view *view);

/* The holder of a role says that it lives. */
void frame_protocol_beat(struct view *view);

#endif
