/* Verb replay: repeats a run in this process from its command log. */
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/log/event_log.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"
#include "recorder/replay/run_start.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The result of a replay. */
struct replayed {
    uint64_t frame, commands;
    uint64_t digest, event_digest;
    bool compared; /* with the log's end record */
    bool equal;    /* no difference found: of the end record or an earlier mark */
};

static uint64_t last_frame(const struct arguments *arguments, const struct log_replay *replay)
{
    if (arguments->frames == 0)
        return replay->known_frame;
    if (replay->gap && arguments->frames > replay->known_frame)
        die_refused("--frames %" PRIu64 ": %s has lost commands after frame %" PRIu64
                    "; what comes then cannot be replayed",
                    arguments->frames, replay->path, replay->known_frame);
    return arguments->frames;
}

static void log_events(struct event_log *events, const struct view *view)
{
    while (event_log_append(events, view))
        ;
    if (events->journal.error != 0)
        die_refused("--events %s: cannot write: %s", events->journal.path,
                    strerror(events->journal.error));
}

/* Steps the world to that frame or to the run's end. Returns false if the world differs from a mark
 * of the log. */
static bool play(struct log_replay *replay, struct frame_stepper *stepper, uint64_t last,
                 struct event_log *events)
{
    struct error_text error;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    while (step == LOG_REPLAY_STEPPED && frame_stepper_frame(stepper) < last &&
           !process_stopping()) {
        step = log_replay_step(replay, stepper, &error);
        if (events)
            log_events(events, stepper->view);
    }
    if (step == LOG_REPLAY_MISMATCH)
        log_warn("%s", error.text);
    return step != LOG_REPLAY_MISMATCH;
}

static void print_result(const struct arguments *arguments, const struct log_replay *replay,
                         const struct replayed *outcome)
{
    const char *verdict =
        log_replay_end(replay) ? "not yet at the log's end" : "the log has no end to compare with";
    if (!outcome->equal)
        verdict = "NOT equal to the run that was recorded";
    else if (outcome->compared)
        verdict = "equal to the run that was recorded";
    if (!arguments->json) {
        printf("frame %" PRIu64 ", %" PRIu64 " commands: digest %016" PRIx64
               ", of events %016" PRIx64 ": %s\n",
               outcome->frame, outcome->commands, outcome->digest, outcome->event_digest, verdict);
        return;
    }
    cJSON *object = cJSON_CreateObject();
    json_text(object, "log", replay->path);
    json_whole(object, "frame", outcome->frame);
    json_hex(object, "digest", outcome->digest);
    json_hex(object, "event_digest", outcome->event_digest);
    json_whole(object, "commands", outcome->commands);
    json_bool(object, "gap", replay->gap);
    json_bool(object, "held", outcome->compared);
    json_bool(object, "equal", outcome->equal);
    json_print(object);
}

static struct replayed compare_end(const struct log_replay *replay,
                                   const struct frame_stepper *stepper, bool marks_met)
{
    const struct view *view = stepper->view;
    const struct state *state = &view->w[frame_stepper_frame(stepper) & 1];
    const struct command_record *end = log_replay_end(replay);
    struct replayed outcome = {.frame = state->head->frame,
                               .commands = state->head->tally.commands,
                               .digest = state_digest(&view->world, state),
                               .event_digest = state->head->event_digest,
                               .equal = marks_met};
    outcome.compared = end && end->at.frame == outcome.frame;
    if (outcome.compared && (outcome.event_digest != end->event_digest ||
                             (end->digested && outcome.digest != end->digest)))
        outcome.equal = false;
    return outcome;
}

int verb_replay(const struct arguments *arguments)
{
    struct log_replay replay;
    struct view view;
    struct frame_stepper stepper;
    struct event_log events;
    if (!arguments->path)
        die_usage("replay: needs a log of commands; try jolon-world help");
    process_signals();
    run_start_open(&replay, arguments->path);
    uint64_t last = last_frame(arguments, &replay);
    run_start_make(&view, &replay);
    if (frame_stepper_init(&stepper, &view, arguments->threads) != 0)
        die_refused("cannot start %u threads: %s", arguments->threads, strerror(errno));
    if (arguments->events)
        event_log_open(&events, &view, arguments->events);
    bool marks_met = play(&replay, &stepper, last, arguments->events ? &events : NULL);
    if (arguments->events && event_log_close(&events, &view) != 0)
        die_refused("--events %s: cannot write all of it", arguments->events);
    if (replay.gap && frame_stepper_frame(&stepper) == replay.known_frame)
        log_warn("%s: commands are lost after frame %" PRIu64 ": replayed to there", replay.path,
                 replay.known_frame);
    struct replayed outcome = compare_end(&replay, &stepper, marks_met);
    print_result(arguments, &replay, &outcome);
    frame_stepper_free(&stepper);
    segment_abandon(&view);
    log_replay_close(&replay);
    return outcome.equal ? EXIT_OK : EXIT_REFUSED;
}
