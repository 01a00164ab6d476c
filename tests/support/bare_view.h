/* A private view without a scenario. The test chooses the sizes, and everything else is zero. For
 * tests of the frame protocol alone, whose writers fill the frames with made-up values. */
#ifndef JOLON_TESTS_SUPPORT_BARE_VIEW_H
#define JOLON_TESTS_SUPPORT_BARE_VIEW_H

#include "ipc/segment/segment.h"

struct bare_sizes {
    uint32_t capacity, fixed;
    uint32_t event_slots, events_per_frame; /* slots: power of two */
    uint32_t command_slots;                 /* power of two */
    double hz;                              /* 0: PACE_MAX */
};

/* Makes the view. Frame 0 is committed and its checksum is right. segment_abandon() frees the view.
 */
void bare_view_make(struct view *view, const struct bare_sizes *sizes);

/* Returns the same view as a process with this role would have it after attaching. */
struct view bare_view_as(const struct view *view, enum role role);

/* Write the next frame as the collider would. Begin returns the back buffer, whose head is a copy
 * of the previous frame's head with the frame number set. End computes the checksum and commits. */
struct state *bare_view_begin(struct view *collider);
void bare_view_end(struct view *collider);

#endif
