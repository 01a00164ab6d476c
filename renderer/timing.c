/* Writing the renderer's statistics. */
#include "renderer/timing.h"

#include "ipc/process/clock.h"

void timing_picture(struct view *view, const struct render_session *session, uint64_t begun_ns)
{
    struct role_slot *slot = view->slot[view->role];
    uint64_t took = clock_now_ns() - begun_ns;
    atomic_store_explicit(&slot->frame, session->seen, memory_order_relaxed);
    atomic_store_explicit(&slot->stage_ns, took, memory_order_relaxed);
    atomic_store_explicit(&slot->gaps, session->events.gap, memory_order_relaxed);
    const struct quality_control_level *level = &quality_control_levels[session->quality.level];
    atomic_store_explicit(&slot->detail_pct, (uint32_t)(100.0 * level->detail + 0.5),
                          memory_order_relaxed);
    atomic_store_explicit(&slot->size_pct, 25 * level->quarters, memory_order_relaxed);
    histogram_add(&slot->stage, took);
}
