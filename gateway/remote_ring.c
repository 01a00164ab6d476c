/* Each owner is in the ring, from the first record of its entity on. */
#include "gateway/remote_ring.h"

#include "ipc/frame/command_ring.h"

/* Returns the entry whose owner no other record than the one of this number has, or NULL. */
static struct remote_entry *sole_record(const struct remote_table *table, const struct view *view,
                                        uint64_t number)
{
    uint64_t slots = layout_ring_slots(view->header, RING_GATEWAY);
    struct remote_record old =
        remote_record_of(&view->commands[RING_GATEWAY]->slot[number & (slots - 1)]);
    bool tells = old.type == REMOTE_TRACK || old.type == REMOTE_OWNER;
    struct remote_entry *entry = tells ? remote_table_find(table, old.remote) : NULL;
    return entry && entry->owner != 0 && entry->told_at == number ? entry : NULL;
}

static int append(struct view *view, const struct remote_record *record, uint64_t taken)
{
    struct command slot = remote_record_slot(record);
    return command_append(view, RING_GATEWAY, &slot, taken);
}

int remote_ring_append(struct remote_table *table, struct view *view,
                       const struct remote_record *record, uint64_t taken)
{
    uint64_t slots = layout_ring_slots(view->header, RING_GATEWAY);
    uint64_t end = segment_load(&view->commands[RING_GATEWAY]->head);
    struct remote_entry *entry;
    /* The owner takes the slot of the record that had it. So a kill at any instruction leaves one
     * of the two in that slot. */
    for (; end >= slots && (entry = sole_record(table, view, end - slots)); end++) {
        struct remote_record owner = {.remote = entry->remote,
                                      .type = REMOTE_OWNER,
                                      .slot = entry->track.slot,
                                      .event = entry->owner};
        if (append(view, &owner, taken) != 0)
            return -1;
        entry->told_at = end;
    }
    return append(view, record, taken);
}
