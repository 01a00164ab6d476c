/* Writes the run's commands into a journal. */
#include "recorder/log/command_log.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/log.h"
#include "ipc/json/world_json.h"
#include "ipc/segment/segment_check.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/provenance.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OPTION   "--commands"
#define BATCH    256
#define CLOSE_NS (2 * (uint64_t)NS_PER_S)
#define MARK_NS                                                                                    \
    (5 * (uint64_t)NS_PER_S) /* the end of a killed run is unknown for at most this long */

/* --- beginning and going on --------------------------------------------------------------------*/

static uint64_t provenance_number(const struct world *world, const char *key)
{
    const char *value = provenance_find(world->recipe, world->counts.recipe, key);
    return value ? strtoull(value, NULL, 10) : 0;
}

/* The position at which the world was made. */
static struct record_position beginning(const struct view *view)
{
    return (struct record_position){.frame = provenance_number(&view->world, "frame"),
                                    .events = view->header->first_event,
                                    .commands = provenance_number(&view->world, "commands")};
}

static void begin(struct command_log *log, const struct view *view)
{
    const struct world *world = &view->world;
    cJSON *object = cJSON_CreateObject();
    uint32_t next = 0;
    log->at = beginning(view);
    json_text(object, "jolon", "commands");
    json_whole(object, "format", COMMAND_LOG_FORMAT);
    record_add_position(object, &log->at);
    json_text(object, "type", record_type_name(RECORD_BEGIN));
    json_text(object, "world", view->name);
    json_text(object, "scenario", world->params->scenario);
    json_whole(object, "seed", world->params->seed);
    json_hex(object, "made", view->header->made);
    json_hex(object, "origin", view->header->origin);
    json_hex(object, "layout", view->header->layout_hash);
    json_hex(object, "scenario_hash", world->params->scenario_hash);
    json_hex(object, "static_hash", segment_static_hash(view->header));
    cJSON *recipe = json_array(object, "recipe");
    for (const char *text = provenance_next(world->recipe, world->counts.recipe, &next); text;
         text = provenance_next(world->recipe, world->counts.recipe, &next))
        cJSON_AddItemToArray(recipe, cJSON_CreateString(text));
    journal_append(&log->journal, object);
}

/* Returns true if the log's first record is this world's. */
static bool same_world(const struct command_log *log, const struct view *view)
{
    uint64_t made;
    char *first = journal_first(&log->journal);
    cJSON *object = first ? cJSON_Parse(first) : NULL;
    bool same = record_hex(object, "made", &made) && made == view->header->made;
    bool is_command_log =
        first && strncmp(first, COMMAND_LOG_BEGINS, sizeof COMMAND_LOG_BEGINS - 1) == 0;
    cJSON_Delete(object);
    free(first);
    if (!is_command_log)
        die_refused(OPTION " %s: is no log of commands; name another file", log->journal.path);
    return same;
}

/* An earlier run wrote to this path. Its log is renamed, and a new log is begun. */
static void rename_old(struct command_log *log)
{
    char old[PATH_TEXT_MAX * 4];
    const char *path = log->journal.path;
    CRASH_POINT("log put aside");
    if ((size_t)snprintf(old, sizeof old, "%s.old", path) >= sizeof old || rename(path, old) != 0)
        die_refused(OPTION " %s: is another run's, and cannot be renamed to %s: %s", path, old,
                    strerror(errno));
    log_info(OPTION " %s: another run's log is now %s", path, old);
    (void)journal_close(&log->journal);
    journal_open(&log->journal, OPTION, path, COMMAND_LOG_BEGINS);
}

static void continue_log(struct command_log *log, const struct view *view)
{
    struct command_record last;
    struct state_head head;
    cJSON *object = cJSON_Parse(log->journal.last);
    bool read = command_record_read(&last, object);
    cJSON_Delete(object);
    if (!read)
        die_refused(OPTION " %s: its last record is none of a log of commands; name another file",
                    log->journal.path);
    if (snapshot_head(&head, view) == 0 &&
        last.at.frame > head.frame + 1) /* one frame may have been lost to damage */
        die_refused(OPTION " %s: holds more than this world has; name another file",
                    log->journal.path);
    log->at = last.at;
    if (last.type == RECORD_END)
        journal_append(&log->journal, command_record_json(&(struct command_record){
                                          .type = RECORD_RESUMED, .at = last.at}));
}

void command_log_open(struct command_log *log, const struct view *view, const char *path)
{
    *log = (struct command_log){.marked_ns = clock_now_ns()};
    journal_open(&log->journal, OPTION, path, COMMAND_LOG_BEGINS);
    if (log->journal.last && !same_world(log, view))
        rename_old(log);
    if (log->journal.last)
        continue_log(log, view);
    else
        begin(log, view);
    log->cursor.next = log->written = log->at.events;
    (void)journal_flush(&log->journal);
}

/* --- writing -----------------------------------------------------------------------------------*/

static void put(struct command_log *log, struct command_record *record)
{
    log->at = record->at;
    journal_append(&log->journal, command_record_json(record));
}

/* Records that commands were overwritten before they could be written: those from the last record
 * up to, but not including, number before->commands. */
static void put_gap(struct command_log *log, const struct record_position *before)
{
    struct command_record gap = {
        .type = RECORD_GAP, .at = *before, .lost = before->commands - log->at.commands};
    if (gap.lost == 0)
        return;
    log_warn("%" PRIu64 " commands lost: the ring had gone round; the run cannot be replayed "
             "beyond frame %" PRIu64,
             gap.lost, log->at.frame);
    put(log, &gap);
}

static void put_command(struct command_log *log, const struct event *event)
{
    /* The event holds the low 32 bits of the number. Fewer commands than that can be lost. */
    uint32_t lost = event->command.number - (uint32_t)log->at.commands;
    struct record_position before = {event->frame, event->sequence, log->at.commands + lost};
    put_gap(log, &before);
    struct command_record record = {.type = RECORD_COMMAND,
                                    .at = {event->frame, event->sequence + 1, before.commands + 1},
                                    .command = event->command};
    put(log, &record);
}

/* Copies records from their ring. Returns false if the ring has gone round since: their hash is
 * that which the frame has noted. */
static bool take_inputs(struct command *to, const struct view *view,
                        const struct event_input *input)
{
    const struct command_ring_words *words = view->commands[input->ring];
    uint64_t slots = layout_ring_slots(view->header, input->ring), hash = 0;
    for (uint32_t i = 0; i < input->count; i++) {
        to[i] = words->slot[(input->first + i) & (slots - 1)];
        hash = remote_record_hash(&to[i], hash);
    }
    return hash == input->hash;
}

/* Writes the records of other simulators that a frame has taken. */
static void put_inputs(struct command_log *log, const struct view *view, const struct event *event)
{
    static struct command inputs[COMMAND_RECORD_INPUTS_MAX];
    const struct event_input *input = &event->input;
    struct command_record record = {.type = RECORD_INPUTS,
                                    .at = {event->frame, event->sequence + 1, log->at.commands},
                                    .inputs = inputs,
                                    .input_count = input->count,
                                    .input_ring = input->ring};
    bool whole = input->ring < COMMAND_RING_COUNT && input->count > 0 &&
                 input->count <= COMMAND_RECORD_INPUTS_MAX && take_inputs(inputs, view, input);
    if (!whole) {
        log_warn("%u inputs of other simulators lost: their ring had gone round; the run cannot be "
                 "replayed beyond frame %" PRIu64,
                 input->count, log->at.frame);
        record.type = RECORD_GAP;
    }
    put(log, &record);
    if (input->ring == RING_GATEWAY)
        log->inputs_taken = input->first + input->count;
}

/* Returns true if a frame has taken something from the gateway's ring since the last inputs that
 * the log has. */
static bool inputs_follow(const struct command_log *log, const struct view *view)
{
    struct state_head head;
    return snapshot_head(&head, view) != 0 ||
           head.command_cursor[RING_GATEWAY] != log->inputs_taken;
}

/* Records that events were overwritten before they could be read. Lost commands are found later, by
 * their numbers; records of other simulators have none, and may be among what is lost. */
static void put_lost_events(struct command_log *log, const struct view *view)
{
    if (log->cursor.gap > 0 && inputs_follow(log, view)) {
        struct command_record gap = {.type = RECORD_GAP, .at = log->at};
        log_warn("inputs of other simulators may be lost: the ring of events had gone round; the "
                 "run cannot be replayed beyond frame %" PRIu64,
                 log->at.frame);
        put(log, &gap);
    }
    log->cursor.gap = 0;
}

static void put_mark(struct command_log *log)
{
    put_gap(log, &log->mark.at);
    put(log, &log->mark);
    log->marking = false;
    log->marked_ns = clock_now_ns();
}

/* Prepares a mark of the last committed frame, to be written once every command before it is. */
static void take_mark(struct command_log *log, const struct state_head *head)
{
    log->mark = (struct command_record){
        .type = RECORD_MARK,
        .at = {head->frame, head->event_end, head->tally.commands},
        .event_digest = head->event_digest,
    };
    log->marking = true;
}

static void mark_when_due(struct command_log *log, const struct view *view)
{
    struct state_head head;
    if (log->marking || clock_now_ns() - log->marked_ns < MARK_NS)
        return;
    log->marked_ns = clock_now_ns();
    if (snapshot_head(&head, view) == 0 && head.frame > log->at.frame)
        take_mark(log, &head);
}

bool command_log_append(struct command_log *log, const struct view *view)
{
    static struct event events[BATCH];
    if (!journal_flush_to(&log->journal, &log->written, log->cursor.next))
        return false;
    mark_when_due(log, view);
    uint32_t count = events_read(view, &log->cursor, events, BATCH);
    put_lost_events(log, view);
    for (uint32_t i = 0; i < count; i++) {
        if (log->marking && events[i].sequence >= log->mark.at.events)
            put_mark(log);
        if (events[i].type == EVENT_COMMAND)
            put_command(log, &events[i]);
        else if (events[i].type == EVENT_INPUT)
            put_inputs(log, view, &events[i]);
    }
    if (log->marking && log->cursor.next >= log->mark.at.events)
        put_mark(log);
    return journal_flush_to(&log->journal, &log->written, log->cursor.next) && count > 0;
}

/* Prepares the end record: a mark of the last committed frame with its digest. */
static int take_end(struct command_log *log, const struct view *view)
{
    struct snapshot snapshot;
    if (snapshot_init(&snapshot, view) != 0)
        return -1;
    int result = snapshot_take(&snapshot, view);
    if (result == 0) {
        struct state state = snapshot_state(&snapshot, view);
        take_mark(log, &snapshot.head);
        log->mark.type = RECORD_END;
        log->mark.digested = true;
        log->mark.digest = state_digest(&view->world, &state);
    }
    snapshot_free(&snapshot);
    return result;
}

int command_log_close(struct command_log *log, const struct view *view)
{
    int result = take_end(log, view);
    uint64_t until = clock_now_ns() + CLOSE_NS;
    while (result == 0 && log->marking) {
        if (!command_log_append(log, view) && (log->journal.error != 0 || clock_now_ns() > until))
            result = -1;
    }
    if (journal_close(&log->journal) != 0)
        result = -1;
    return result;
}
