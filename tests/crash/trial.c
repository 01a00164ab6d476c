/* Runs one world with its processes and their small parent. */
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_check.h"
#include "world/making/scenario_settings.h"
#include "tests/crash/trial.h"

#include "ipc/process/clock.h"
#include "ipc/frame/snapshot.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"
#include "tests/support/named_world.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define TIME_OUT_NS (60 * (uint64_t)NS_PER_S)
#define LOOK_NS     (NS_PER_MS / 5)

static char folder[64], self[PATH_MAX - 64], bin[PATH_MAX - 32];

/* --- the folder and plans ----------------------------------------------------------------------*/

void trial_open(void)
{
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    assert_true(length > 0);
    snprintf(bin, sizeof bin, "%.*s/../../bin", (int)(strrchr(self, '/') - self), self);
    snprintf(folder, sizeof folder, "/tmp/jolon-crash-XXXXXX");
    assert_non_null(mkdtemp(folder));
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status, (void)type, (void)walk;
    return remove(path);
}

void trial_close(void)
{
    assert_int_equal(nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

void trial_path(char *path, size_t bytes, const char *name)
{
    assert_true(snprintf(path, bytes, "%s/%s", folder, name) < (int)bytes);
}

void plan_make(struct plan *plan, const char *text, uint32_t event_slots)
{
    struct error_text error;
    *plan = (struct plan){0};
    fixture_scenario(&plan->scenario, text);
    struct params *params = &plan->scenario.settings->params;
    params->event_slots = event_slots;
    params->events_per_frame = event_slots / 2;
    params->intents_per_frame = event_slots / 4;
    params->crater_slots = params->dent_slots = params->command_slots = 64;
    params->contact_slots = 64;
    if (world_build_make(&plan->built, &plan->scenario, &error) != 0)
        fail_msg("the test's world is refused: %s", error.text);
}

void plan_free(struct plan *plan)
{
    world_build_free(&plan->built);
    scenario_free(&plan->scenario);
}

void plan_publish(const struct plan *plan, char name[SEGMENT_NAME_MAX])
{
    named_world_name(name);
    named_world_publish(name, &plan->scenario, &plan->built);
}

/* --- processes ---------------------------------------------------------------------------------*/

struct start {
    const char *const *argv;
    const struct death *death;
    const char *count;
};

static int exec_program(void *context)
{
    const struct start *start = context;
    char program[PATH_MAX], path[PATH_MAX], order[128];
    bool own = strchr(start->argv[0], '/') != NULL;
    snprintf(program, sizeof program, "%s%s%s", own ? "" : bin, own ? "" : "/", start->argv[0]);
    if (start->death) {
        snprintf(order, sizeof order, "%s:%s:%llu", start->death->role, start->death->point,
                 (unsigned long long)start->death->crossing);
        setenv("JOLON_CRASH", order, 1);
    }
    if (start->count) {
        snprintf(path, sizeof path, "%s/%s", folder, start->count);
        setenv("JOLON_CRASH_COUNT", path, 1);
    }
    snprintf(path, sizeof path, "%s/said", folder);
    int said = open(path, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (said < 0 || dup2(said, STDOUT_FILENO) < 0 || dup2(said, STDERR_FILENO) < 0)
        return 126;
    char *argv[16] = {NULL};
    for (int i = 0; start->argv[i] && i < 15; i++)
        argv[i] = (char *)(uintptr_t)start->argv[i];
    execv(program, argv);
    return 127;
}

pid_t trial_start(const char *const argv[], const struct death *death, const char *count)
{
    struct start start = {argv, death, count};
    return child_start(exec_program, &start);
}

enum { COLLIDER, RECORDER, COMMANDER, MOVER, STAND_BY, PROCESSES };

struct trial {
    struct run_outcome *outcome;
    const struct plan *plan;
    char name[SEGMENT_NAME_MAX], log[PATH_MAX], commands[PATH_MAX];
    struct view view; /* the recorder is a reader */
    struct process {
        const char *role;
        bool wanted, begun, done;
        const struct death *order; /* death at its next start */
        bool ordered;              /* the running process is to die */
        const char *count;
        pid_t pid;
        pid_t told; /* asked to stop */
    } process[PROCESSES];
};

/* Sets which processes are needed and which of them is to die. */
static void assign_roles(struct trial *trial, const struct death *death, const char *count)
{
    const struct death *first = trial->plan->first_death;
    struct process *process = trial->process;
    process[COLLIDER] = (struct process){.role = "collider", .wanted = true};
    process[RECORDER] = (struct process){.role = "recorder", .wanted = true};
    process[COMMANDER] = (struct process){.role = "commander", .wanted = trial->plan->commands};
    process[MOVER] = (struct process){.role = "mover", .wanted = true};
    process[STAND_BY] = (struct process){.role = first ? first->role : "", .wanted = first != NULL};
    for (int i = 0; i < PROCESSES; i++) {
        const struct death *order = first && i != STAND_BY ? first : death;
        if (order && strcmp(order->role, process[i].role) == 0)
            process[i].order = order;
        if (!first || i == STAND_BY)
            process[i].count = count;
    }
}

static void start(struct trial *trial, int which)
{
    struct process *process = &trial->process[which];
    const char *stage = strcmp(process->role, "mover") == 0 ? "jolon-mover" : "jolon-collider";
    const char *const argv[PROCESSES][8] = {
        [COLLIDER] = {"jolon-collider", "--world", trial->name},
        [RECORDER] = {"jolon-recorder", "--world", trial->name, "--events", trial->log,
                      "--commands", trial->commands},
        [COMMANDER] = {self, "commander", trial->name},
        [MOVER] = {"jolon-mover", "--world", trial->name},
        [STAND_BY] = {stage, "--stand-by", "--world", trial->name},
    };
    process->begun = true;
    process->ordered = process->order != NULL;
    process->pid = trial_start(argv[which], process->order, process->count);
    process->order = NULL;
}

/* Starts a process again that died as planned. The first one of a pair with a stand-by stays dead.
 */
static void ended(struct trial *trial, int which, int status)
{
    struct process *process = &trial->process[which];
    struct run_outcome *outcome = trial->outcome;
    bool first = trial->plan->first_death && which != STAND_BY;
    process->pid = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        process->done = true;
    } else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL && process->ordered) {
        process->done = first;
        outcome->died |= !first;
        if (!first)
            start(trial, which);
    } else {
        snprintf(outcome->refused, sizeof outcome->refused, "the %s ends with %s %d", process->role,
                 WIFEXITED(status) ? "exit code" : "signal",
                 WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
    }
}

/* Returns true if the process runs and holds its role. */
static bool is_ready(const struct trial *trial, int which)
{
    const struct process *process = &trial->process[which];
    const struct role_slot *slot = trial->view.slot[role_find(process->role)];
    return process->pid != 0 && (pid_t)atomic_load(&slot->pid) == process->pid &&
           atomic_load(&slot->state) == ROLE_READY;
}

static bool is_over(const struct trial *trial, int which)
{
    return trial->process[which].done || !trial->process[which].wanted;
}

/* Starts the processes whose turn has come: the mover when a command waits for it, the stand-by
 * when the process that it replaces is ready or dead. When these have ended, starts the recorder if
 * it does not run yet, and stops it. */
static void advance(struct trial *trial)
{
    struct process *process = trial->process;
    bool commanded = !trial->plan->commands || atomic_load(&trial->view.commands[0]->head) > 0;
    int first = strcmp(process[STAND_BY].role, "mover") == 0 ? MOVER : COLLIDER;
    if (!process[MOVER].begun && commanded)
        start(trial, MOVER);
    if (process[STAND_BY].wanted && !process[STAND_BY].begun &&
        (process[first].done || is_ready(trial, first)))
        start(trial, STAND_BY);
    if (!is_over(trial, MOVER) || !is_over(trial, COLLIDER) || !is_over(trial, STAND_BY))
        return;
    if (!process[RECORDER].begun)
        start(trial, RECORDER);
    if (process[RECORDER].pid != process[RECORDER].told && is_ready(trial, RECORDER)) {
        process[RECORDER].told = process[RECORDER].pid;
        kill(process[RECORDER].pid, SIGTERM);
    }
}

static bool all_over(const struct trial *trial)
{
    for (int i = 0; i < PROCESSES; i++) {
        if (!is_over(trial, i))
            return false;
    }
    return true;
}

static void reap(struct trial *trial)
{
    for (int i = 0; i < PROCESSES; i++) {
        pid_t pid = trial->process[i].pid;
        int status;
        if (pid > 0 && waitpid(pid, &status, WNOHANG) == pid)
            ended(trial, i, status);
    }
}

static void parent(struct trial *trial)
{
    uint64_t until = clock_now_ns() + TIME_OUT_NS;
    start(trial, COLLIDER);
    if (!trial->plan->late_recorder)
        start(trial, RECORDER);
    if (trial->plan->commands)
        start(trial, COMMANDER);
    while (!all_over(trial) && trial->outcome->refused[0] == '\0') {
        advance(trial);
        reap(trial);
        if (clock_now_ns() > until)
            snprintf(trial->outcome->refused, sizeof trial->outcome->refused,
                     "the run does not end: frame %llu",
                     (unsigned long long)atomic_load(&trial->view.commit->commit));
        clock_sleep_until_ns(clock_now_ns() + LOOK_NS);
    }
    for (int i = 0; i < PROCESSES; i++) {
        if (trial->process[i].pid > 0)
            child_kill(trial->process[i].pid);
    }
}

/* --- what a run comes to -----------------------------------------------------------------------*/

static void read_log(struct run_outcome *outcome, const char *path)
{
    int fd = open(path, O_RDONLY);
    ssize_t length = fd < 0 ? -1 : read(fd, outcome->log, sizeof outcome->log);
    if (fd >= 0)
        close(fd);
    if (length < 0 || length == (ssize_t)sizeof outcome->log)
        snprintf(outcome->refused, sizeof outcome->refused, "the event log: %s",
                 length < 0 ? strerror(errno) : "too long for this test");
    else
        outcome->log_bytes = (size_t)length;
}

/* Keeps the lines that are the same in all runs: commands, gaps, and the last line, which is the
 * end of the run. */
static void read_commands(struct run_outcome *outcome, const char *path)
{
    char line[4096] = "";
    size_t bytes = 0, room = sizeof outcome->log - outcome->log_bytes;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file) && bytes < room) {
        if (strstr(line, "\"type\":\"command\"") || strstr(line, "\"type\":\"gap\""))
            bytes += (size_t)snprintf(outcome->log + outcome->log_bytes + bytes, room - bytes, "%s",
                                      line);
    }
    if (bytes < room)
        bytes +=
            (size_t)snprintf(outcome->log + outcome->log_bytes + bytes, room - bytes, "%s", line);
    if (!file || bytes >= room || !strstr(line, "\"type\":\"end\""))
        snprintf(outcome->refused, sizeof outcome->refused, "the log of commands has no end");
    else
        outcome->log_bytes += bytes;
    if (file)
        fclose(file);
}

static void take_result(struct trial *trial)
{
    struct run_outcome *outcome = trial->outcome;
    struct snapshot snapshot;
    struct error_text error;
    assert_int_equal(snapshot_init(&snapshot, &trial->view), 0);
    if (snapshot_take(&snapshot, &trial->view) != 0) {
        snprintf(outcome->refused, sizeof outcome->refused, "the last frame: %s", strerror(errno));
    } else {
        struct state state = snapshot_state(&snapshot, &trial->view);
        outcome->frame = snapshot.head.frame;
        outcome->digest = state_digest(&trial->view.world, &state);
        outcome->event_digest = snapshot.head.event_digest;
    }
    snapshot_free(&snapshot);
    if (segment_verify(&trial->view, &error) != 0)
        snprintf(outcome->refused, sizeof outcome->refused, "%.*s", 200, error.text);
}

/* Makes the log that a recorder leaves when it is killed in its first line. */
static void tear_log(const char *path)
{
    static const char torn[] = "{\"frame\":1,\"ind";
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, torn, sizeof torn - 1), sizeof torn - 1);
    assert_int_equal(close(fd), 0);
}

void trial_run_to_end(struct run_outcome *outcome, const struct plan *plan, const char *world,
                      const struct death *death, const char *count)
{
    struct trial trial = {.outcome = outcome, .plan = plan};
    struct error_text error;
    *outcome = (struct run_outcome){0};
    assign_roles(&trial, death, count);
    snprintf(trial.name, sizeof trial.name, "%s", world);
    trial_path(trial.log, sizeof trial.log, "events");
    trial_path(trial.commands, sizeof trial.commands, "commands");
    tear_log(trial.log);
    if (segment_attach(&trial.view, world, ROLE_NONE, &error) != 0)
        fail_msg("%s", error.text);
    parent(&trial);
    if (outcome->refused[0] == '\0')
        take_result(&trial);
    if (outcome->refused[0] == '\0')
        read_log(outcome, trial.log);
    if (outcome->refused[0] == '\0')
        read_commands(outcome, trial.commands);
    segment_detach(&trial.view);
}

void trial_run(struct run_outcome *outcome, const struct plan *plan, const char *world,
               const struct death *death, const char *count)
{
    struct error_text error;
    trial_run_to_end(outcome, plan, world, death, count);
    if (segment_remove(world, false, &error) != 0)
        snprintf(outcome->refused, sizeof outcome->refused, "%.*s", 200, error.text);
    int left = named_world_leftovers();
    if (left != 0)
        snprintf(outcome->refused, sizeof outcome->refused, "%d files of worlds are left", left);
}

const char *run_outcome_differs(const struct run_outcome *outcome,
                                const struct run_outcome *reference)
{
    if (outcome->refused[0] != '\0')
        return outcome->refused;
    if (outcome->frame != reference->frame)
        return "the run ends with another frame";
    if (outcome->digest != reference->digest)
        return "the digest differs";
    if (outcome->event_digest != reference->event_digest)
        return "the event digest differs";
    if (outcome->log_bytes != reference->log_bytes ||
        memcmp(outcome->log, reference->log, reference->log_bytes) != 0)
        return "the log of events or of commands differs";
    return NULL;
}
