/* Captures: what an image holds that changes, copied out of a running world by a reader. */
#ifndef JOLON_RECORDER_ARCHIVE_CAPTURE_H
#define JOLON_RECORDER_ARCHIVE_CAPTURE_H

#include "ipc/frame/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

struct capture {
    struct snapshot snapshot;
    struct {
        uint64_t first, end;  /* commands that slot has */
        struct command *slot; /* [command_slots] */
    } ring[COMMAND_RING_COUNT];
    bool inputs; /* moved is that of the frame after the snapshot's */
    struct state_head moved_head;
    struct moved moved;
    void *memory;
};

/* Space for the view's capacities; to be used again and again. 0, or -1 with errno ENOMEM. */
int capture_init(struct capture *capture, const struct view *view);
void capture_free(struct capture *capture);

/* Copies the last committed frame and the commands that were there with it, those taken already
 * too as far as the rings remember them; with inputs also the moved table, if the next frame has
 * been moved. What a sender put into a ring meanwhile is left out, as what comes later is. Does not
 * block. 0; -1 with the errno of snapshot_take(), EAGAIN also when commands to be taken were
 * overwritten or the moved table changed, 100 times in a row. */
int capture_take(struct capture *capture, const struct view *view, bool inputs);

#endif
