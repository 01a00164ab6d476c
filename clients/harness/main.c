/* jolon-harness: connects a program that drives vehicles, by JSON lines on standard input and
 * output, to a world. It reads the topics and not the shared memory. */
#include "clients/harness/session.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"

int main(int argc, char **argv)
{
    static struct session session;
    struct error_text error;
    log_open("harness");
    options_parse(&session.options, argc, argv);
    process_signals();
    if (session_open(&session, &error) != 0)
        die_refused("%s", error.text);
    const char *world = session.options.world;
    int code = EXIT_OK;
    if (!session_wait_for_world(&session)) {
        log_warn("world '%s': no data comes from it; is it running, with its reporter? `jolon "
                 "status -w %s` shows it",
                 world, world);
        code = EXIT_REFUSED;
    }
    while (code == EXIT_OK && !process_stopping() && !session_finished(&session)) {
        session_turn(&session, clock_now_ns());
        session_wait(&session);
    }
    if (session.output.closed || session.queue.no_reply)
        code = EXIT_REFUSED;
    session_close(&session);
    dds_link_close(&session.link, code);
    return code;
}
