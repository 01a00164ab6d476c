/* Is what a frame left in the world's buffers whole? */
#ifndef JOLON_IPC_SEGMENT_FRAME_CHECK_H
#define JOLON_IPC_SEGMENT_FRAME_CHECK_H

#include "ipc/segment/segment.h"

#include <stdint.h>

/* Are a head's counts within the tables and lists that they count in? Is W[frame & 1] whole and
 * this frame? Is the moved table? The last two hash what there is (1 ms for about 20,000 entities).
 * 0, or -1 with what is wrong, by its field. */
int segment_check_head(const struct view *view, const struct state_head *head,
                       struct error_text *error);
int segment_check_state(const struct view *view, uint64_t frame, struct error_text *error);
int segment_check_moved(const struct view *view, uint64_t frame, struct error_text *error);

#endif
