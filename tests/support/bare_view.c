/* Private views for tests of the protocol. */
#include "tests/support/bare_view.h"

#include "ipc/frame/frame_protocol.h"
#include "world/checksum.h"
#include "world/param_values.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

void bare_view_make(struct view *view, const struct bare_sizes *sizes)
{
    const struct params params = {
        .hz = sizes->hz > 0.0 ? sizes->hz : 60.0,
        .dt_s = 1.0 / (sizes->hz > 0.0 ? sizes->hz : 60.0),
        .pace = sizes->hz > 0.0 ? PACE_REAL : PACE_MAX,
        .capacity = sizes->capacity,
        .event_slots = sizes->event_slots,
        .events_per_frame = sizes->events_per_frame,
        .intents_per_frame = 16,
        .command_slots = sizes->command_slots,
        .crater_slots = 16,
        .dent_slots = 16,
        .contact_slots = 16,
    };
    const struct counts counts = {.posts_side = 2, .fixed = sizes->fixed, .side_m = 50000};
    struct segment_header header = segment_header_for(&params, &counts);
    struct error_text error;
    if (segment_private(view, &header, &error) != 0)
        fail_msg("%s", error.text);
    unsigned char *base = view->base;
    *(struct params *)(void *)(base + view->layout.offset[REGION_PARAMS]) = params;
    for (int i = 0; i < 2; i++) {
        struct state_head *head = view->w[i].head;
        head->time_scale = 1.0;
        head->checksum = state_checksum(&view->w[i], sizes->fixed);
    }
    view->checked = true; /* no mover runs, so the moved table never has a checksum */
}

struct view bare_view_as(const struct view *view, enum role role)
{
    struct view copy = *view;
    copy.role = role;
    return copy;
}

static struct frame_protocol frame; /* one is enough: each process writes one frame at a time */

struct state *bare_view_begin(struct view *collider)
{
    uint64_t commit = atomic_load(&collider->commit->commit);
    atomic_store(&collider->moved_word->moved, commit + 1);
    if (frame_protocol_collider_begin(&frame, collider) != 0)
        abort();
    struct state *next = &collider->w[frame.number & 1];
    *next->head = *collider->w[commit & 1].head;
    next->head->frame = frame.number;
    return next;
}

void bare_view_end(struct view *collider)
{
    struct state *next = &collider->w[frame.number & 1];
    next->head->checksum = state_checksum(next, collider->header->counts.fixed);
    frame_protocol_collider_end(&frame, collider);
}
