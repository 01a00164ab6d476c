/* A capture: a reader's copy of the changing part of a running world, from which an image is
 * written. */
#ifndef JOLON_RECORDER_ARCHIVE_CAPTURE_H
#define JOLON_RECORDER_ARCHIVE_CAPTURE_H

#include "ipc/frame/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

struct capture {
    struct snapshot snapshot;
    struct {
        uint64_t first, end;  /* slot holds the commands first .. end - 1 */
        struct command *slot; /* [layout_ring_slots()] */
    } ring[COMMAND_RING_COUNT];
    bool inputs; /* moved belongs to the frame after the snapshot's */
    struct state_head moved_head;
    struct moved moved;
    void *memory;
};

/* Allocates memory for the view's capacities. A capture can be taken any number of times. Returns
 * 0, or -1 with errno ENOMEM. */
int capture_init(struct capture *capture, const struct view *view);
void capture_free(struct capture *capture);

/* Copies the last committed frame and the commands in the rings, including those that the mover has
 * taken and that are not overwritten yet. With inputs, the moved table is copied too if the next
 * frame has been moved. Commands that arrive during the copy are left out. Does not block. Returns
 * 0, or -1 with the errno of snapshot_take(). EAGAIN also says that 100 times in a row untaken
 * commands were overwritten or the moved table changed. */
int capture_take(struct capture *capture, const struct view *view, bool inputs);

#endif
