/* Starts and ends the processes of a set. */
#include "supervisor/process_set.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "world/runtime/utf8.h"
#include "world/params.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define ARGUMENTS_MAX 40
#define STOP_NS       (5 * (uint64_t)NS_PER_S) /* a child that takes longer to end is killed */
#define POLL_NS       (5 * (uint64_t)NS_PER_MS)
#define FINISH_NS     (10 * (uint64_t)NS_PER_S) /* for a role's last work to begin */

int process_set_open(struct process_set *set, const struct plan *plan, struct error_text *error)
{
    *set = (struct process_set){.plan = plan, .log_fd = -1};
    ssize_t length = readlink("/proc/self/exe", set->folder, sizeof set->folder - 1);
    char *slash = length > 0 ? strrchr(set->folder, '/') : NULL;
    if (!slash)
        return error_text_set(error, "/proc/self/exe: cannot read where the programs are");
    *slash = '\0';
    set->log_fd = open(plan->log, O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (set->log_fd < 0)
        return error_text_set(error, "%s: cannot write: %s", plan->log, strerror(errno));
    enum role order[ROLE_COUNT];
    int count = role_order(order, false);
    for (int i = 0; i < ROLE_COUNT; i++)
        set->service[i].role = (enum role)i;
    if (segment_attach(&set->view, plan->world, ROLE_NONE, error) != 0)
        return -1;
    for (int i = 0; i < count; i++)
        set->service[order[i]].wanted = order[i] == ROLE_CONSOLE ? plan->console
                                        : order[i] == ROLE_GATEWAY
                                            ? set->view.world.params->gateway.enabled != 0
                                            : !plan->left_out[order[i]];
    return 0;
}

uint64_t process_set_frame(const struct process_set *set)
{
    return atomic_load(&set->view.commit->commit);
}

/* A stopped terminal or a full pipe must not block the keeper. */
bool process_set_stderr_writable(void)
{
    struct pollfd out = {.fd = STDERR_FILENO, .events = POLLOUT};
    return poll(&out, 1, 0) == 1 && (out.revents & POLLOUT) != 0;
}

void process_set_log(const struct process_set *set, const char *format, ...)
{
    char text[8192], stamp[16];
    va_list args;
    time_t now = time(NULL);
    struct tm local;
    va_start(args, format);
    (void)utf8_format(text, sizeof text, format, args);
    va_end(args);
    localtime_r(&now, &local);
    strftime(stamp, sizeof stamp, "%H:%M:%S", &local);
    dprintf(set->log_fd, "%s supervisor: %s\n", stamp, text);
    if (!set->plan->background && process_set_stderr_writable())
        fprintf(stderr, "jolon: %s\n", text);
}

/* --- starting ----------------------------------------------------------------------------------*/

struct command_line {
    const char *argument[ARGUMENTS_MAX];
    int count;
};

static void add(struct command_line *line, const char *option, const char *value)
{
    if (option)
        line->argument[line->count++] = option;
    if (value)
        line->argument[line->count++] = value;
}

/* The options of a role's program. */
static void role_arguments(struct command_line *line, const struct plan *plan, enum role role)
{
    switch (role) {
    case ROLE_MOVER:
    case ROLE_COLLIDER:
        add(line, "--threads", plan->threads);
        break;
    case ROLE_RENDERER:
        add(line, "--out", plan->out);
        break;
    case ROLE_CONSOLE:
        add(line, "--role", NULL);
        break;
    case ROLE_RECORDER:
        add(line, "--commands", plan->commands);
        if (plan->events)
            add(line, "--events", plan->events);
        if (plan->checkpoint) {
            add(line, "--checkpoint", plan->checkpoint);
            add(line, "--every", plan->every);
        }
        break;
    default:
        break;
    }
    for (int i = 0; i < plan->role_options[role].count; i++)
        add(line, NULL, plan->role_options[role].argument[i]);
}

/* Runs in the child. It dies with the keeper from here on: a child that is stopped before it has
 * reached its own code would else outlive a keeper that is killed. Sets default signals. A session
 * of its own keeps Ctrl-C of the terminal away: the keeper ends the roles in its own order. */
_Noreturn static void exec_child(const char *path, const char *const *arguments, int output,
                                 int keeper)
{
    sigset_t none;
    process_die_with_parent(keeper);
    sigemptyset(&none);
    for (int number = 1; number < SIGRTMIN; number++)
        signal(number, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setsid();
    if (output < 0 || (dup2(output, STDOUT_FILENO) >= 0 && dup2(output, STDERR_FILENO) >= 0))
        /* execv() does not change argv; its type lacks const for historical reasons */
        execv(path, (char *const *)(uintptr_t)arguments);
    dprintf(STDERR_FILENO, "%s: cannot be started: %s\n", arguments[0], strerror(errno));
    _exit(EXIT_REFUSED);
}

/* Starts a program whose output goes to a descriptor (-1: the keeper's own). Returns its pid, or 0
 * if no process can be created now. Not by posix_spawn(), which waits until the child calls exec:
 * on a busy machine the watchdog would stand still meanwhile. */
static int start(const struct process_set *set, const char *program, const char *const *arguments,
                 int output)
{
    char path[300];
    snprintf(path, sizeof path, "%s/%s", set->folder, program);
    int keeper = (int)getpid();
    pid_t pid = fork();
    if (pid == 0)
        exec_child(path, arguments, output, keeper);
    if (pid < 0)
        process_set_log(set, "%s: cannot be started: %s", program, strerror(errno));
    return pid > 0 ? (int)pid : 0;
}

static void spawn(struct process_set *set, struct service *service, struct child *child,
                  bool stand_by)
{
    char program[32], parent[16];
    struct command_line line = {0};
    snprintf(program, sizeof program, "jolon-%s", role_name(service->role));
    snprintf(parent, sizeof parent, "%d", (int)getpid());
    add(&line, NULL, program);
    role_arguments(&line, set->plan, service->role);
    add(&line, "--world", set->plan->world);
    add(&line, "--parent", parent);
    if (stand_by)
        add(&line, "--stand-by", NULL);
    if (set->plan->sandbox_off)
        add(&line, "--no-sandbox", NULL);
    held_output_close(&service->held, set->log_fd, true);
    int held_back = service->refused[0] != '\0' ? held_output_open(&service->held) : -1;
    int output = held_back >= 0 ? held_back : set->log_fd;
    *child = (struct child){.pid = start(set, program, line.argument, output),
                            .spawned_ns = clock_now_ns(),
                            .frame_at_start = process_set_frame(set)};
    if (held_back >= 0)
        close(held_back);
}

void process_set_spawn(struct process_set *set, uint64_t now_ns)
{
    for (int i = 0; i < ROLE_COUNT; i++) {
        struct service *service = &set->service[i];
        for (int j = 0; j < service->wanted && now_ns >= service->spawn_at_ns; j++) {
            if (service->child[j].pid == 0)
                spawn(set, service, &service->child[j], service->wanted > 1);
            if (service->child[j].pid == 0)
                service->spawn_at_ns = now_ns + NS_PER_S;
        }
    }
}

void process_set_end_pauses(struct process_set *set)
{
    for (int i = 0; i < ROLE_COUNT; i++)
        set->service[i].spawn_at_ns = 0;
}

void process_set_pass_output(struct process_set *set)
{
    for (int i = 0; i < ROLE_COUNT; i++)
        held_output_read(&set->service[i].held, set->log_fd, process_set_ready(set, (enum role)i));
}

struct child *process_set_holder(struct process_set *set, enum role role)
{
    int pid = (int)atomic_load(&set->view.slot[role]->pid);
    for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
        if (pid != 0 && set->service[role].child[j].pid == pid)
            return &set->service[role].child[j];
    }
    return NULL;
}

bool process_set_ready(struct process_set *set, enum role role)
{
    return process_set_holder(set, role) && atomic_load(&set->view.slot[role]->state) == ROLE_READY;
}

bool process_set_has_live_child(const struct service *service)
{
    for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
        if (service->child[j].pid != 0 && service->child[j].stopped_ns == 0)
            return true;
    }
    return false;
}

struct service *process_set_find(struct process_set *set, int pid, struct child **child)
{
    for (int i = 0; i < ROLE_COUNT; i++) {
        for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
            *child = &set->service[i].child[j];
            if ((*child)->pid == pid)
                return &set->service[i];
        }
    }
    *child = NULL;
    return NULL;
}

/* --- ending ------------------------------------------------------------------------------------*/

int process_set_exit_status(int status)
{
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* Sends the signal repeatedly, as a child misses a signal that arrives just before it blocks. Waits
 * for its death at most until until_ns. Returns its exit status, -1 if it still lives. */
static int end(struct child *child, int signal_number, uint64_t until_ns)
{
    int status = 0;
    for (;;) {
        kill(child->pid, signal_number);
        kill(child->pid, SIGCONT);
        pid_t dead = waitpid(child->pid, &status, WNOHANG);
        if (dead == child->pid || (dead < 0 && errno == ECHILD)) {
            *child = (struct child){0};
            return process_set_exit_status(status);
        }
        uint64_t now = clock_now_ns();
        if (now >= until_ns)
            return -1;
        clock_sleep_until_ns(now + POLL_NS < until_ns ? now + POLL_NS : until_ns);
    }
}

void process_set_kill(struct process_set *set, enum role role)
{
    for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
        struct child *child = &set->service[role].child[j];
        if (child->pid != 0)
            (void)end(child, SIGKILL, UINT64_MAX);
    }
}

int process_set_stop(struct process_set *set, enum role role)
{
    struct service *service = &set->service[role];
    uint64_t until = clock_now_ns() + STOP_NS;
    int status = 0;
    service->wanted = 0;
    /* The stand-by process ends first; otherwise it would take the role. */
    for (int pass = 0; pass < 2; pass++) {
        for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
            struct child *child = &service->child[j];
            if (child->pid == 0 || (pass == 0 && process_set_holder(set, role) == child))
                continue;
            int pid = child->pid;
            status = end(child, SIGTERM, until);
            if (status >= 0)
                continue;
            process_set_log(set, "%s (pid %d) did not stop in %.0f s: killed", role_name(role), pid,
                            (double)STOP_NS / 1e9);
            status = end(child, SIGKILL, UINT64_MAX);
        }
    }
    held_output_close(&service->held, set->log_fd, true);
    return status;
}

/* Starts the role's process if there is none, and waits until it is ready, so that it handles a
 * request to stop. Returns its exit status if it died first, else -1. */
static int await_ready(struct process_set *set, struct service *service, uint64_t until_ns)
{
    struct child *child = &service->child[0];
    int status = -1;
    service->wanted = 1;
    service->spawn_at_ns = 0;
    while (status < 0 && clock_now_ns() < until_ns && !process_set_ready(set, service->role)) {
        uint64_t next = clock_now_ns() + POLL_NS;
        process_set_spawn(set, clock_now_ns());
        if (child->pid != 0)
            status = end(child, 0, next); /* signal 0 only checks whether it lives */
        else
            clock_sleep_until_ns(next);
    }
    return status;
}

int process_set_finish(struct process_set *set, enum role role)
{
    struct service *service = &set->service[role];
    uint64_t until = clock_now_ns() + FINISH_NS;
    int status;
    do {
        status = await_ready(set, service, until);
        if (service->child[0].pid != 0)
            status = process_set_stop(set, role);
        service->wanted = 0;
    } while (status != EXIT_OK && !restart_policy_refused(status) && clock_now_ns() < until);
    held_output_close(&service->held, set->log_fd, true);
    return status;
}

int process_set_run(const struct process_set *set, const char *program,
                    const char *const *arguments, bool to_log)
{
    int status = 0;
    int pid = start(set, program, arguments, to_log ? set->log_fd : -1);
    if (pid == 0)
        return EXIT_REFUSED;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR)
        continue;
    return process_set_exit_status(status);
}
