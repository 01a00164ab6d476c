/* Reads the log of events and compares the digests. */
#include "tests/storm/consistency.h"

#include "ipc/frame/snapshot.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define REFERENCE_LIMIT_S 1800
#define SUMMARY_BYTES                                                                              \
    (1 << 18) /* of a battle: some 100 bytes for each of 1,024 missions and objectives */

int consistency_read_world(struct consistency *consistency, const struct tested_set *set,
                           struct error_text *error)
{
    struct snapshot snapshot;
    if (snapshot_init(&snapshot, &set->view) != 0)
        return error_text_set(error, "no memory for the last frame");
    if (snapshot_take(&snapshot, &set->view) != 0) {
        snapshot_free(&snapshot);
        return error_text_set(error, "the last frame cannot be read: %s", strerror(errno));
    }
    struct state state = snapshot_state(&snapshot, &set->view);
    consistency->frame = snapshot.head.frame;
    consistency->events = snapshot.head.event_end;
    consistency->collisions = snapshot.head.tally.collisions;
    consistency->event_digest = snapshot.head.event_digest;
    consistency->digest = state_digest(&set->view.world, &state);
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
    struct consistency *consistency;
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
    if (sequence >= reading->consistency->events || frame == UINT64_MAX || index == UINT64_MAX)
        return; /* Missing sequences are counted at the end. */
    if (reading->seen[sequence] < UINT8_MAX)
        reading->seen[sequence]++;
    if (reading->frame != UINT64_MAX && !later)
        reading->consistency->repeated++; /* by (frame, index) */
    reading->frame = frame;
    reading->index = index;
    if (cJSON_IsString(type) && strcmp(type->valuestring, "command") == 0)
        read_answer(reading, event);
}

static void count_missing(struct reading *reading)
{
    struct consistency *consistency = reading->consistency;
    uint64_t twice = 0;
    for (uint64_t i = 0; i < consistency->events; i++) {
        consistency->lost += reading->seen[i] == 0;
        twice += reading->seen[i] > 1;
    }
    if (twice > consistency->repeated)
        consistency->repeated = twice;
    for (uint64_t i = 1; i <= reading->sent; i++) {
        consistency->commands_lost += reading->answered[i] == 0;
        consistency->commands_repeated += reading->answered[i] > 1;
    }
}

int consistency_read_log(struct consistency *consistency, const struct storm_options *options,
                         uint64_t source, uint64_t sent, struct error_text *error)
{
    char path[STORM_PATH_MAX], *line = NULL;
    size_t room = 0;
    snprintf(path, sizeof path, "%s/events.log", options->out);
    FILE *file = fopen(path, "r");
    if (!file)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    struct reading reading = {.consistency = consistency,
                              .seen = calloc(consistency->events + 1, 1),
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
        count_missing(&reading);
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

static int run_reference(const char *const *arguments, struct consistency *consistency,
                         struct error_text *error)
{
    static char text[SUMMARY_BYTES];
    int code = tested_set_run(arguments, text, sizeof text, REFERENCE_LIMIT_S);
    cJSON *summary = cJSON_Parse(text);
    if (!summary || whole_of(summary, "frame") != consistency->frame) {
        cJSON_Delete(summary);
        return error_text_set(error, "the undisturbed run to frame %" PRIu64 " ended with %d",
                              consistency->frame, code);
    }
    consistency->reference_digest = hex_of(summary, "digest");
    consistency->reference_event_digest = hex_of(summary, "event_digest");
    consistency->compared = true;
    cJSON_Delete(summary);
    return 0;
}

int consistency_run_reference(struct consistency *consistency, const struct storm_options *options,
                              struct error_text *error)
{
    char program[STORM_PATH_MAX], world[SEGMENT_NAME_MAX + 8], frames[24];
    char out[STORM_PATH_MAX], commands[STORM_PATH_MAX];
    snprintf(program, sizeof program, "%s/jolon", options->bin);
    snprintf(world, sizeof world, "%.24s-calm", options->world);
    snprintf(frames, sizeof frames, "%" PRIu64, consistency->frame);
    snprintf(out, sizeof out, "%s/calm", options->out);
    snprintf(commands, sizeof commands, "%s/commands.log", options->out);
    const char *const run[] = {program,     "run",      "-w",        world,
                               "--frames",  frames,     "--pace",    "max",
                               "--without", "renderer", "--without", "reporter",
                               "--json",    "--out",    out,         options->scenario,
                               NULL};
    const char *const replay[] = {program, "replay", commands, "--frames", frames, "--json", NULL};
    return run_reference(options->commands > 0 ? replay : run, consistency, error);
}
