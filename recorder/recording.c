/* The recorder's step: logs, back-pressure, checkpoints. */
#include "recorder/recording.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/frame/frame_protocol.h"

#include <inttypes.h>

void recording_open(struct recorder *recorder)
{
    const struct options *options = &recorder->options;
    struct error_text error;
    command_log_open(&recorder->commands, &recorder->view, options->commands);
    if (options->events)
        event_log_open(&recorder->events, &recorder->view, options->events);
    if (options->checkpoint && checkpoint_open(&recorder->checkpoint, &recorder->view,
                                               options->checkpoint, options->every, &error) != 0)
        die_refused("--checkpoint %s", error.text);
    back_pressure_open(&recorder->pressure, &recorder->view);
}

/* Returns true if there is more to write at once. */
static bool write_logs(struct recorder *recorder)
{
    struct role_slot *slot = recorder->view.slot[ROLE_RECORDER];
    bool more = command_log_append(&recorder->commands, &recorder->view);
    uint64_t written = recorder->commands.written;
    if (recorder->options.events) {
        uint64_t gaps = recorder->events.gaps;
        more |= event_log_append(&recorder->events, &recorder->view);
        CRASH_POINT("gaps");
        atomic_fetch_add(&slot->gaps, recorder->events.gaps - gaps);
        if (recorder->events.written < written)
            written = recorder->events.written;
    }
    back_pressure_update(&recorder->pressure, &recorder->view, written);
    return more;
}

/* Flushes the logs to the disk after a checkpoint, so that they are not behind it after a crash of
 * the machine. */
static void write_checkpoint(struct recorder *recorder)
{
    uint64_t before = recorder->checkpoint.written;
    if (!recorder->options.checkpoint)
        return;
    checkpoint_write_if_due(&recorder->checkpoint, &recorder->view);
    if (recorder->checkpoint.written == before)
        return;
    (void)write_logs(recorder);
    if (journal_sync(&recorder->commands.journal) != 0 ||
        (recorder->options.events && journal_sync(&recorder->events.journal) != 0))
        log_warn("the logs did not reach the disk with the checkpoint");
}

bool recording_step(struct recorder *recorder, uint64_t frame)
{
    struct role_slot *slot = recorder->view.slot[ROLE_RECORDER];
    uint64_t begun_ns = clock_now_ns();
    log_frame(frame);
    frame_protocol_beat(&recorder->view);
    atomic_store_explicit(&slot->frame, frame, memory_order_relaxed);
    bool more = write_logs(recorder);
    write_checkpoint(recorder);
    atomic_store_explicit(&slot->stage_ns, clock_now_ns() - begun_ns, memory_order_relaxed);
    return more;
}

/* The logs are closed first. A checkpoint takes long on a slow disk, and a log without its end
 * would look like the log of a killed recorder. */
enum exit_code recording_close(struct recorder *recorder)
{
    const struct options *options = &recorder->options;
    enum exit_code code = EXIT_OK;
    uint64_t missing = 0;
    if (command_log_close(&recorder->commands, &recorder->view) != 0) {
        log_warn("--commands %s: the run's end is not in it", options->commands);
        code = EXIT_REFUSED;
    }
    if (options->events)
        missing = event_log_close(&recorder->events, &recorder->view);
    if (missing > 0) {
        atomic_fetch_add(&recorder->view.slot[ROLE_RECORDER]->gaps, missing);
        log_warn("--events %s: %" PRIu64 " events of the run are not in it", options->events,
                 missing);
        code = EXIT_REFUSED;
    }
    if (back_pressure_holds(&recorder->pressure) && !frame_protocol_finished(&recorder->view))
        log_warn("the world is left paused; `jolon ctl resume` lets it go on unrecorded");
    if (options->checkpoint) {
        (void)checkpoint_write(&recorder->checkpoint, &recorder->view);
        checkpoint_close(&recorder->checkpoint);
    }
    return code;
}
