/* The renderer's slot. */
#include "renderer/account.h"

#include "ipc/clock.h"

void account_picture(struct view *view, const struct studio *studio, uint64_t begun_ns)
{
    struct role_slot *slot = view->slot[view->role];
    uint64_t took = clock_now_ns() - begun_ns;
    atomic_store_explicit(&slot->frame, studio->seen, memory_order_relaxed);
    atomic_store_explicit(&slot->stage_ns, took, memory_order_relaxed);
    atomic_store_explicit(&slot->gaps, studio->events.gap, memory_order_relaxed);
    const struct governor_level *level = &governor_levels[studio->governor.level];
    atomic_store_explicit(&slot->detail_pct, (uint32_t)(100.0 * level->detail + 0.5),
                          memory_order_relaxed);
    atomic_store_explicit(&slot->size_pct, 25 * level->quarters, memory_order_relaxed);
    histogram_add(&slot->stage, took);
}
