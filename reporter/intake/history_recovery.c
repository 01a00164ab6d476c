/* Recovers the history from what the predecessor left in the world. */
#include "reporter/intake/history_recovery.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "world/entity/event.h"

#include <errno.h>

#define BATCH 128u

static int whole_head(struct state_head *head, const struct view *view)
{
    while (snapshot_head(head, view) != 0) {
        if (errno != EAGAIN)
            return -1;
    }
    return 0;
}

/* Adds the answers of the events up to end. */
static int note_answers(struct command_history *history, const struct view *view,
                        enum command_ring ring, uint64_t end)
{
    struct event events[BATCH];
    struct event_cursor cursor = {0};
    while (cursor.next < end) {
        errno = 0;
        uint32_t count = events_read(view, &cursor, events, BATCH);
        if (count == 0 && errno == EBADMSG)
            return -1;
        for (uint32_t i = 0; i < count; i++) {
            const struct event_command *answer = &events[i].command;
            if (events[i].type == EVENT_COMMAND && answer->ring == ring && answer->source)
                (void)command_history_answer(history, answer->source, answer->sequence,
                                             answer->type, answer->result, answer->entity,
                                             events[i].frame);
        }
    }
    return 0;
}

int history_recover(struct command_history *history, const struct view *view,
                    enum command_ring ring)
{
    const struct command_ring_words *words = view->commands[ring];
    uint64_t slots = view->header->command_slots;
    struct state_head head;
    if (whole_head(&head, view) != 0 || note_answers(history, view, ring, head.event_end) != 0)
        return -1;
    /* Every command before the head's cursor has its answer before the head's event end. The others
     * are in the ring, which only this process writes. */
    uint64_t end = atomic_load_explicit(&words->head, memory_order_relaxed);
    for (uint64_t i = head.command_cursor[ring]; i < end; i++) {
        const struct command *command = &words->slot[i & (slots - 1)];
        command_history_wait(history, command->source, command->source_sequence, command->type, 0);
    }
    return 0;
}
