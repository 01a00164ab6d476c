/* Command logs, read and replayed. */
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

/* Reads the file into replay->text, NUL-terminated. Returns its length, or -1 with the reason. */
static ssize_t read_text(struct log_replay *replay, struct error_text *error)
{
    uint64_t bytes = 0;
    size_t length = 0;
    ssize_t got = 1;
    int fd = regular_file_open(replay->path, &bytes, error);
    if (fd < 0)
        return -1;
    if (bytes > LOG_REPLAY_BYTES_MAX) {
        close(fd);
        return error_text_set(error, "%s: is larger than 4 GB", replay->path);
    }
    replay->text = malloc((size_t)bytes + 1);
    while (replay->text && length < (size_t)bytes && got != 0) {
        got = read(fd, replay->text + length, (size_t)bytes - length);
        if (got < 0 && errno != EINTR)
            break;
        length += got > 0 ? (size_t)got : 0;
    }
    close(fd);
    if (!replay->text)
        return error_text_set(error, "%s: out of memory", replay->path);
    if (got < 0)
        return error_text_set(error, "%s: cannot read: %s", replay->path, strerror(errno));
    replay->text[length] = '\0';
    return (ssize_t)length;
}

bool log_replay_is_command_log(const char *path)
{
    char text[sizeof COMMAND_LOG_BEGINS - 1];
    struct error_text error;
    uint64_t bytes;
    int fd = regular_file_open(path, &bytes, &error);
    if (fd < 0)
        return false;
    ssize_t got = read(fd, text, sizeof text);
    close(fd);
    return got == (ssize_t)sizeof text && memcmp(text, COMMAND_LOG_BEGINS, sizeof text) == 0;
}

/* --- its records -------------------------------------------------------------------------------*/

static int refuse_line(const struct log_replay *replay, uint32_t line, struct error_text *error,
                       const char *what)
{
    return error_text_set(error, "%s:%u: %s", replay->path, line, what);
}

static int read_begin(struct log_replay *replay, const char *line, struct error_text *error)
{
    struct command_record first;
    uint64_t format;
    replay->begin = cJSON_Parse(line);
    if (strncmp(line, COMMAND_LOG_BEGINS, sizeof COMMAND_LOG_BEGINS - 1) != 0 ||
        !record_whole(replay->begin, "format", UINT32_MAX, &format))
        return refuse_line(replay, 1, error, "is no log of commands");
    if (format != COMMAND_LOG_FORMAT)
        return error_text_set(error, "%s:1: format %" PRIu64 "; this program knows %d",
                              replay->path, format, COMMAND_LOG_FORMAT);
    if (!command_record_read(&first, replay->begin) || first.type != RECORD_BEGIN ||
        !record_hex(replay->begin, "layout", &replay->layout) ||
        !record_hex(replay->begin, "origin", &replay->origin) ||
        !record_hex(replay->begin, "scenario_hash", &replay->scenario_hash) ||
        !record_hex(replay->begin, "static_hash", &replay->static_hash) ||
        !cJSON_IsString(cJSON_GetObjectItemCaseSensitive(replay->begin, "scenario")) ||
        !cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(replay->begin, "recipe")))
        return refuse_line(replay, 1, error, "does not say what the run was made of");
    replay->start = first.at;
    return 0;
}

/* Returns true for what a frame takes from a ring. */
static bool is_input(const struct command_record *record)
{
    return record->type == RECORD_COMMAND || record->type == RECORD_INPUTS;
}

/* Returns true if the record can follow the position before. */
static bool follows(const struct record_position *before, const struct command_record *record)
{
    const struct record_position *at = &record->at;
    uint64_t commands = before->commands;
    if (record->type == RECORD_BEGIN)
        return false;
    if (record->type == RECORD_COMMAND)
        commands++;
    if (record->type == RECORD_GAP)
        commands += record->lost;
    return at->frame >= before->frame && at->events >= before->events && at->commands == commands &&
           (!is_input(record) || at->frame > 0);
}

/* The log's last command may be followed by further commands of the same frame that a kill kept out
 * of the log. Only a later record shows that there were none. */
static void note_known(struct log_replay *replay, const struct command_record *record)
{
    replay->gap |= record->type == RECORD_GAP;
    if (!replay->gap)
        replay->known_frame = record->at.frame - is_input(record);
}

static int add_record(struct log_replay *replay, uint32_t *capacity, const char *line,
                      struct error_text *error)
{
    if (replay->count == *capacity) {
        uint32_t more = *capacity ? 2 * *capacity : 256;
        struct command_record *larger = realloc(replay->record, more * sizeof *larger);
        if (!larger)
            return error_text_set(error, "%s: out of memory", replay->path);
        replay->record = larger;
        *capacity = more;
    }
    struct command_record *record = &replay->record[replay->count];
    const struct record_position *before = replay->count ? &record[-1].at : &replay->start;
    cJSON *object = cJSON_Parse(line);
    bool read = command_record_read(record, object);
    cJSON_Delete(object);
    if (!read || !follows(before, record))
        return refuse_line(
            replay, replay->count + 2, error,
            "is no record that can stand here: a line before it is missing, or it was "
            "written by something else");
    replay->count++;
    note_known(replay, record);
    return 0;
}

int log_replay_open(struct log_replay *replay, const char *path, struct error_text *error)
{
    *replay = (struct log_replay){.path = path};
    ssize_t length = read_text(replay, error);
    uint32_t capacity = 0, number = 1;
    if (length < 0)
        goto err;
    char *line = replay->text, *end = replay->text + length;
    for (char *stop; line < end; line = stop + 1, number++) {
        stop = memchr(line, '\n', (size_t)(end - line));
        if (!stop) { /* torn by a kill, or being written */
            replay->torn = true;
            break;
        }
        if (!journal_check(line, (size_t)(stop - line))) {
            (void)refuse_line(replay, number, error, "check: the line is damaged");
            goto err;
        }
        *stop = '\0';
        if (number == 1 ? read_begin(replay, line, error) != 0
                        : add_record(replay, &capacity, line, error) != 0)
            goto err;
        if (number == 1)
            replay->known_frame = replay->start.frame;
    }
    if (replay->begin)
        return 0;
    (void)error_text_set(error, "%s: is no log of commands: it has no whole line", path);
err:
    log_replay_close(replay);
    return -1;
}

void log_replay_close(struct log_replay *replay)
{
    free(replay->text);
    for (uint32_t i = 0; i < replay->count; i++)
        free(replay->record[i].inputs);
    free(replay->record);
    cJSON_Delete(replay->begin);
    *replay = (struct log_replay){0};
}

const struct command_record *log_replay_end(const struct log_replay *replay)
{
    const struct command_record *last = replay->count ? &replay->record[replay->count - 1] : NULL;
    return last && last->type == RECORD_END && !replay->gap ? last : NULL;
}

uint64_t log_replay_commands(const struct log_replay *replay, uint64_t frame)
{
    uint64_t commands = replay->start.commands;
    for (uint32_t i = 0; i < replay->count && replay->record[i].at.frame <= frame; i++)
        commands = replay->record[i].at.commands;
    return commands;
}

const char *log_replay_provenance(const struct log_replay *replay, const char *key)
{
    const cJSON *text;
    cJSON_ArrayForEach(text, cJSON_GetObjectItemCaseSensitive(replay->begin, "recipe"))
    {
        const char *value = cJSON_IsString(text) ? provenance_value(text->valuestring, key) : NULL;
        if (value)
            return value;
    }
    return NULL;
}

/* --- playing -----------------------------------------------------------------------------------*/

/* Commands that waited in the rings are in the log if they were applied. Otherwise they do not
 * belong to the replay. */
static void empty_rings(const struct view *view, const struct state_head *head)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        atomic_store(&view->commands[i]->head, head->command_cursor[i]);
}

static void put_slot(const struct view *view, uint8_t ring, struct command command)
{
    struct command_ring_words *words = view->commands[ring];
    uint64_t at = atomic_load(&words->head);
    command.sequence = at;
    words->slot[at & (layout_ring_slots(view->header, ring) - 1)] = command;
    atomic_store(&words->head, at + 1);
}

static void put_command(const struct view *view, const struct event_command *given)
{
    struct command command = {.source = given->source,
                              .source_sequence = given->sequence,
                              .type = given->type,
                              .entity = given->given,
                              .target = given->target,
                              .amount = given->amount,
                              .kind = given->kind,
                              .force = given->force};
    memcpy(command.value, given->value, sizeof command.value);
    put_slot(view, given->ring, command);
}

/* Puts the frame's commands into the rings and returns their number. */
static uint32_t put_commands(struct log_replay *replay, const struct view *view, uint64_t frame)
{
    uint32_t count = 0;
    for (; replay->next < replay->count; replay->next++, count++) {
        const struct command_record *record = &replay->record[replay->next];
        if (!is_input(record) || record->at.frame != frame)
            break;
        if (record->type == RECORD_COMMAND)
            put_command(view, &record->command);
        for (uint32_t i = 0; i < record->input_count; i++)
            put_slot(view, record->input_ring, record->inputs[i]);
    }
    return count;
}

/* Compares the marks of the computed frame, and passes over the records before the next frame's
 * commands. */
static bool marks_agree(struct log_replay *replay, const struct state_head *head,
                        struct error_text *error)
{
    for (; replay->next < replay->count && replay->record[replay->next].at.frame <= head->frame;
         replay->next++) {
        const struct command_record *record = &replay->record[replay->next];
        if (record->type != RECORD_MARK && record->type != RECORD_END)
            continue;
        if (record->at.frame == head->frame && record->event_digest != head->event_digest) {
            error_text_set(error,
                           "%s:%u: at frame %" PRIu64 " the run had %" PRIu64
                           " events of digest %016" PRIx64 "; played again %" PRIu64
                           " of %016" PRIx64,
                           replay->path, replay->next + 2, head->frame, record->at.events,
                           record->event_digest, head->event_end, head->event_digest);
            return false;
        }
    }
    return true;
}

static bool all_taken(const struct log_replay *replay, const struct view *view,
                      const struct state_head *head, struct error_text *error)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        if (head->command_cursor[i] != atomic_load(&view->commands[i]->head)) {
            error_text_set(error, "%s: frame %" PRIu64 " does not take all its commands",
                           replay->path, head->frame);
            return false;
        }
    }
    return true;
}

enum log_replay_step log_replay_step(struct log_replay *replay, struct frame_stepper *stepper,
                                     struct error_text *error)
{
    const struct view *view = stepper->view;
    uint64_t frame = frame_stepper_frame(stepper);
    const struct state_head *head = view->w[frame & 1].head;
    uint64_t limit = view->world.params->frame_limit;
    if (head->quit || (limit != 0 && frame >= limit))
        return LOG_REPLAY_OVER;
    if (replay->next == 0) {
        empty_rings(view, head);
        atomic_store(&view->moved_word->moved, frame);
    }
    if (put_commands(replay, view, frame + 1) == 0 && head->paused && head->steps_left == 0)
        return LOG_REPLAY_OVER;
    frame_stepper_step(stepper, NULL);
    head = view->w[(frame + 1) & 1].head;
    return all_taken(replay, view, head, error) && marks_agree(replay, head, error)
               ? LOG_REPLAY_STEPPED
               : LOG_REPLAY_MISMATCH;
}
