/* Draws strikes from the seed and sends their signals. */
#include "tests/storm/fault_injector.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* How many of 100 strikes stop a process, and how many stop and continue it. The others are
 * fractions of the rounds, where nothing else is said. */
#define STOPS          6
#define STOP_CONTINUES 6
#define PAIRS          0.10
#define REPLACEMENTS   0.10
#define BEFORE_ROLE    0.30 /* of the rounds that strike a replacement */
#define STAND_BYS      0.06
#define SUPERVISORS    0.006
#define NO_GAP         0.15 /* of the gaps */
/* Fractions of the gaps that last until the set has recovered, so that one recovery is measured
 * alone: after SIGKILL, and after SIGSTOP, whose recovery takes longer. */
#define GAP_TO_RECOVERY         0.20
#define GAP_TO_RECOVERY_STOPPED 0.60

/* The supervisor gives up a role that dies repeatedly without a frame in between. The storm
 * therefore strikes a role at most this often without a new commit. */
#define WITHOUT_PROGRESS_MAX 3

#define NO_TARGET_NS        ((uint64_t)20 * NS_PER_S)
#define RECOVERY_WAIT_NS    ((uint64_t)NS_PER_S)
#define REPLACEMENT_WAIT_NS (500 * (uint64_t)NS_PER_MS)
#define POLL_NS             (NS_PER_MS / 20)
#define SILENCE_OTHERS_MS   2000.0 /* hang limit outside the frame loop */

static bool is_stage(uint32_t role)
{
    return role == ROLE_MOVER || role == ROLE_COLLIDER;
}

static int pid_of(const struct fault_injector *injector, uint32_t role)
{
    return (int)atomic_load(&injector->set->view.slot[role]->pid);
}

/* --- one strike --------------------------------------------------------------------------------*/

static void continue_later(struct fault_injector *injector, int pidfd, uint32_t role)
{
    const struct storm_options *options = injector->set->options;
    double limit_ms = is_stage(role) ? options->hang_ms : SILENCE_OTHERS_MS;
    double after_ms = limit_ms * (0.5 + prng_unit(&injector->prng));
    for (int i = 0; i < PENDING_MAX; i++) {
        if (injector->pending[i].pidfd < 0) {
            injector->pending[i].pidfd = pidfd;
            injector->pending[i].due_ns = clock_now_ns() + (uint64_t)(after_ms * NS_PER_MS);
            return;
        }
    }
    (void)tested_set_signal(pidfd, SIGCONT); /* no free entry */
    close(pidfd);
}

static uint64_t commit_of(const struct fault_injector *injector)
{
    return atomic_load(&injector->set->view.commit->commit);
}

static void count_without_progress(struct fault_injector *injector, uint32_t role)
{
    uint64_t commit = commit_of(injector);
    if (commit != injector->without_progress[role].commit)
        injector->without_progress[role].count = 0;
    injector->without_progress[role].commit = commit;
    injector->without_progress[role].count++;
}

static bool may_strike(const struct fault_injector *injector, uint32_t role)
{
    return injector->without_progress[role].count < WITHOUT_PROGRESS_MAX ||
           commit_of(injector) != injector->without_progress[role].commit;
}

/* Sends one signal. Returns true if the process was alive and belonged to the set. */
static bool strike_pid(struct fault_injector *injector, int pid, uint32_t role,
                       enum fault_kind kind)
{
    int pidfd = pid == injector->killed[role] ? -1 : tested_set_pidfd(injector->set, pid);
    if (pidfd < 0)
        return false;
    if (process_state(pid) == 'T')
        kind = FAULT_KILL;                               /* it is stopped already */
    if (is_stage(role) && pid == pid_of(injector, role)) /* not a stand-by */
        recovery_monitor_fault(injector->monitor, role, pid, kind);
    count_without_progress(injector, role);
    (void)tested_set_signal(pidfd, kind == FAULT_KILL ? SIGKILL : SIGSTOP);
    if (kind == FAULT_KILL)
        injector->killed[role] = pid;
    injector->struck[role][kind]++;
    injector->done++;
    injector->last = kind;
    if (kind == FAULT_STOP_CONTINUE)
        continue_later(injector, pidfd, role);
    else
        close(pidfd);
    return true;
}

static enum fault_kind draw_kind(struct fault_injector *injector)
{
    uint64_t drawn = prng_below(&injector->prng, 100);
    if (drawn < STOPS)
        return FAULT_STOP;
    return drawn < STOPS + STOP_CONTINUES ? FAULT_STOP_CONTINUE : FAULT_KILL;
}

static uint32_t draw_role(struct fault_injector *injector)
{
    static const uint32_t roles[] = {ROLE_MOVER,    ROLE_MOVER,    ROLE_MOVER,    ROLE_COLLIDER,
                                     ROLE_COLLIDER, ROLE_COLLIDER, ROLE_RECORDER, ROLE_INTAKE,
                                     ROLE_INTAKE,   ROLE_REPORTER, ROLE_RENDERER, ROLE_GATEWAY};
    for (;;) {
        uint32_t role = roles[prng_below(&injector->prng, sizeof roles / sizeof *roles)];
        if (atomic_load(&injector->set->view.slot[role]->starts) > 0)
            return role;
    }
}

/* Draws roles until a strike meets a living process. The role excluded is never struck;
 * STRUCK_ROLES excludes none. Returns the role, or -1 with an error after NO_TARGET_NS. */
static int strike_one(struct fault_injector *injector, uint32_t excluded)
{
    uint64_t until = clock_now_ns() + NO_TARGET_NS;
    enum fault_kind kind = draw_kind(injector);
    while (clock_now_ns() < until && !process_stopping()) {
        uint32_t role = draw_role(injector);
        if (role != excluded && may_strike(injector, role) &&
            strike_pid(injector, pid_of(injector, role), role, kind))
            return (int)role;
        fault_injector_wait(injector, clock_now_ns() + POLL_NS);
    }
    return error_text_set(&injector->error,
                          "no process to strike for %.0f s: the set is not restarted",
                          (double)NO_TARGET_NS / 1e9);
}

/* --- replacements and stand-bys ----------------------------------------------------------- */

/* Returns the pid of a child of the supervisor that is not among the count pids of before, or 0.
 * The child may not have taken its role yet. */
static int new_child(const struct fault_injector *injector, const int *before, int count)
{
    int children[64];
    int now = tested_set_children(injector->set->supervisor, children, 64);
    for (int i = 0; i < now; i++) {
        bool old = false;
        for (int j = 0; j < count; j++)
            old |= children[i] == before[j];
        if (!old)
            return children[i];
    }
    return 0;
}

static bool is_role(int pid, uint32_t role)
{
    char path[64], name[32] = "", wanted[32];
    snprintf(path, sizeof path, "/proc/%d/comm", pid);
    snprintf(wanted, sizeof wanted, "jolon-%s\n", role_name((enum role)role));
    FILE *file = fopen(path, "r");
    if (!file)
        return false;
    bool read = fgets(name, sizeof name, file) != NULL;
    fclose(file);
    return read && strcmp(name, wanted) == 0;
}

/* Kills a stage and then its replacement: within a millisecond of its taking the role, or before.
 */
static int strike_replacement(struct fault_injector *injector)
{
    int before[64], count = tested_set_children(injector->set->supervisor, before, 64);
    bool early = prng_unit(&injector->prng) < BEFORE_ROLE;
    uint32_t role = prng_below(&injector->prng, 2) ? ROLE_MOVER : ROLE_COLLIDER;
    int old = pid_of(injector, role);
    if (!may_strike(injector, role) || !strike_pid(injector, old, role, FAULT_KILL))
        return strike_one(injector, STRUCK_ROLES) < 0 ? -1 : 0;
    uint64_t until = clock_now_ns() + REPLACEMENT_WAIT_NS;
    while (clock_now_ns() < until && !process_stopping()) {
        int next = early ? new_child(injector, before, count) : pid_of(injector, role);
        if (next != 0 && next != old && (!early || is_role(next, role))) {
            if (!early)
                fault_injector_wait(injector,
                                    clock_now_ns() + prng_below(&injector->prng, NS_PER_MS));
            if (may_strike(injector, role) && strike_pid(injector, next, role, FAULT_KILL)) {
                injector->before_role += pid_of(injector, role) != next;
                injector->replacements++;
            }
            return 0;
        }
        fault_injector_wait(injector, clock_now_ns() + POLL_NS);
    }
    return 0;
}

/* Strikes a child that runs a stage's program without holding the role. Strikes another process if
 * there is no such child. */
static int strike_stand_by(struct fault_injector *injector)
{
    int children[64], count = tested_set_children(injector->set->supervisor, children, 64);
    enum fault_kind kind = draw_kind(injector);
    uint32_t role = prng_below(&injector->prng, 2) ? ROLE_MOVER : ROLE_COLLIDER;
    for (int i = 0; i < count; i++) {
        if (children[i] == pid_of(injector, role) || !is_role(children[i], role))
            continue;
        if (strike_pid(injector, children[i], role, kind)) {
            injector->stand_bys++;
            return 0;
        }
    }
    return strike_one(injector, STRUCK_ROLES) < 0 ? -1 : 0;
}

/* --- the supervisor ----------------------------------------------------------------------------*/

static int strike_supervisor(struct fault_injector *injector)
{
    struct tested_set *set = injector->set;
    int pidfd = tested_set_supervisor_pidfd(set);
    if (pidfd < 0)
        return error_text_set(&injector->error, "the supervisor (pid %d) is gone", set->supervisor);
    recovery_monitor_fault(injector->monitor, STRUCK_SUPERVISOR, set->supervisor, FAULT_KILL);
    (void)tested_set_signal(pidfd, SIGKILL);
    close(pidfd);
    injector->struck[STRUCK_SUPERVISOR][FAULT_KILL]++;
    injector->done++;
    int result = tested_set_restart(set, &injector->error);
    tested_set_reap();
    return result;
}

/* --- rounds ------------------------------------------------------------------------------------*/

void fault_injector_begin(struct fault_injector *injector, struct tested_set *set,
                          struct recovery_monitor *monitor, uint64_t seed)
{
    *injector = (struct fault_injector){.set = set, .monitor = monitor, .prng = {seed}};
    for (int i = 0; i < PENDING_MAX; i++)
        injector->pending[i].pidfd = -1;
}

int fault_injector_round(struct fault_injector *injector)
{
    double kind = prng_unit(&injector->prng);
    if (kind < SUPERVISORS)
        return strike_supervisor(injector);
    if (kind < SUPERVISORS + REPLACEMENTS)
        return strike_replacement(injector);
    if (kind < SUPERVISORS + REPLACEMENTS + STAND_BYS)
        return strike_stand_by(injector);
    int first = strike_one(injector, STRUCK_ROLES);
    if (first < 0)
        return -1;
    if (kind < SUPERVISORS + REPLACEMENTS + STAND_BYS + PAIRS) {
        injector->pairs++;
        return strike_one(injector, (uint32_t)first) < 0 ? -1 : 0;
    }
    return 0;
}

void fault_injector_gap(struct fault_injector *injector)
{
    double kind = prng_unit(&injector->prng);
    double gap_ms = injector->set->options->gap_ms * prng_unit(&injector->prng);
    uint64_t until = clock_now_ns() + RECOVERY_WAIT_NS;
    if (kind < NO_GAP)
        return;
    if (kind <
        NO_GAP + (injector->last == FAULT_KILL ? GAP_TO_RECOVERY : GAP_TO_RECOVERY_STOPPED)) {
        while (!recovery_monitor_wait(injector->monitor, 0) && clock_now_ns() < until)
            fault_injector_wait(injector, clock_now_ns() + POLL_NS);
    }
    fault_injector_wait(injector, clock_now_ns() + (uint64_t)(gap_ms * NS_PER_MS));
}

void fault_injector_wait(struct fault_injector *injector, uint64_t until_ns)
{
    for (;;) {
        uint64_t now = clock_now_ns(), next = until_ns;
        for (int i = 0; i < PENDING_MAX; i++) {
            if (injector->pending[i].pidfd < 0)
                continue;
            if (injector->pending[i].due_ns <= now) {
                (void)tested_set_signal(injector->pending[i].pidfd, SIGCONT);
                close(injector->pending[i].pidfd);
                injector->pending[i].pidfd = -1;
            } else if (injector->pending[i].due_ns < next) {
                next = injector->pending[i].due_ns;
            }
        }
        if (now >= until_ns || process_stopping())
            return;
        clock_sleep_until_ns(next);
    }
}

void fault_injector_end(struct fault_injector *injector)
{
    for (int i = 0; i < PENDING_MAX; i++) {
        if (injector->pending[i].pidfd >= 0)
            injector->pending[i].due_ns = 0;
    }
    fault_injector_wait(injector, 0);
}
