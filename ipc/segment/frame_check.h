/* Checks of the frames in a world's buffers. */
#ifndef JOLON_IPC_SEGMENT_FRAME_CHECK_H
#define JOLON_IPC_SEGMENT_FRAME_CHECK_H

#include "ipc/segment/segment.h"

#include <stdint.h>

/* Checks that a head's counts are within their tables and lists; that W[frame & 1] holds this
 * frame, whole, and that its contacts are sorted and name rows and fixed objects that exist; that
 * the moved table is whole. The last two hash the tables (1 ms for about 20,000 entities). Each
 * returns 0, or -1 with the reason, which names the field. */
int segment_check_head(const struct view *view, const struct state_head *head,
                       struct error_text *error);
int segment_check_state(const struct view *view, uint64_t frame, struct error_text *error);
int segment_check_moved(const struct view *view, uint64_t frame, struct error_text *error);

#endif
