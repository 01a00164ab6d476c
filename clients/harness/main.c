/* jolon-harness: drives vehicles for a program that speaks JSON lines. It has no shared memory:
 * everything goes over the topics. */
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
        log_warn("world '%s': nobody says anything of it; is it running, with its reporter? `jolon "
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
