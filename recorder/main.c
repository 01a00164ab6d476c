/* jolon-recorder: writes the run's events and commands into logs that a kill cannot damage, and its
 * checkpoints. */
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "recorder/recording.h"
#include "ipc/sandbox/sandbox.h"

#define WAIT_NS (20 * (uint64_t)NS_PER_MS)

/* The logs are open. Only checkpoints are still created and renamed. */
static int confine(const struct recorder *recorder, const struct sandbox *sandbox,
                   struct error_text *error)
{
    const int *folder = &recorder->checkpoint.place.folder;
    if (sandbox_files(sandbox, folder, recorder->options.checkpoint ? 1 : 0, error) != 0)
        return -1;
    return sandbox_enter(sandbox, error);
}

int main(int argc, char **argv)
{
    static struct recorder recorder;
    struct view *view = &recorder.view;
    struct sandbox sandbox;
    struct error_text error;
    log_open("recorder");
    recorder.options = options_read(argc, argv);
    process_begin(
        recorder.options.parent); /* a write beyond the file size limit fails with EFBIG */
    if (sandbox_begin(&sandbox, ROLE_RECORDER, recorder.options.sandbox_off, &error) != 0 ||
        segment_attach(view, recorder.options.world, ROLE_RECORDER, &error) != 0)
        die_refused("%s", error.text);
    recording_open(&recorder);
    if (confine(&recorder, &sandbox, &error) != 0)
        die_refused("%s", error.text);
    segment_ready(view);

    for (;;) {
        bool last = process_stopping();
        uint64_t seen = atomic_load(&view->commit->commit);
        if (recording_step(&recorder, seen))
            continue;
        if (last)
            break;
        frame_protocol_wait(view, seen, clock_now_ns() + WAIT_NS);
    }

    int code = (int)recording_close(&recorder);
    segment_detach(view);
    return code;
}
