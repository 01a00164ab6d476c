/* Verb diff: finds the first frame and field in which two runs differ. */
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"
#include "supervisor/worldctl/frame_source.h"

#include <inttypes.h>
#include <stdio.h>

static const struct state_head *head_of(const struct frame_source *source)
{
    return frame_source_frame(source).state.head;
}

/* Steps the earlier source to the later one's frame. Refuses if commands between the two are
 * unknown. */
static void catch_up(struct frame_source *early, const struct frame_source *late)
{
    const struct state_head *to = head_of(late);
    uint64_t commands = early->kind == FRAME_SOURCE_LOG
                            ? log_replay_commands(&early->replay, to->frame)
                            : head_of(early)->tally.commands;
    if (head_of(early)->frame == to->frame)
        return;
    if (early->kind == FRAME_SOURCE_WORLD)
        die_refused("%s is at frame %" PRIu64 ", before %s at %" PRIu64
                    ", and goes on by itself; pause it, or save an image of it later",
                    early->name, head_of(early)->frame, late->name, to->frame);
    if (late->kind != FRAME_SOURCE_LOG && commands != to->tally.commands)
        die_refused("%s knows %" PRIu64 " commands until frame %" PRIu64 ", %s has taken %" PRIu64
                    ": the log of the commands between is needed",
                    early->name, commands, to->frame, late->name, to->tally.commands);
    while (frame_source_number(early) < to->frame) {
        if (late->kind == FRAME_SOURCE_LOG && !frame_source_known(early))
            die_refused("%s does not know the run until frame %" PRIu64 ", where %s begins",
                        early->name, to->frame, late->name);
        if (!frame_source_step(early))
            die_refused("%s ends at frame %" PRIu64 ", before frame %" PRIu64 " of %s", early->name,
                        frame_source_number(early), to->frame, late->name);
    }
}

static void print_difference(const struct arguments *arguments, uint64_t frame,
                             const struct difference *difference)
{
    if (!arguments->json) {
        printf("frame %" PRIu64 ": %s: %s | %s", frame, difference->field, difference->a,
               difference->b);
        if (difference->columns > 1)
            printf(" (and in %u more columns)", difference->columns - 1);
        putchar('\n');
        return;
    }
    cJSON *object = cJSON_CreateObject();
    json_bool(object, "equal", 0);
    json_whole(object, "frame", frame);
    json_text(object, "field", difference->field);
    json_text(object, "column", difference->column);
    json_whole(object, "row", difference->row);
    json_text(object, "a", difference->a);
    json_text(object, "b", difference->b);
    json_print(object);
}

static void print_equal(const struct arguments *arguments, uint64_t frame)
{
    if (!arguments->json) {
        printf("equal up to frame %" PRIu64 "\n", frame);
        return;
    }
    cJSON *object = cJSON_CreateObject();
    json_bool(object, "equal", 1);
    json_whole(object, "frame", frame);
    json_print(object);
}

/* Prints the difference of the two frames. Returns false if there is none. */
static bool differ(const struct arguments *arguments, const struct frame_source *a,
                   const struct frame_source *b)
{
    struct difference difference;
    const struct compared p = frame_source_frame(a), q = frame_source_frame(b);
    if (!compare_states(&p, &q, &difference))
        return false;
    print_difference(arguments, p.state.head->frame, &difference);
    return true;
}

/* Steps two logs, as far as both know their run, until their frames differ. */
static bool differ_later(const struct arguments *arguments, struct frame_source *a,
                         struct frame_source *b, uint64_t *equal_until)
{
    while (frame_source_known(a) && frame_source_known(b) && !process_stopping()) {
        bool first = frame_source_step(a), second = frame_source_step(b);
        if (!first || !second)
            break;
        if (differ(arguments, a, b))
            return true;
        *equal_until = frame_source_number(a);
    }
    return false;
}

static int diff(const struct arguments *arguments, struct frame_source *a, struct frame_source *b)
{
    struct difference difference;
    const struct compared p = frame_source_frame(a), q = frame_source_frame(b);
    bool worlds_differ = compare_worlds(p.world, q.world, &difference);
    if (worlds_differ && !arguments->json)
        printf("made with another %s: %s | %s\n", difference.field, difference.a, difference.b);
    if (frame_source_number(a) < frame_source_number(b))
        catch_up(a, b);
    else
        catch_up(b, a);
    uint64_t equal_until = frame_source_number(a);
    if (differ(arguments, a, b) || differ_later(arguments, a, b, &equal_until))
        return EXIT_REFUSED;
    if (worlds_differ) {
        print_difference(arguments, equal_until, &difference);
        return EXIT_REFUSED;
    }
    print_equal(arguments, equal_until);
    return EXIT_OK;
}

int verb_diff(const struct arguments *arguments)
{
    static struct frame_source a, b;
    if (!arguments->other)
        die_usage(
            "diff: needs two logs of commands, images or worlds; try jolon-world diff --help");
    process_signals();
    frame_source_open(&a, arguments->path, arguments->threads);
    frame_source_open(&b, arguments->other, arguments->threads);
    int code = diff(arguments, &a, &b);
    frame_source_close(&a);
    frame_source_close(&b);
    return code;
}
