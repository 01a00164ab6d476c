/* Writes a fixed list of commands into a ring. */
#include "tests/crash/command_writer.h"

#include "ipc/frame/command_ring.h"
#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/frame/snapshot.h"
#include "ipc/segment/segment_attach.h"

#include <errno.h>
#include <string.h>

#define SOURCE  77
#define LOOK_NS (NS_PER_MS / 5)

/* The fast time scale makes all following frames late. */
static const struct command list[] = {
    {.type = COMMAND_PAUSE},
    {.type = COMMAND_FIRE, .entity = 2, .target = 3},
    {.type = COMMAND_STEP, .amount = 3},
    {.type = COMMAND_SCALE, .value = {100.0}},
    {.type = COMMAND_STEP, .amount = 4},
    {.type = COMMAND_QUIT},
};

#define COMMANDS (sizeof list / sizeof list[0])

/* Waits until the world has taken this many commands and is paused. */
static void wait_paused(const struct view *view, uint64_t taken)
{
    struct state_head head;
    while (!frame_protocol_finished(view)) {
        if (snapshot_head(&head, view) == 0 && head.command_cursor[RING_CLIENTS] >= taken &&
            head.paused && head.steps_left == 0)
            return;
        clock_sleep_until_ns(clock_now_ns() + LOOK_NS);
    }
}

int command_writer_main(const char *world)
{
    struct view view;
    struct error_text error;
    log_open("commander");
    if (segment_attach(&view, world, ROLE_INTAKE, &error) != 0)
        die_refused("%s", error.text);
    segment_ready(&view);
    for (uint64_t i = 0; i < COMMANDS; i++) {
        struct command command = list[i];
        command.source = SOURCE;
        command.source_sequence = i + 1;
        if (command_put(&view, RING_CLIENTS, &command) != 0 && errno != EEXIST)
            die_refused("command %llu: %s", (unsigned long long)i, strerror(errno));
        wait_paused(&view, i + 1);
    }
    segment_detach(&view);
    return EXIT_OK;
}
