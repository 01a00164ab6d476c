/* Is what a frame left in the world's buffers whole? */
#include "ipc/segment/frame_check.h"

#include "ipc/segment/segment_internal.h"
#include "world/checksum.h"

#include <inttypes.h>

int segment_check_head(const struct view *view, const struct state_head *head,
                       struct reason *reason)
{
    const struct segment_header *header = view->header;
    if (head->used > header->capacity)
        return reason_set(reason, "used = %u; capacity = %u", head->used, header->capacity);
    if (head->crater_count > header->crater_slots)
        return reason_set(reason, "crater_count = %u; crater_slots = %u", head->crater_count,
                          header->crater_slots);
    if (head->dent_count > header->dent_slots)
        return reason_set(reason, "dent_count = %u; dent_slots = %u", head->dent_count,
                          header->dent_slots);
    if (head->intent_count > header->intents_per_frame)
        return reason_set(reason, "intent_count = %u; intents_per_frame = %u", head->intent_count,
                          header->intents_per_frame);
    return 0;
}

/* Buffers are "world A", "world B" and "moved table", as layout.h calls their regions. */
static int check_frame(const struct view *view, const struct state_head *head, uint64_t frame,
                       enum region region, struct reason *reason)
{
    struct reason what;
    if (head->frame != frame)
        return reason_set(reason, "%s holds frame %" PRIu64 ", not %" PRIu64, region_name(region),
                          head->frame, frame);
    if (segment_check_head(view, head, &what) != 0)
        return reason_set(reason, "%s: %s", region_name(region), what.text);
    return 0;
}

int segment_check_state(const struct view *view, uint64_t frame, struct reason *reason)
{
    const struct state *state = &view->w[frame & 1];
    enum region region = frame & 1 ? REGION_WORLD_B : REGION_WORLD_A;
    if (check_frame(view, state->head, frame, region, reason) != 0)
        return -1;
    if (!state_whole(state, view->header->counts.fixed))
        return reason_set(reason, "frame %" PRIu64 " fails its checksum (%s, craters or dents)",
                          frame, region_name(region));
    return 0;
}

int segment_check_moved(const struct view *view, uint64_t frame, struct reason *reason)
{
    if (check_frame(view, view->m.head, frame, REGION_MOVED, reason) != 0)
        return -1;
    if (!moved_whole(&view->m))
        return reason_set(reason, "frame %" PRIu64 " of the moved table fails its checksum", frame);
    return 0;
}
