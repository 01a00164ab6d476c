/* Adds commands to a ring, each once. */
#include "ipc/frame/command_ring.h"

#include "ipc/frame/snapshot.h"
#include "ipc/process/crash_point.h"

#include <errno.h>

/* Returns true if the command is among the numbers first .. end - 1. */
static bool command_known(const struct command_ring_words *words, const struct command *command,
                          uint64_t slots, uint64_t first, uint64_t end)
{
    for (uint64_t i = first; i < end; i++) {
        const struct command *old = &words->slot[i & (slots - 1)];
        if (old->source == command->source && old->source_sequence == command->source_sequence)
            return true;
    }
    return false;
}

/* Writes the next command. It counts from the store of the head on. */
static void put(struct command_ring_words *words, uint64_t slots, uint64_t end,
                const struct command *command)
{
    struct command *slot = &words->slot[end & (slots - 1)];
    CRASH_POINT("command");
    *slot = *command;
    CRASH_POINT("command's sequence");
    slot->sequence = end;
    CRASH_POINT("command ring's head");
    atomic_store_explicit(&words->head, end + 1, memory_order_release);
}

int command_append(struct view *view, enum command_ring ring, const struct command *command,
                   uint64_t taken)
{
    struct command_ring_words *words = view->commands[ring];
    uint64_t slots = layout_ring_slots(view->header, (int)ring);
    uint64_t end = atomic_load_explicit(&words->head, memory_order_relaxed);
    if (end - taken >= slots) {
        errno = ENOBUFS;
        return -1;
    }
    put(words, slots, end, command);
    return 0;
}

int command_put(struct view *view, enum command_ring ring, const struct command *command)
{
    struct command_ring_words *words = view->commands[ring];
    struct state_head head;
    uint64_t slots = layout_ring_slots(view->header, (int)ring);
    uint64_t end = atomic_load_explicit(&words->head, memory_order_relaxed);
    bool full = snapshot_head(&head, view) != 0 || end - head.command_cursor[ring] >= slots;
    /* While there is room, the next slot is not searched. A writer that was killed before it stored
     * the head may have left the same command in that slot, and it does not count yet. */
    uint64_t remembered = full ? slots : slots - 1;
    if (command_known(words, command, slots, end > remembered ? end - remembered : 0, end)) {
        errno = EEXIST;
        return -1;
    }
    if (full) {
        errno = ENOBUFS;
        return -1;
    }
    put(words, slots, end, command);
    doorbell_ring(view->doorbells, ROLE_MOVER);
    CRASH_POINT("after a command");
    return 0;
}
