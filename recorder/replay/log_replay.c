/* Logs of commands, read and played. */
#include "recorder/replay/log_replay.h"

#include "ipc/process/regular_file.h"
#include "recorder/log/journal.h"
#include "world/params.h"
#include "world/provenance.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LOG_REPLAY_BYTES_MAX ((uint64_t)1 << 32)

/* --- the file ----------------------------------------------------------------------------------*/

/* The file's text, NUL-terminated, into tape->text; its length, -1 with the reason. */
static ssize_t read_text(struct log_replay *tape, struct reason *reason)
{
    uint64_t bytes = 0;
    size_t length = 0;
    ssize_t got = 1;
    int fd = regular_file_open(tape->path, &bytes, reason);
    if (fd < 0)
        return -1;
    if (bytes > LOG_REPLAY_BYTES_MAX) {
        close(fd);
        return reason_set(reason, "%s: is larger than 4 GB", tape->path);
    }
    tape->text = malloc((size_t)bytes + 1);
    while (tape->text && length < (size_t)bytes && got != 0) {
        got = read(fd, tape->text + length, (size_t)bytes - length);
        if (got < 0 && errno != EINTR)
            break;
        length += got > 0 ? (size_t)got : 0;
    }
    close(fd);
    if (!tape->text)
        return reason_set(reason, "%s: out of memory", tape->path);
    if (got < 0)
        return reason_set(reason, "%s: cannot read: %s", tape->path, strerror(errno));
    tape->text[length] = '\0';
    return (ssize_t)length;
}

bool log_replay_is_one(const char *path)
{
    char text[sizeof COMMAND_LOG_BEGINS - 1];
    struct reason reason;
    uint64_t bytes;
    int fd = regular_file_open(path, &bytes, &reason);
    if (fd < 0)
        return false;
    ssize_t got = read(fd, text, sizeof text);
    close(fd);
    return got == (ssize_t)sizeof text && memcmp(text, COMMAND_LOG_BEGINS, sizeof text) == 0;
}

/* --- its records -------------------------------------------------------------------------------*/

static int wrong(const struct log_replay *tape, uint32_t line, struct reason *reason,
                 const char *what)
{
    return reason_set(reason, "%s:%u: %s", tape->path, line, what);
}

static int read_begin(struct log_replay *tape, const char *line, struct reason *reason)
{
    struct command_record first;
    uint64_t format;
    tape->begin = cJSON_Parse(line);
    if (strncmp(line, COMMAND_LOG_BEGINS, sizeof COMMAND_LOG_BEGINS - 1) != 0 ||
        !record_whole(tape->begin, "format", UINT32_MAX, &format))
        return wrong(tape, 1, reason, "is no log of commands");
    if (format != COMMAND_LOG_FORMAT)
        return reason_set(reason, "%s:1: format %" PRIu64 "; this program knows %d", tape->path,
                          format, COMMAND_LOG_FORMAT);
    if (!command_record_read(&first, tape->begin) || first.type != RECORD_BEGIN ||
        !record_hex(tape->begin, "layout", &tape->layout) ||
        !record_hex(tape->begin, "origin", &tape->origin) ||
        !record_hex(tape->begin, "scenario_hash", &tape->scenario_hash) ||
        !record_hex(tape->begin, "static_hash", &tape->static_hash) ||
        !cJSON_IsString(cJSON_GetObjectItemCaseSensitive(tape->begin, "scenario")) ||
        !cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(tape->begin, "recipe")))
        return wrong(tape, 1, reason, "does not say what the run was made of");
    tape->start = first.at;
    return 0;
}

/* What a record may come after. */
static bool follows(const struct record_place *before, const struct command_record *record)
{
    const struct record_place *at = &record->at;
    uint64_t commands = before->commands;
    if (record->type == RECORD_BEGIN)
        return false;
    if (record->type == RECORD_COMMAND)
        commands++;
    if (record->type == RECORD_GAP)
        commands += record->lost;
    return at->frame >= before->frame && at->events >= before->events && at->commands == commands &&
           (record->type != RECORD_COMMAND || at->frame > 0);
}

/* Of a last command's frame there may have been more commands that a kill kept out of the log; a
 * later record says that there were none. */
static void note_known(struct log_replay *tape, const struct command_record *record)
{
    tape->gap |= record->type == RECORD_GAP;
    if (!tape->gap)
        tape->known_frame = record->at.frame - (record->type == RECORD_COMMAND);
}

static int add_record(struct log_replay *tape, uint32_t *room, const char *line,
                      struct reason *reason)
{
    if (tape->count == *room) {
        uint32_t more = *room ? 2 * *room : 256;
        struct command_record *larger = realloc(tape->record, more * sizeof *larger);
        if (!larger)
            return reason_set(reason, "%s: out of memory", tape->path);
        tape->record = larger;
        *room = more;
    }
    struct command_record *record = &tape->record[tape->count];
    const struct record_place *before = tape->count ? &record[-1].at : &tape->start;
    cJSON *object = cJSON_Parse(line);
    bool read = command_record_read(record, object);
    cJSON_Delete(object);
    if (!read || !follows(before, record))
        return wrong(tape, tape->count + 2, reason,
                     "is no record that can stand here: a line before it is missing, or it was "
                     "written by something else");
    tape->count++;
    note_known(tape, record);
    return 0;
}

int log_replay_open(struct log_replay *tape, const char *path, struct reason *reason)
{
    *tape = (struct log_replay){.path = path};
    ssize_t length = read_text(tape, reason);
    uint32_t room = 0, number = 1;
    if (length < 0)
        goto err;
    char *line = tape->text, *end = tape->text + length;
    for (char *stop; line < end; line = stop + 1, number++) {
        stop = memchr(line, '\n', (size_t)(end - line));
        if (!stop) { /* torn by a kill, or being written */
            tape->torn = true;
            break;
        }
        if (!journal_check(line, (size_t)(stop - line))) {
            (void)wrong(tape, number, reason, "check: the line is damaged");
            goto err;
        }
        *stop = '\0';
        if (number == 1 ? read_begin(tape, line, reason) != 0
                        : add_record(tape, &room, line, reason) != 0)
            goto err;
        if (number == 1)
            tape->known_frame = tape->start.frame;
    }
    if (tape->begin)
        return 0;
    (void)reason_set(reason, "%s: is no log of commands: it has no whole line", path);
err:
    log_replay_close(tape);
    return -1;
}

void log_replay_close(struct log_replay *tape)
{
    free(tape->text);
    free(tape->record);
    cJSON_Delete(tape->begin);
    *tape = (struct log_replay){0};
}

const struct command_record *log_replay_end(const struct log_replay *tape)
{
    const struct command_record *last = tape->count ? &tape->record[tape->count - 1] : NULL;
    return last && last->type == RECORD_END && !tape->gap ? last : NULL;
}

uint64_t log_replay_commands(const struct log_replay *tape, uint64_t frame)
{
    uint64_t commands = tape->start.commands;
    for (uint32_t i = 0; i < tape->count && tape->record[i].at.frame <= frame; i++)
        commands = tape->record[i].at.commands;
    return commands;
}

const char *log_replay_recipe(const struct log_replay *tape, const char *key)
{
    const cJSON *text;
    cJSON_ArrayForEach(text, cJSON_GetObjectItemCaseSensitive(tape->begin, "recipe"))
    {
        const char *value = cJSON_IsString(text) ? provenance_value(text->valuestring, key) : NULL;
        if (value)
            return value;
    }
    return NULL;
}

/* --- playing -----------------------------------------------------------------------------------*/

/* What waited in the rings is in the log when it was taken, and not for us when it was not. */
static void empty_rings(const struct view *view, const struct state_head *head)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        atomic_store(&view->commands[i]->head, head->command_cursor[i]);
}

static void feed(const struct view *view, const struct event_command *given)
{
    struct command_ring_words *words = view->commands[given->ring];
    uint64_t at = atomic_load(&words->head);
    struct command command = {.sequence = at,
                              .source = given->source,
                              .source_sequence = given->sequence,
                              .type = given->type,
                              .entity = given->given,
                              .target = given->target,
                              .amount = given->amount,
                              .kind = given->kind,
                              .force = given->force};
    memcpy(command.value, given->value, sizeof command.value);
    words->slot[at & (view->header->command_slots - 1)] = command;
    atomic_store(&words->head, at + 1);
}

/* Puts the frame's commands into the rings; how many. */
static uint32_t feed_frame(struct log_replay *tape, const struct view *view, uint64_t frame)
{
    uint32_t fed = 0;
    for (; tape->next < tape->count; tape->next++, fed++) {
        const struct command_record *record = &tape->record[tape->next];
        if (record->type != RECORD_COMMAND || record->at.frame != frame)
            break;
        feed(view, &record->command);
    }
    return fed;
}

/* Marks of the frame that was made, and whatever stands before the next frame's commands. */
static bool marks_agree(struct log_replay *tape, const struct state_head *head,
                        struct reason *reason)
{
    for (; tape->next < tape->count && tape->record[tape->next].at.frame <= head->frame;
         tape->next++) {
        const struct command_record *record = &tape->record[tape->next];
        if (record->type != RECORD_MARK && record->type != RECORD_END)
            continue;
        if (record->at.frame == head->frame && record->event_digest != head->event_digest) {
            reason_set(reason,
                       "%s:%u: at frame %" PRIu64 " the run had %" PRIu64
                       " events of digest %016" PRIx64 "; played again %" PRIu64 " of %016" PRIx64,
                       tape->path, tape->next + 2, head->frame, record->at.events,
                       record->event_digest, head->event_end, head->event_digest);
            return false;
        }
    }
    return true;
}

static bool all_taken(const struct log_replay *tape, const struct view *view,
                      const struct state_head *head, struct reason *reason)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        if (head->command_cursor[i] != atomic_load(&view->commands[i]->head)) {
            reason_set(reason, "%s: frame %" PRIu64 " does not take all its commands", tape->path,
                       head->frame);
            return false;
        }
    }
    return true;
}

enum log_replay_step log_replay_step(struct log_replay *tape, struct frame_stepper *player,
                                     struct reason *reason)
{
    const struct view *view = player->view;
    uint64_t frame = frame_stepper_frame(player);
    const struct state_head *head = view->w[frame & 1].head;
    uint64_t limit = view->world.params->frame_limit;
    if (head->quit || (limit != 0 && frame >= limit))
        return LOG_REPLAY_OVER;
    if (tape->next == 0) {
        empty_rings(view, head);
        atomic_store(&view->moved_word->moved, frame);
    }
    if (feed_frame(tape, view, frame + 1) == 0 && head->paused && head->steps_left == 0)
        return LOG_REPLAY_OVER;
    frame_stepper_step(player, NULL);
    head = view->w[(frame + 1) & 1].head;
    return all_taken(tape, view, head, reason) && marks_agree(tape, head, reason)
               ? LOG_REPLAY_STEPPED
               : LOG_REPLAY_WRONG;
}
