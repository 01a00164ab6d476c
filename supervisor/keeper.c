/* Opening the keeper's world, and the pass of its loop. */
#include "supervisor/keeper.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_locks.h"
#include "supervisor/confine.h"
#include "supervisor/role_exit.h"
#include "supervisor/run_report.h"

#include <linux/close_range.h>
#include <stdio.h>
#include <unistd.h>

#define EARLIER_SET_NS (5 * (uint64_t)NS_PER_S) /* for the processes of a killed set to end */

/* Blocks the signals for sigtimedwait(). The script has set them to be ignored, and the kernel
 * drops an ignored signal even while it is blocked: process_signals() installs handlers. */
static void block_signals(struct keeper *keeper)
{
    sigemptyset(&keeper->signals);
    sigaddset(&keeper->signals, SIGCHLD);
    sigaddset(&keeper->signals, SIGINT);
    sigaddset(&keeper->signals, SIGTERM);
    sigaddset(&keeper->signals, SIGHUP);
    sigaddset(&keeper->signals, SIGCONT);
    sigprocmask(SIG_BLOCK, &keeper->signals, NULL);
    process_signals();
}

/* Names the files that are removed when the world's shared memory is cut off. */
static void guard_removes(const struct segment_paths *paths)
{
    char socket[SEGMENT_PATH_MAX + 16];
    process_guard_removes(paths->object);
    process_guard_removes(paths->name);
    process_guard_removes(paths->lock);
    snprintf(socket, sizeof socket, "%s.commands", paths->name);
    process_guard_removes(socket);
    snprintf(socket, sizeof socket, "%s.pictures", paths->name);
    process_guard_removes(socket);
}

int keeper_open(struct keeper *keeper, const struct plan *plan, struct error_text *error)
{
    struct segment_paths paths;
    *keeper = (struct keeper){.plan = plan, .repaired_frame = UINT64_MAX};
    block_signals(keeper);
    /* The children must not inherit descriptors of the script, above all its lock. */
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    if (segment_paths(&paths, plan->world, error) != 0)
        return -1;
    guard_removes(&paths);
    keeper->ready_fd = run_report_open_ready(plan->ready); /* confine_keeper() would refuse it */
    if (process_set_open(&keeper->set, plan, error) != 0 ||
        segment_wait_free(plan->world, ROLE_RENDERER, clock_now_ns() + EARLIER_SET_NS, error) !=
            0 ||
        confine_keeper(plan, error) != 0)
        return -1;
    keeper->begun_ns = keeper->watchdog.last_ns = keeper->watchdog.since_ns = clock_now_ns();
    keeper->begun_frame = process_set_frame(&keeper->set);
    keeper->progress = progress_begin();
    return 0;
}

void keeper_step(struct keeper *keeper)
{
    const struct timespec tick = {.tv_nsec = (long)WATCHDOG_TICK_NS};
    int signal_number = sigtimedwait(&keeper->signals, NULL, &tick);
    if (signal_number == SIGCONT)
        process_set_end_pauses(&keeper->set);
    else if (signal_number > 0 && signal_number != SIGCHLD)
        keeper->over = true;
    role_exit_reap(keeper);
    process_set_pass_output(&keeper->set);
    if (keeper->over)
        return;
    uint64_t now = clock_now_ns();
    watchdog_check(&keeper->watchdog, &keeper->set, now);
    process_set_spawn(&keeper->set, now);
    if (!keeper->plan->background && !keeper->plan->json)
        progress_update(&keeper->progress, &keeper->set.view);
}

void keeper_give_up(struct keeper *keeper, int exit_code, const char *reason)
{
    keeper->over = keeper->gave_up = true;
    keeper->exit_code = exit_code;
    process_set_log(&keeper->set, "the set gave up: %s", reason);
}
