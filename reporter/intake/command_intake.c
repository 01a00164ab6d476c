/* Takes commands and sends replies. */
#include "reporter/intake/command_intake.h"

#include "ipc/frame/command_ring.h"
#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "reporter/intake/command_check.h"
#include "reporter/intake/history_recovery.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "world/entity/event.h"
#include "world/enum_names.h"

#include <errno.h>
#include <sys/random.h>

#define LONG_FRAME_NS                                                                              \
    (50 * (uint64_t)NS_PER_MS) /* an idle collider's heartbeat comes every 20 ms */

static int cannot_read(const struct view *view, struct error_text *error)
{
    return error_text_set(error, "world \"%s\": its last frame cannot be read", view->name);
}

int command_intake_open(struct command_intake *intake, const struct view *view,
                        struct error_text *error)
{
    struct state_head head;
    uint64_t seed = 0;
    *intake = (struct command_intake){0};
    if (getrandom(&seed, sizeof seed, 0) != (ssize_t)sizeof seed)
        return error_text_set(error, "the system gives no random numbers");
    command_history_clear(&intake->history, seed);
    /* history_recover() reads every answer up to a later head. Reading an answer twice changes
     * nothing. */
    if (snapshot_head(&head, view) != 0)
        return cannot_read(view, error);
    intake->cursor.next = head.event_end;
    if (history_recover(&intake->history, view, RING_CLIENTS) != 0)
        return cannot_read(view, error);
    return client_sockets_open(&intake->clients, view->name, error);
}

void command_intake_close(struct command_intake *intake)
{
    client_sockets_close(&intake->clients);
}

static void reply_to(struct command_intake *intake, const struct history_entry *entry)
{
    const jolon_CommandReply reply = {
        .source = entry->source,
        .sequence = entry->sequence,
        .type = (jolon_CommandType)entry->type,
        .result = (jolon_CommandResult)entry->result,
        .frame = entry->frame,
        .entity = entry->entity,
    };
    client_sockets_reply(&intake->clients, entry->client, &reply);
}

/* --- answers -----------------------------------------------------------------------------------*/

static void note_answer(struct command_intake *intake, const struct event *event)
{
    const struct event_command *answer = &event->command;
    if (event->type != EVENT_COMMAND || answer->ring != RING_CLIENTS || !answer->source)
        return;
    reply_to(intake,
             command_history_answer(&intake->history, answer->source, answer->sequence,
                                    answer->type, answer->result, answer->entity, event->frame));
}

static void take_answers(struct command_intake *intake, const struct view *view)
{
    uint32_t count;
    while ((count = events_read(view, &intake->cursor, intake->event, INTAKE_EVENTS_AT_ONCE)) > 0) {
        for (uint32_t i = 0; i < count; i++)
            note_answer(intake, &intake->event[i]);
    }
    if (intake->cursor.gap > 0)
        log_warn("%llu events were overwritten before their answers could be sent",
                 (unsigned long long)intake->cursor.gap);
    intake->cursor.gap = 0;
}

/* --- commands ----------------------------------------------------------------------------------*/

static void refuse(struct command_intake *intake, const struct view *view,
                   const jolon_Command *wire, enum command_result result, uint64_t client)
{
    const struct history_entry refusal = {
        .source = wire->source,
        .sequence = wire->sequence,
        .client = client,
        .frame = segment_load(&view->commit->commit),
        .type = (uint32_t)wire->type,
        .result = (uint32_t)result,
        .entity = wire->entity,
    };
    if (log_due(&intake->refused_logged_ns, NS_PER_S))
        log_warn("command %s refused: %s", command_type_name((enum command_type)wire->type),
                 command_result_name(result));
    reply_to(intake, &refusal);
}

static void put(struct command_intake *intake, struct view *view, const struct command *command,
                uint64_t client)
{
    if (command_put(view, RING_CLIENTS, command) != 0 && errno != EEXIST) {
        if (log_due(&intake->full_logged_ns, NS_PER_S))
            log_warn("command ring: %s; the client repeats the command",
                     errno == ENOBUFS ? "full" : "cannot be written");
        return;
    }
    command_history_wait(&intake->history, command->source, command->source_sequence, command->type,
                         client);
}

static void take_one(struct command_intake *intake, struct view *view, const jolon_Command *wire,
                     uint64_t client, bool over)
{
    struct command command;
    struct history_entry *known =
        command_history_find(&intake->history, wire->source, wire->sequence);
    if (known) { /* a repeat, perhaps over a new connection */
        known->client = client;
        if (known->answered)
            reply_to(intake, known);
        return;
    }
    enum command_result result = command_check(&command, wire, &view->world);
    if (result == COMMAND_DONE && over)
        result = COMMAND_CANNOT; /* the mover no longer takes commands from the ring */
    if (result == COMMAND_DONE)
        put(intake, view, &command, client);
    else
        refuse(intake, view, wire, result, client);
}

/* Returns the number of commands in the ring that no committed frame has taken. */
static uint64_t untaken(const struct view *view)
{
    struct state_head head;
    uint64_t end = atomic_load_explicit(&view->commands[RING_CLIENTS]->head, memory_order_relaxed);
    if (snapshot_head(&head, view) != 0)
        return UINT64_MAX; /* the next call tries again */
    return end - head.command_cursor[RING_CLIENTS];
}

/* Returns true if the last frame took too large a share of its time, or a long frame is in
 * progress. */
static bool strained(const struct view *view)
{
    const struct role_slot *mover = view->slot[ROLE_MOVER], *collider = view->slot[ROLE_COLLIDER];
    uint64_t work_ns = atomic_load_explicit(&mover->stage_ns, memory_order_relaxed) +
                       atomic_load_explicit(&collider->stage_ns, memory_order_relaxed);
    uint64_t beat_ns = atomic_load_explicit(&collider->beat_ns, memory_order_relaxed);
    return (double)work_ns > ADMISSION_STRAIN_SHARE * world_dt_s(&view->world) * NS_PER_S ||
           clock_now_ns() > beat_ns + LONG_FRAME_NS;
}

void command_intake_poll(struct command_intake *intake, struct view *view, uint64_t now_ns)
{
    jolon_Command wire;
    uint64_t client = 0;
    bool over =
        frame_protocol_finished(view); /* read first, so that take_answers() reads every answer */
    take_answers(intake, view);
    client_sockets_receive(&intake->clients, &intake->admission, now_ns);
    if (!admission_waiting(&intake->admission))
        return;
    struct admission_world world = {over ? 0 : untaken(view), !over && strained(view)};
    while (admission_take(&intake->admission, &world, now_ns, &wire, &client)) {
        take_one(intake, view, &wire, client, over);
        world.untaken += over ? 0 : 1;
    }
}

bool command_intake_busy(const struct command_intake *intake)
{
    return intake->history.waiting > 0 || admission_waiting(&intake->admission);
}
