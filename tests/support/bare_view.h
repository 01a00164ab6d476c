/* A private view without a scenario: sizes of one's choice, everything else zero. For tests of the
 * protocol alone, whose writers make frames up. */
#ifndef JOLON_TESTS_SUPPORT_BARE_VIEW_H
#define JOLON_TESTS_SUPPORT_BARE_VIEW_H

#include "ipc/segment/segment.h"

struct bare_sizes {
    uint32_t capacity, fixed;
    uint32_t event_slots, events_per_frame; /* slots: power of two */
    uint32_t command_slots;                 /* power of two */
    double hz;                              /* 0: PACE_MAX */
};

/* Frame 0 is committed, its checksum holds. segment_abandon() frees it. */
void bare_view_make(struct view *view, const struct bare_sizes *sizes);

/* The same view as its holder in a role: what a process that attached would have. */
struct view bare_view_as(const struct view *view, enum role role);

/* Makes the next frame in the collider's place: begin gives the back buffer with the head of the
 * frame before, of which frame is set; end computes the checksum and commits. */
struct state *bare_view_begin(struct view *collider);
void bare_view_end(struct view *collider);

#endif
