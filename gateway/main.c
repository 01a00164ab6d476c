/* jolon-gateway: shows the world to simulators of other makers, by DIS, and receives what they send
 * (docs/dis.md). It reads the world as the reporter does, and nothing waits for it. */
#include "gateway/gateway.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/process/role_options.h"
#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment_attach.h"

#define PERIOD_NS (50 * (uint64_t)NS_PER_MS)
#define LOOKS     3u /* in a period: at all entities once, then at those that turn */

int main(int argc, char **argv)
{
    static struct gateway gateway;
    struct sandbox sandbox;
    struct error_text error;
    log_open("gateway");
    struct role_options options = role_options_read("jolon-gateway", argc, argv);
    process_begin_beside(options.parent);
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
        for (uint64_t look = 1; look < LOOKS; look++) {
            gateway_receive(&gateway, due_ns + look * PERIOD_NS / LOOKS);
            gateway_follow(&gateway);
        }
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
