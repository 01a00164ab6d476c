/* Verbs that the supervisor asks about roles: pid, ready, frame. */
#include "worldctl/verbs.h"

#include "ipc/clock.h"
#include "ipc/frame.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "worldctl/arguments.h"

#include <inttypes.h>
#include <stdio.h>

#define READY_TIMEOUT_NS (15 * (uint64_t)NS_PER_S)
#define POLL_NS          (2 * (uint64_t)NS_PER_MS)

static enum role role_argument(const struct arguments *arguments)
{
    enum role role = arguments->path ? role_find(arguments->path) : ROLE_NONE;
    if (role != ROLE_NONE)
        return role;
    char names[256];
    size_t length = 0;
    for (int i = 0; i < ROLE_COUNT; i++)
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%s", i ? ", " : "",
                                   role_name((enum role)i));
    die_usage("%s: no such role; there are %s", arguments->path ? arguments->path : "(none given)",
              names);
}

int verb_pid(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    enum role role = role_argument(&arguments);
    struct view view;
    arguments_attach(&arguments, &view);
    int pid = segment_holder(arguments.world, role);
    if (pid == 0)
        die_refused("the %s of world \"%s\" is not running", role_name(role), arguments.world);
    printf("%d\n", pid);
    segment_detach(&view);
    return EXIT_OK;
}

int verb_frame(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    struct view view;
    arguments_attach(&arguments, &view);
    printf("%" PRIu64 "\n", (uint64_t)atomic_load(&view.commit->commit));
    segment_detach(&view);
    return EXIT_OK;
}

/* Waits until the process --pid is the role's ready holder. Exit 1 when it died or took too long.
 */
int verb_ready(int argc, char **argv)
{
    struct arguments arguments = arguments_read(argc, argv);
    enum role role = role_argument(&arguments);
    struct view view;
    arguments_attach(&arguments, &view);
    uint64_t until = clock_now_ns() + READY_TIMEOUT_NS;
    while (clock_now_ns() < until) {
        const struct role_slot *slot = view.slot[role];
        if ((int)atomic_load(&slot->pid) == arguments.pid &&
            atomic_load(&slot->state) == ROLE_READY)
            return EXIT_OK;
        char state = process_state(arguments.pid);
        if (state == '\0' || state == 'Z' || state == 'X')
            return EXIT_REFUSED;
        clock_sleep_until_ns(clock_now_ns() + POLL_NS);
    }
    log_warn("the %s is not ready after %.0f s", role_name(role), (double)READY_TIMEOUT_NS / 1e9);
    return EXIT_REFUSED;
}
