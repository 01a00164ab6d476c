/* jolon-intake: takes the commands of local clients into the command ring, and sends the replies.
 *
 * It is the only writer of the clients' ring, and it uses no network. Commands of other machines
 * come through the reporter, which is a client like any other. */
#include "ipc/segment/segment_attach.h"
#include "reporter/intake/command_intake.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/process/role_options.h"
#include "ipc/sandbox/sandbox.h"

/* Longest waits between two polls: idle, and with a command in progress. With either the heartbeat
 * comes at least every 20 ms. */
#define WAIT_NS      (10 * (uint64_t)NS_PER_MS)
#define WAIT_BUSY_NS ((uint64_t)NS_PER_MS)

static void poll_once(struct command_intake *intake, struct view *view)
{
    uint64_t begun_ns = clock_now_ns();
    frame_protocol_beat(view);
    command_intake_poll(intake, view, begun_ns);
    uint64_t frame = segment_load(&view->commit->commit);
    uint64_t stage_ns = clock_now_ns() - begun_ns;
    log_frame(frame);
    frame_protocol_stage_done(view, frame, stage_ns);
}

int main(int argc, char **argv)
{
    static struct command_intake intake;
    static struct view view;
    struct sandbox sandbox;
    struct error_text error;
    log_open("intake");
    struct role_options options = role_options_read("jolon-intake", argc, argv);
    process_begin(options.parent);
    if (sandbox_begin(&sandbox, ROLE_INTAKE, options.sandbox_off, &error) != 0 ||
        segment_attach(&view, options.world, ROLE_INTAKE, &error) != 0)
        die_refused("%s", error.text);
    if (command_intake_open(&intake, &view, &error) != 0 || sandbox_enter(&sandbox, &error) != 0) {
        segment_detach(&view);
        die_refused("%s", error.text);
    }
    segment_ready(&view);

    while (!process_stopping()) {
        poll_once(&intake, &view);
        uint64_t wait_ns = command_intake_busy(&intake) ? WAIT_BUSY_NS : WAIT_NS;
        client_sockets_wait(&intake.clients, &intake.admission, clock_now_ns() + wait_ns);
    }

    command_intake_poll(&intake, &view, clock_now_ns());
    command_intake_close(&intake);
    segment_detach(&view);
    return EXIT_OK;
}
