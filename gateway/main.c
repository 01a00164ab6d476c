/* jolon-gateway: shows the world to simulators of other makers, by DIS, and receives what they send
 * (docs/dis.md). It reads the world as the reporter does, and nothing waits for it. */
#include "gateway/gateway.h"
#include "gateway/options.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment_attach.h"

#define NICENESS  5
#define PERIOD_NS (50 * (uint64_t)NS_PER_MS)

int main(int argc, char **argv)
{
    static struct gateway gateway;
    struct sandbox sandbox;
    struct error_text error;
    struct options options;
    log_open("gateway");
    options_parse(&options, argc, argv);
    process_close_inherited();
    process_die_with_parent(options.parent);
    process_signals();
    if (process_lower_priority(NICENESS) != 0)
        log_warn("runs at normal priority: nice %d not allowed", NICENESS);
    if (sandbox_begin(&sandbox, ROLE_GATEWAY, options.sandbox_off, &error) != 0 ||
        segment_attach(&gateway.view, options.world, ROLE_GATEWAY, &error) != 0)
        die_refused("%s", error.text);
    if (gateway_open(&gateway, options.world, &error) != 0 ||
        sandbox_enter(&sandbox, &error) != 0) {
        segment_detach(&gateway.view);
        die_refused("%s", error.text);
    }
    segment_ready(&gateway.view);

    uint64_t due_ns = clock_now_ns();
    while (!process_stopping()) {
        gateway_send(&gateway);
        due_ns += PERIOD_NS;
        if (due_ns <= clock_now_ns())
            due_ns = clock_now_ns() + PERIOD_NS;
        gateway_receive(&gateway, due_ns);
    }

    atomic_store(&gateway.view.slot[ROLE_GATEWAY]->state, ROLE_STOPPING);
    gateway_send(&gateway);
    gateway_close(&gateway);
    segment_detach(&gateway.view);
    return EXIT_OK;
}
