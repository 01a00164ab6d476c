/* Verb replay: a run once more, in this process, from its log of commands. */
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

/* How the run was played. */
struct replayed {
    uint64_t frame, commands;
    uint64_t digest, event_digest;
    bool held;  /* against the log's end */
    bool equal; /* to it; false also when a mark before it was not met */
};

static uint64_t last_frame(const struct arguments *arguments, const struct log_replay *tape)
{
    if (arguments->frames == 0)
        return tape->known_frame;
    if (tape->gap && arguments->frames > tape->known_frame)
        die_refused("--frames %" PRIu64 ": %s has lost commands after frame %" PRIu64
                    "; what comes then cannot be replayed",
                    arguments->frames, tape->path, tape->known_frame);
    return arguments->frames;
}

static void log_events(struct event_log *events, const struct view *view)
{
    while (event_log_turn(events, view))
        ;
    if (events->journal.error != 0)
        die_refused("--events %s: cannot write: %s", events->journal.path,
                    strerror(events->journal.error));
}

/* Steps the world to that frame or to the run's end. False when a mark of the log is not met. */
static bool play(struct log_replay *tape, struct frame_stepper *player, uint64_t last,
                 struct event_log *events)
{
    struct reason reason;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    while (step == LOG_REPLAY_STEPPED && frame_stepper_frame(player) < last &&
           !process_stopping()) {
        step = log_replay_step(tape, player, &reason);
        if (events)
            log_events(events, player->view);
    }
    if (step == LOG_REPLAY_WRONG)
        log_warn("%s", reason.text);
    return step != LOG_REPLAY_WRONG;
}

static void tell(const struct arguments *arguments, const struct log_replay *tape,
                 const struct replayed *outcome)
{
    const char *verdict =
        log_replay_end(tape) ? "not yet at the log's end" : "the log has no end to hold it against";
    if (!outcome->equal)
        verdict = "NOT equal to the run that was recorded";
    else if (outcome->held)
        verdict = "equal to the run that was recorded";
    if (!arguments->json) {
        printf("frame %" PRIu64 ", %" PRIu64 " commands: digest %016" PRIx64
               ", of events %016" PRIx64 ": %s\n",
               outcome->frame, outcome->commands, outcome->digest, outcome->event_digest, verdict);
        return;
    }
    cJSON *object = cJSON_CreateObject();
    json_text(object, "log", tape->path);
    json_whole(object, "frame", outcome->frame);
    json_hex(object, "digest", outcome->digest);
    json_hex(object, "event_digest", outcome->event_digest);
    json_whole(object, "commands", outcome->commands);
    json_bool(object, "gap", tape->gap);
    json_bool(object, "held", outcome->held);
    json_bool(object, "equal", outcome->equal);
    json_print(object);
}

static struct replayed judge(const struct log_replay *tape, const struct frame_stepper *player,
                             bool met)
{
    const struct view *view = player->view;
    const struct state *state = &view->w[frame_stepper_frame(player) & 1];
    const struct command_record *end = log_replay_end(tape);
    struct replayed outcome = {.frame = state->head->frame,
                               .commands = state->head->tally.commands,
                               .digest = state_digest(&view->world, state),
                               .event_digest = state->head->event_digest,
                               .equal = met};
    outcome.held = end && end->at.frame == outcome.frame;
    if (outcome.held && (outcome.event_digest != end->event_digest ||
                         (end->digested && outcome.digest != end->digest)))
        outcome.equal = false;
    return outcome;
}

int verb_replay(const struct arguments *arguments)
{
    struct log_replay tape;
    struct view view;
    struct frame_stepper player;
    struct event_log events;
    if (!arguments->path)
        die_usage("replay: wants a log of commands; try jolon-world help");
    process_signals();
    run_start_tape(&tape, arguments->path);
    uint64_t last = last_frame(arguments, &tape);
    run_start_world(&view, &tape);
    if (frame_stepper_init(&player, &view, arguments->threads) != 0)
        die_refused("cannot start %u threads: %s", arguments->threads, strerror(errno));
    if (arguments->events)
        event_log_open(&events, &view, arguments->events);
    bool met = play(&tape, &player, last, arguments->events ? &events : NULL);
    if (arguments->events && event_log_close(&events, &view) != 0)
        die_refused("--events %s: cannot write all of it", arguments->events);
    if (tape.gap && frame_stepper_frame(&player) == tape.known_frame)
        log_warn("%s: commands are lost after frame %" PRIu64 ": replayed to there", tape.path,
                 tape.known_frame);
    struct replayed outcome = judge(&tape, &player, met);
    tell(arguments, &tape, &outcome);
    frame_stepper_free(&player);
    segment_abandon(&view);
    log_replay_close(&tape);
    return outcome.equal ? EXIT_OK : EXIT_REFUSED;
}
