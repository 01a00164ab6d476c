/* jolon-keeper: keeps the processes of a world running until the run is over. The script jolon
 * replaces itself with it, by exec, once the world is made; it holds the set's lock.
 *
 * One thread, one loop. Deaths of children and requests arrive as signals; between them the
 * watchdog checks the heartbeats. SIGTERM, SIGINT and SIGHUP end the set; SIGCONT ends every pause
 * before a restart. A child is restarted only after the kernel has reported its death. When the
 * keeper dies, the kernel kills its children (they ask for that). */
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "supervisor/keeper.h"
#include "supervisor/options.h"
#include "supervisor/run_report.h"

#include <inttypes.h>

#define READY_NS (15 * (uint64_t)NS_PER_S) /* for a role to be up before the next is started */

/* Returns true if the role is still to be waited for: it is wanted, has not refused, and does not
 * die again and again. */
static bool still_starting(const struct service *service)
{
    return service->wanted > 0 && service->refused[0] == '\0' &&
           service->history.quick_crashes < RESTART_POLICY_QUICK_CRASHES;
}

static void start_role(struct keeper *keeper, enum role role)
{
    struct process_set *set = &keeper->set;
    uint64_t until = clock_now_ns() + READY_NS;
    process_set_spawn(set, clock_now_ns());
    while (!keeper->over && !process_set_ready(set, role) && still_starting(&set->service[role])) {
        keeper_step(keeper);
        if (clock_now_ns() > until) {
            process_set_log(set, "the %s is not ready after %.0f s; goes on meanwhile",
                            role_name(role), (double)READY_NS / 1e9);
            return;
        }
    }
}

/* Starts one role after the other. The mover is the last, so that every role sees every frame. */
static void start_set(struct keeper *keeper)
{
    enum role order[ROLE_COUNT];
    int count = role_order(order, false);
    struct process_set *set = &keeper->set;
    int wanted[ROLE_COUNT];
    keeper->starting = true;
    for (int i = 0; i < ROLE_COUNT; i++) {
        wanted[i] = set->service[i].wanted;
        set->service[i].wanted = 0;
    }
    for (int i = 0; i < count && !keeper->over; i++) {
        set->service[order[i]].wanted = wanted[order[i]];
        start_role(keeper, order[i]);
    }
    /* From now on each frame role has a stand-by process. */
    for (int i = 0; i < ROLE_COUNT && !keeper->over; i++) {
        if (role_has((enum role)i, ROLE_MAKES_FRAMES))
            set->service[i].wanted = PROCESS_SET_CHILDREN;
    }
    keeper->starting = false;
}

/* Stops the roles that produce something first, then those that report it. */
static void stop_set(struct keeper *keeper)
{
    enum role order[ROLE_COUNT];
    int count = role_order(order, true);
    for (int i = 0; i < count; i++) {
        if (order[i] != ROLE_RECORDER) {
            (void)process_set_stop(&keeper->set, order[i]);
            continue;
        }
        if (keeper->plan->left_out[ROLE_RECORDER] ||
            process_set_finish(&keeper->set, ROLE_RECORDER) == EXIT_OK)
            continue;
        process_set_log(&keeper->set, "the recorder could not write all: see its last lines in %s",
                        keeper->plan->log);
        if (keeper->exit_code == EXIT_OK)
            keeper->exit_code = EXIT_REFUSED;
    }
}

/* Removes the world. A world of an earlier set stays when this set has computed no frame. */
static void remove_world(const struct keeper *keeper)
{
    struct error_text error;
    const char *world = keeper->plan->world;
    if (keeper->gave_up && keeper->begun_frame > 0 &&
        process_set_frame(&keeper->set) == keeper->begun_frame)
        process_set_log(&keeper->set, "world \"%s\" stays at frame %" PRIu64, world,
                        keeper->begun_frame);
    else if (segment_remove_own(world, &error) != 0) /* a process still holds a role */
        process_set_log(&keeper->set, "%s", error.text);
}

int main(int argc, char **argv)
{
    struct plan plan = options_plan(argc, argv);
    struct keeper keeper;
    struct error_text error;
    log_open("keeper");
    if (keeper_open(&keeper, &plan, &error) != 0)
        die_refused("%s", error.text);
    start_set(&keeper);
    if (!keeper.gave_up) {
        run_report_warn_unguarded(&keeper.set);
        run_report_warn_no_gateway(&keeper.set);
        run_report_ready(keeper.ready_fd);
    }
    while (!keeper.over)
        keeper_step(&keeper);
    stop_set(&keeper);
    if (!plan.background && !plan.json)
        progress_end(&keeper.progress, &keeper.set.view);
    if (!keeper.gave_up && run_report_summary(&keeper.set, clock_now_ns() - keeper.begun_ns) != 0)
        keeper.exit_code = EXIT_REFUSED;
    remove_world(&keeper);
    return keeper.exit_code;
}
