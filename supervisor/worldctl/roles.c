/* Verbs by which scripts query roles: pid, frame. */
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_locks.h"
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/arguments.h"

#include <inttypes.h>
#include <stdio.h>

#define PID_NS (200 * (uint64_t)NS_PER_MS) /* for a new holder of a role to publish its pid */

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

int verb_pid(const struct arguments *arguments)
{
    enum role role = role_argument(arguments);
    struct view view;
    arguments_attach(arguments, &view);
    int pid = segment_holder_alive(arguments->world, role, clock_now_ns() + PID_NS);
    if (pid == 0)
        die_refused("the %s of world \"%s\" is not running", role_name(role), arguments->world);
    printf("%d\n", pid);
    segment_detach(&view);
    return EXIT_OK;
}

int verb_frame(const struct arguments *arguments)
{
    struct view view;
    arguments_attach(arguments, &view);
    printf("%" PRIu64 "\n", (uint64_t)atomic_load(&view.commit->commit));
    segment_detach(&view);
    return EXIT_OK;
}
