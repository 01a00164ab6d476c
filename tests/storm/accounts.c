/* The log of events and the digests. */
#include "tests/storm/accounts.h"

#include "ipc/frame/snapshot.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define CALM_LIMIT_S 1800

int accounts_world(struct accounts *accounts, const struct band *band, struct error_text *error)
{
    struct snapshot snapshot;
    if (snapshot_init(&snapshot, &band->view) != 0)
        return error_text_set(error, "no memory for the last frame");
    if (snapshot_take(&snapshot, &band->view) != 0) {
        snapshot_free(&snapshot);
        return error_text_set(error, "the last frame cannot be read: %s", strerror(errno));
    }
    struct state state = snapshot_state(&snapshot, &band->view);
    accounts->frame = snapshot.head.frame;
    accounts->events = snapshot.head.event_end;
    accounts->collisions = snapshot.head.tally.collisions;
    accounts->event_digest = snapshot.head.event_digest;
    accounts->digest = state_digest(&band->view.world, &state);
    snapshot_free(&snapshot);
    return 0;
}

/* --- the log of events -------------------------------------------------------------------------*/

static uint64_t whole_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItem(object, key);
    return cJSON_IsNumber(item) ? (uint64_t)item->valuedouble : UINT64_MAX;
}

struct reading {
    struct accounts *accounts;
    uint8_t *seen;     /* [events] how often */
    uint8_t *answered; /* [sent + 1] how often */
    uint64_t source, sent;
    uint64_t frame, index; /* of the last event */
};

static void read_answer(struct reading *reading, const cJSON *event)
{
    const cJSON *source = cJSON_GetObjectItem(event, "source");
    const cJSON *command = cJSON_GetObjectItem(event, "command_sequence");
    uint64_t number = command ? whole_of(event, "command_sequence") : UINT64_MAX;
    if (!cJSON_IsString(source) || strtoull(source->valuestring, NULL, 16) != reading->source)
        return;
    if (number <= reading->sent && reading->answered[number] < UINT8_MAX)
        reading->answered[number]++;
}

static void read_event(struct reading *reading, const cJSON *event)
{
    uint64_t sequence = whole_of(event, "sequence");
    uint64_t frame = whole_of(event, "frame"), index = whole_of(event, "index");
    const cJSON *type = cJSON_GetObjectItem(event, "type");
    bool later = frame > reading->frame || (frame == reading->frame && index > reading->index);
    if (sequence >= reading->accounts->events || frame == UINT64_MAX || index == UINT64_MAX)
        return; /* a gap, or nonsense: what is missing is counted at the end */
    if (reading->seen[sequence] < UINT8_MAX)
        reading->seen[sequence]++;
    if (reading->frame != UINT64_MAX && !later)
        reading->accounts->repeated++; /* by its key */
    reading->frame = frame;
    reading->index = index;
    if (cJSON_IsString(type) && strcmp(type->valuestring, "command") == 0)
        read_answer(reading, event);
}

static void count_up(struct reading *reading)
{
    struct accounts *accounts = reading->accounts;
    uint64_t twice = 0;
    for (uint64_t i = 0; i < accounts->events; i++) {
        accounts->lost += reading->seen[i] == 0;
        twice += reading->seen[i] > 1;
    }
    if (twice > accounts->repeated)
        accounts->repeated = twice;
    for (uint64_t i = 1; i <= reading->sent; i++) {
        accounts->commands_lost += reading->answered[i] == 0;
        accounts->commands_repeated += reading->answered[i] > 1;
    }
}

int accounts_log(struct accounts *accounts, const struct storm_options *options, uint64_t source,
                 uint64_t sent, struct error_text *error)
{
    char path[STORM_PATH_MAX], *line = NULL;
    size_t room = 0;
    snprintf(path, sizeof path, "%s/events.log", options->out);
    FILE *file = fopen(path, "r");
    if (!file)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    struct reading reading = {.accounts = accounts,
                              .seen = calloc(accounts->events + 1, 1),
                              .answered = calloc(sent + 1, 1),
                              .source = source,
                              .sent = sent,
                              .frame = UINT64_MAX};
    while (reading.seen && reading.answered && getline(&line, &room, file) > 0) {
        cJSON *event = cJSON_Parse(line);
        read_event(&reading, event);
        cJSON_Delete(event);
    }
    if (reading.seen && reading.answered)
        count_up(&reading);
    int result = reading.seen && reading.answered ? 0 : error_text_set(error, "out of memory");
    free(reading.seen);
    free(reading.answered);
    free(line);
    fclose(file);
    return result;
}

/* --- the undisturbed run -----------------------------------------------------------------------*/

static uint64_t hex_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItem(object, key);
    return cJSON_IsString(item) ? strtoull(item->valuestring, NULL, 16) : 0;
}

static int play_again(const char *const *arguments, struct accounts *accounts,
                      struct error_text *error)
{
    char text[4096];
    int code = band_run(arguments, text, sizeof text, CALM_LIMIT_S);
    cJSON *summary = cJSON_Parse(text);
    if (!summary || whole_of(summary, "frame") != accounts->frame) {
        cJSON_Delete(summary);
        return error_text_set(error, "the undisturbed run to frame %" PRIu64 " ended with %d",
                              accounts->frame, code);
    }
    accounts->calm_digest = hex_of(summary, "digest");
    accounts->calm_event_digest = hex_of(summary, "event_digest");
    accounts->compared = true;
    cJSON_Delete(summary);
    return 0;
}

int accounts_calm(struct accounts *accounts, const struct storm_options *options,
                  struct error_text *error)
{
    char program[STORM_PATH_MAX], world[SEGMENT_NAME_MAX + 8], frames[24];
    char out[STORM_PATH_MAX], commands[STORM_PATH_MAX];
    snprintf(program, sizeof program, "%s/jolon", options->bin);
    snprintf(world, sizeof world, "%.24s-calm", options->world);
    snprintf(frames, sizeof frames, "%" PRIu64, accounts->frame);
    snprintf(out, sizeof out, "%s/calm", options->out);
    snprintf(commands, sizeof commands, "%s/commands.log", options->out);
    const char *const run[] = {program,     "run",      "-w",        world,
                               "--frames",  frames,     "--pace",    "max",
                               "--without", "renderer", "--without", "reporter",
                               "--json",    "--out",    out,         options->scenario,
                               NULL};
    const char *const replay[] = {program, "replay", commands, "--frames", frames, "--json", NULL};
    return play_again(options->commands > 0 ? replay : run, accounts, error);
}
