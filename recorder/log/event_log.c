/* Writes the run's events into a journal. */
#include "recorder/log/event_log.h"

#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"
#include "ipc/process/log.h"
#include "recorder/log/command_record.h"
#include "ipc/json/world_json.h"

#include <inttypes.h>
#include <string.h>

#define BATCH 256

/* --- going on ----------------------------------------------------------------------------------*/

_Noreturn static void refuse_run(const struct journal *journal, const char *what)
{
    die_refused("%s %s: %s: it is another run's; name another file", journal->option, journal->path,
                what);
}

/* Reads the frame and the sequence number of a record. Returns false if the line is not a
 * record. */
static bool read_key(const char *line, uint64_t *frame, uint64_t *sequence)
{
    cJSON *record = cJSON_Parse(line);
    bool read = record_whole(record, "frame", RECORD_WHOLE_MAX, frame) &&
                record_whole(record, "sequence", RECORD_WHOLE_MAX, sequence);
    cJSON_Delete(record);
    return read;
}

/* The sequence number after that of the log's last record, 0 for an empty log. */
static uint64_t next_sequence(const struct journal *journal)
{
    uint64_t frame, sequence;
    if (!journal->last)
        return 0;
    if (!read_key(journal->last, &frame, &sequence))
        die_refused("%s %s: is no event log of Jolon; name another file", journal->option,
                    journal->path);
    return sequence + 1;
}

static cJSON *event_json(const struct view *view, const struct event *event)
{
    cJSON *object = json_event(&view->world, event);
    json_whole(object, "sequence", event->sequence);
    return object;
}

/* Ends the process if the ring still holds the log's last event and the two differ. */
static void compare_last(struct event_log *log, const struct view *view)
{
    struct event event;
    uint64_t number = log->cursor.next - 1;
    struct event_cursor cursor = {.next = number};
    log->to_compare = false;
    if (events_read(view, &cursor, &event, 1) != 1 || event.sequence != number ||
        strstr(log->journal.last, "\"type\":\"gap\""))
        return;
    if (!journal_line_equals(log->journal.last, event_json(view, &event)))
        refuse_run(&log->journal, "its last event is not this world's of that number");
}

/* Returns true if the world, which went on from an image, is still to make this record's event. */
static bool is_beyond(const char *line, void *context)
{
    const struct state_head *head = context;
    uint64_t frame, sequence;
    return read_key(line, &frame, &sequence) && sequence >= head->event_end;
}

/* The log reaches to the end of the earlier run; the world is back at its image's frame. Cuts the
 * log to that frame. */
static void cut_back(struct event_log *log, struct state_head *head)
{
    uint64_t frame = 0, sequence = 0;
    uint64_t beyond = log->cursor.next - head->event_end;
    journal_truncate(&log->journal, is_beyond, head);
    if (log->journal.last && (!read_key(log->journal.last, &frame, &sequence) ||
                              frame > head->frame || sequence >= head->event_end))
        refuse_run(&log->journal, "its frames are not those of the image");
    log->cursor.next = next_sequence(&log->journal);
    log_warn("%s %s: the world went on from frame %" PRIu64 ": %" PRIu64
             " events that it held beyond are in %s.old now",
             log->journal.option, log->journal.path, head->frame, beyond, log->journal.path);
}

/* The log holds events that the world does not have. A world that lost its last frame to damage
 * makes that frame again. A world made from an image makes many frames again. */
static void open_ahead(struct event_log *log, const struct view *view, struct state_head *head)
{
    uint64_t frame = 0, sequence;
    (void)read_key(log->journal.last, &frame, &sequence);
    if (frame <= head->frame + 1) {
        log->to_compare = true;
        return;
    }
    if (view->header->origin == 0)
        die_refused("%s %s: holds %" PRIu64 " events, more than this world has (%" PRIu64
                    "): it is another run's; name another file",
                    log->journal.option, log->journal.path, log->cursor.next, head->event_end);
    cut_back(log, head);
}

void event_log_open(struct event_log *log, const struct view *view, const char *path)
{
    struct state_head head;
    *log = (struct event_log){0};
    journal_open(&log->journal, "--events", path, "{\"frame\":");
    log->cursor.next = next_sequence(&log->journal);
    if (snapshot_head(&head, view) != 0)
        die_refused("world \"%s\": its last frame cannot be read", view->name);
    if (log->cursor.next == 0)
        log->cursor.next = view->header->first_event; /* an empty log */
    else if (log->cursor.next > head.event_end)
        open_ahead(log, view, &head);
    else
        compare_last(log, view);
    /* The events before an image are in no ring. A log that lacks them has a gap. */
    if (log->cursor.next < view->header->first_event) {
        log->cursor.gap = view->header->first_event - log->cursor.next;
        log->cursor.next = view->header->first_event;
    }
    log->written = log->cursor.next - log->cursor.gap;
}

/* --- writing -----------------------------------------------------------------------------------*/

/* A gap's record has the frame at which the gap was found, and the sequence number of the last lost
 * event, so that numbering goes on after it. */
static void put_gap(struct event_log *log, uint64_t frame, uint64_t next)
{
    cJSON *object = cJSON_CreateObject();
    json_whole(object, "frame", frame);
    json_text(object, "type", "gap");
    json_whole(object, "lost", log->cursor.gap);
    json_whole(object, "sequence", next - 1);
    journal_append(&log->journal, object);
    log_warn("%" PRIu64 " events lost: the ring had gone round", log->cursor.gap);
    log->gaps += log->cursor.gap;
    log->cursor.gap = 0;
}

bool event_log_append(struct event_log *log, const struct view *view)
{
    static struct event events[BATCH];
    if (!journal_flush_to(&log->journal, &log->written, log->cursor.next))
        return false; /* unwritten events stay in the ring, which survives a kill */
    uint32_t count = events_read(view, &log->cursor, events, BATCH);
    if (count > 0 && log->to_compare) {
        log->cursor.next -= count;
        compare_last(log, view);
        log->cursor.next += count;
    }
    if (log->cursor.gap > 0)
        put_gap(log, atomic_load(&view->commit->commit), log->cursor.next - count);
    for (uint32_t i = 0; i < count; i++)
        journal_append(&log->journal, event_json(view, &events[i]));
    return journal_flush_to(&log->journal, &log->written, log->cursor.next) && count > 0;
}

uint64_t event_log_close(struct event_log *log, const struct view *view)
{
    struct state_head head;
    uint64_t end = snapshot_head(&head, view) == 0 ? head.event_end : log->cursor.next;
    uint64_t held = journal_close(&log->journal) == 0 ? log->cursor.next : log->written;
    return end > held ? end - held : 0;
}
