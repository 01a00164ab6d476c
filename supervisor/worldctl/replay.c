/* Verb replay: repeats a run in this process from its command log. */
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/log/event_log.h"
#include "recorder/replay/arguments.h"
#include "ipc/json/world_json.h"
#include "recorder/replay/run_start.h"
#include "supervisor/physics/physics_report.h"

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

static void look_at_frame(struct physics_check *physics, const struct frame_stepper *stepper)
{
    const struct view *view = stepper->view;
    const struct physics_events events = {view->events, view->header->event_slots};
    if (physics_check_frame(physics, &view->w[frame_stepper_frame(stepper) & 1], &events) != 0)
        die_refused("--physics: out of memory");
}

/* What a replay does with each of its frames. */
struct observers {
    struct event_log *events;      /* NULL: nothing is written */
    struct physics_check *physics; /* NULL: the physics is not checked */
};

/* Steps the world to that frame or to the run's end. Returns false if the world differs from a mark
 * of the log. */
static bool play(struct log_replay *replay, struct frame_stepper *stepper, uint64_t last,
                 const struct observers *observers)
{
    struct error_text error;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    while (step == LOG_REPLAY_STEPPED && frame_stepper_frame(stepper) < last &&
           !process_stopping()) {
        step = log_replay_step(replay, stepper, &error);
        if (observers->events)
            log_events(observers->events, stepper->view);
        if (observers->physics && step == LOG_REPLAY_STEPPED)
            look_at_frame(observers->physics, stepper);
    }
    if (step == LOG_REPLAY_MISMATCH)
        log_warn("%s", error.text);
    return step != LOG_REPLAY_MISMATCH;
}

/* physics: NULL if it was not checked. */
static void print_result(const struct arguments *arguments, const struct log_replay *replay,
                         const struct replayed *outcome, const struct physics_check *physics)
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
        if (physics)
            physics_report_print(physics);
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
    if (physics)
        physics_report_json(physics, object);
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

/* Prepares what the options ask for. */
static struct observers begin_observing(const struct arguments *arguments,
                                        const struct frame_stepper *stepper,
                                        struct event_log *events, struct physics_check *physics)
{
    const struct view *view = stepper->view;
    const struct state *state = &view->w[frame_stepper_frame(stepper) & 1];
    if (arguments->events)
        event_log_open(events, view, arguments->events);
    if (arguments->physics && physics_check_begin(physics, &view->world, state) != 0)
        die_refused("--physics: out of memory");
    return (struct observers){arguments->events ? events : NULL,
                              arguments->physics ? physics : NULL};
}

int verb_replay(const struct arguments *arguments)
{
    struct log_replay replay;
    struct view view;
    struct frame_stepper stepper;
    struct event_log events;
    struct physics_check physics = {0};
    if (!arguments->path)
        die_usage("replay: needs a log of commands; try jolon-world help");
    process_signals();
    run_start_open(&replay, arguments->path);
    uint64_t last = last_frame(arguments, &replay);
    run_start_make(&view, &replay);
    if (frame_stepper_init(&stepper, &view, arguments->threads) != 0)
        die_refused("cannot start %u threads: %s", arguments->threads, strerror(errno));
    const struct observers observers = begin_observing(arguments, &stepper, &events, &physics);
    bool marks_met = play(&replay, &stepper, last, &observers);
    if (arguments->events && event_log_close(&events, &view) != 0)
        die_refused("--events %s: cannot write all of it", arguments->events);
    if (replay.gap && frame_stepper_frame(&stepper) == replay.known_frame)
        log_warn("%s: commands are lost after frame %" PRIu64 ": replayed to there", replay.path,
                 replay.known_frame);
    struct replayed outcome = compare_end(&replay, &stepper, marks_met);
    print_result(arguments, &replay, &outcome, observers.physics);
    bool good = outcome.equal && (!observers.physics || measures_good(&physics.measures));
    physics_check_free(&physics);
    frame_stepper_free(&stepper);
    segment_abandon(&view);
    log_replay_close(&replay);
    return good ? EXIT_OK : EXIT_REFUSED;
}
