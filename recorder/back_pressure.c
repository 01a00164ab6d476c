/* Pauses a world whose events are made faster than they can be written. */
#include "recorder/back_pressure.h"

#include "ipc/frame/command_ring.h"
#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "world/entity/event.h"
#include "world/param_values.h"
#include "world/params.h"

#include <inttypes.h>

#define BATCH 256

static void note_command(struct back_pressure *pressure, const struct event_command *command)
{
    if (command->result != COMMAND_DONE)
        return;
    if (command->type == COMMAND_RESUME)
        pressure->holder = COMMAND_RING_COUNT;
    /* A pause by another ring outlasts the recorder's. */
    if (command->type == COMMAND_PAUSE &&
        (pressure->holder == COMMAND_RING_COUNT || pressure->holder == RING_RECORDER))
        pressure->holder = command->ring;
}

static void read_events(struct back_pressure *pressure, const struct view *view)
{
    static struct event events[BATCH];
    uint32_t count;
    do {
        count = events_read(view, &pressure->cursor, events, BATCH);
        for (uint32_t i = 0; i < count; i++) {
            if (events[i].type == EVENT_COMMAND)
                note_command(pressure, &events[i].command);
        }
    } while (count == BATCH);
}

void back_pressure_open(struct back_pressure *pressure, const struct view *view)
{
    *pressure = (struct back_pressure){.on = view->world.params->when_full == WHEN_FULL_PAUSE,
                                       .holder = COMMAND_RING_COUNT};
    if (pressure->on)
        read_events(pressure, view);
}

static void send(struct view *view, enum command_type type)
{
    uint64_t sent = atomic_load(&view->commands[RING_RECORDER]->head);
    struct command command = {
        .source = BACK_PRESSURE_SOURCE, .source_sequence = sent + 1, .type = type};
    (void)command_put(view, RING_RECORDER,
                      &command); /* a full ring: tried again by the next update */
}

bool back_pressure_holds(const struct back_pressure *pressure)
{
    return pressure->on && pressure->holder == RING_RECORDER;
}

void back_pressure_update(struct back_pressure *pressure, struct view *view, uint64_t written)
{
    struct state_head head;
    if (!pressure->on)
        return;
    read_events(pressure, view);
    if (snapshot_head(&head, view) != 0 || frame_protocol_finished(view) ||
        atomic_load(&view->commands[RING_RECORDER]->head) > head.command_cursor[RING_RECORDER])
        return; /* the mover has not taken the last command yet */
    uint64_t waiting = head.event_end > written ? head.event_end - written : 0;
    if (waiting > view->header->event_slots / 2 && (!head.paused || head.steps_left > 0)) {
        log_warn("%" PRIu64 " events wait to be written, half of what the ring holds: pausing "
                 "the world until they are",
                 waiting);
        send(view, COMMAND_PAUSE);
    } else if (waiting == 0 && head.paused && back_pressure_holds(pressure)) {
        log_info("every event is written: the world goes on");
        send(view, COMMAND_RESUME);
    }
}
