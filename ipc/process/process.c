/* Start and end of a role's process. */
#include "ipc/process/process.h"

#include "ipc/process/log.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define BESIDE_NICENESS 5

static volatile sig_atomic_t stopping, stopped_by_parent;
static int parent; /* 0: none */

static void on_stop(int signal_number, siginfo_t *info, void *context)
{
    (void)signal_number;
    (void)context;
    if (parent == 0 || (info->si_code == SI_USER && info->si_pid == parent))
        stopped_by_parent = 1;
    stopping = 1;
}

/* Files that on_bus_error() removes. */
#define REMOVED_MAX  5
#define REMOVED_PATH 320 /* bytes, with the NUL */
static char removed[REMOVED_MAX][REMOVED_PATH];
static volatile sig_atomic_t removed_count;

/* Another mapped file, and what on_bus_error() says of it. */
static struct {
    const char *from;
    size_t bytes;
    char text[REMOVED_PATH + 128];
} told;

/* Ends the process when it touches a page that the object no longer has, because another process
 * made the object shorter. Any other bus error is a crash: the handler returns, the instruction
 * runs again without a handler, and the kernel ends the process. Runs within a role's sandbox, and
 * makes only system calls that each role may make. */
static void on_bus_error(int signal_number, siginfo_t *info, void *context)
{
    (void)signal_number;
    (void)context;
    if (info->si_code != BUS_ADRERR)
        return;
    for (int i = 0; i < removed_count; i++)
        unlink(removed[i]);
    const char *at = info->si_addr;
    die_at_once(told.from && at >= told.from && at < told.from + told.bytes
                    ? told.text
                    : "the world's memory went away: its object in /dev/shm was made shorter");
}

void process_guard_removes(const char *path)
{
    CHECK(removed_count < REMOVED_MAX && strlen(path) < REMOVED_PATH);
    snprintf(removed[removed_count], REMOVED_PATH, "%s", path);
    removed_count++;
}

void process_guard_tells(const void *from, size_t bytes, const char *text)
{
    told.from = NULL;
    snprintf(told.text, sizeof told.text, "%s", text);
    told.bytes = bytes;
    told.from = from;
}

static void check_stack(void)
{
    struct rlimit stack;
    if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < PROCESS_STACK_BYTES)
        die_refused("the stack is limited to %llu KB, and %u KB are needed: ulimit -s 8192",
                    (unsigned long long)stack.rlim_cur / 1024, PROCESS_STACK_BYTES / 1024);
}

void process_guard(void)
{
    check_stack();
    struct sigaction bus = {.sa_sigaction = on_bus_error,
                            .sa_flags = SA_SIGINFO | (int)SA_RESETHAND};
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    sigemptyset(&bus.sa_mask);
    sigemptyset(&ignore.sa_mask);
    sigaction(SIGBUS, &bus, NULL);
    sigaction(SIGXFSZ, &ignore, NULL);
}

void process_hold_stop(void)
{
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGTERM);
    sigaddset(&stop, SIGINT);
    sigaddset(&stop, SIGHUP);
    sigprocmask(SIG_BLOCK, &stop, NULL);
}

bool process_stopping(void)
{
    return stopping != 0;
}

bool process_stopped_by_parent(void)
{
    return stopped_by_parent != 0;
}

void process_signals(void)
{
    struct sigaction stop = {.sa_sigaction = on_stop,
                             .sa_flags = SA_SIGINFO}; /* no SA_RESTART: waits end early */
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    sigemptyset(&stop.sa_mask);
    sigemptyset(&ignore.sa_mask);
    sigaction(SIGTERM, &stop, NULL);
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGHUP, &stop, NULL);
    sigaction(SIGPIPE, &ignore, NULL);
    process_guard();
}

bool process_colours(void)
{
    const char *no_color = getenv("NO_COLOR");
    return no_color == NULL || no_color[0] == '\0';
}

void process_close_inherited(void)
{
    (void)close_range(STDERR_FILENO + 1, ~0u, 0); /* a kernel without it leaves them open */
}

void process_die_with_parent(int parent_pid)
{
    if (parent_pid <= 0)
        return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent_pid) /* the parent died before prctl() */
        _exit(0);
}

static int started_niceness;

static void note_niceness(void)
{
    started_niceness = getpriority(PRIO_PROCESS, 0);
}

/* The niceness at the start is noted once: a thread within a sandbox may not read it. */
int process_lower_priority(int steps)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, note_niceness);
    return setpriority(PRIO_PROCESS, 0, started_niceness + steps);
}

void process_begin(int parent_pid)
{
    process_close_inherited();
    parent = parent_pid;
    process_signals();
    process_die_with_parent(parent_pid);
}

void process_begin_beside(int parent_pid)
{
    process_begin(parent_pid);
    if (process_lower_priority(BESIDE_NICENESS) != 0)
        log_warn("runs at normal priority: nice %d not allowed", BESIDE_NICENESS);
}

char process_state(int pid)
{
    char path[64], line[512];
    snprintf(path, sizeof path, "/proc/%d/stat", pid);
    FILE *file = fopen(path, "r");
    if (!file)
        return '\0';
    size_t length = fread(line, 1, sizeof line - 1, file);
    fclose(file);
    line[length] = '\0';
    /* The line is "pid (name) state ...", and the name may hold parentheses. */
    const char *end = strrchr(line, ')');
    return end && end[1] == ' ' ? end[2] : '\0';
}

bool process_has_ended(int pid)
{
    if (kill(pid, 0) != 0 && errno == ESRCH)
        return true;
    char state = process_state(pid);
    return state == 'Z' || state == 'X';
}

static bool holds_kinds(const char *directory)
{
    char path[512];
    struct stat status;
    int length = snprintf(path, sizeof path, "%s/kinds", directory);
    return length > 0 && length < (int)sizeof path && stat(path, &status) == 0 &&
           S_ISDIR(status.st_mode);
}

int process_data_dir(char *path, size_t bytes)
{
    /* For a program in build/bin, in build/san-.../bin and in PREFIX/bin. */
    static const char *const places[] = {"../../config", "../../../config", "../share/jolon"};
    char self[400];
    const char *given = getenv("JOLON_DATA");
    if (given) {
        snprintf(path, bytes, "%s", given);
        return holds_kinds(path) ? 0 : -1;
    }
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        return -1;
    self[length] = '\0';
    char *slash = strrchr(self, '/');
    if (!slash)
        return -1;
    *slash = '\0';
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        snprintf(path, bytes, "%s/%s", self, places[i]);
        if (holds_kinds(path))
            return 0;
    }
    errno = ENOENT;
    return -1;
}
