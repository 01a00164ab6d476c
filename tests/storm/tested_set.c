/* Starts, restarts and stops the set, and tells which processes belong to it. */
#include "tests/storm/tested_set.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#define START_LIMIT_S        60
#define START_TRIES          20
#define READY_WAIT_NS        (20 * (uint64_t)NS_PER_S)
#define HEARTBEAT_AGE_MAX_NS (100 * (uint64_t)NS_PER_MS)
#define EXIT_WAIT_NS         (3 * (uint64_t)NS_PER_S)
#define PARENTS_MAX          4
#define CHILDREN_MAX         64

extern char **environ;

/* --- processes ---------------------------------------------------------------------------------*/

static int parent_of(int pid)
{
    char path[64], line[512];
    int parent = 0;
    snprintf(path, sizeof path, "/proc/%d/stat", pid);
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    size_t length = fread(line, 1, sizeof line - 1, file);
    fclose(file);
    line[length] = '\0';
    const char *end = strrchr(line, ')'); /* line: pid (name) state parent */
    if (end && strlen(end) > 4)
        parent = (int)strtol(end + 4, NULL, 10);
    return parent;
}

static bool descends(int pid, int ancestor)
{
    for (int i = 0; i < PARENTS_MAX && pid > 1; i++) {
        pid = parent_of(pid);
        if (pid == ancestor)
            return true;
    }
    return false;
}

/* Returns a pidfd of the process, or -1 if it is dead or does not descend from the ancestor. The
 * kernel may give a pid to another process, but a pidfd stays with one process. So the descent is
 * verified while the pidfd is open, and the process must still be alive after that. */
static int open_verified(int pid, int ancestor)
{
    if (pid <= 1 || ancestor <= 0)
        return -1;
    int pidfd = (int)syscall(SYS_pidfd_open, pid, 0);
    if (pidfd < 0)
        return -1;
    char state = process_state(pid);
    if (descends(pid, ancestor) && state != 'Z' && state != 'X' && tested_set_signal(pidfd, 0))
        return pidfd;
    close(pidfd);
    return -1;
}

int tested_set_pidfd(const struct tested_set *set, int pid)
{
    return open_verified(pid, set->supervisor);
}

int tested_set_supervisor_pidfd(const struct tested_set *set)
{
    return open_verified(set->supervisor, (int)getpid());
}

bool tested_set_signal(int pidfd, int signal_number)
{
    return syscall(SYS_pidfd_send_signal, pidfd, signal_number, NULL, 0) == 0;
}

int tested_set_children(int pid, int *children, int max)
{
    char path[64];
    int count = 0;
    snprintf(path, sizeof path, "/proc/%d/task", pid);
    DIR *tasks = opendir(path);
    if (!tasks)
        return 0;
    for (struct dirent *entry = readdir(tasks); entry; entry = readdir(tasks)) {
        char list[128];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(list, sizeof list, "/proc/%d/task/%.16s/children", pid, entry->d_name);
        FILE *file = fopen(list, "r");
        while (file && count < max && fscanf(file, "%d", &children[count]) == 1)
            count++;
        if (file)
            fclose(file);
    }
    closedir(tasks);
    return count;
}

void tested_set_reap(void)
{
    while (waitpid(-1, NULL, WNOHANG) > 0)
        continue;
}

static int wait_for(pid_t pid, unsigned limit_s)
{
    uint64_t until = clock_now_ns() + limit_s * (uint64_t)NS_PER_S;
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
        if (clock_now_ns() > until) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            return -1;
        }
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Reads a file from its start as text and drops what exceeds bytes. */
static void read_back(int fd, char *text, size_t bytes)
{
    ssize_t length = pread(fd, text, bytes - 1, 0);
    text[length > 0 ? length : 0] = '\0';
}

int tested_set_run(const char *const *arguments, char *text, size_t bytes, unsigned limit_s)
{
    posix_spawn_file_actions_t actions;
    pid_t pid;
    int fd = memfd_create("output",
                          MFD_CLOEXEC); /* not a pipe, which a surviving child would keep open */
    if (fd < 0)
        return -1;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fd, STDOUT_FILENO);
    int failed = posix_spawn(&pid, arguments[0], &actions, NULL,
                             (char *const *)(uintptr_t)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    int code = failed == 0 ? wait_for(pid, limit_s) : -1;
    if (text)
        read_back(fd, text, bytes);
    close(fd);
    return code;
}

/* --- the set -----------------------------------------------------------------------------------*/

/* Returns the pid in the world's lock file, or 0 if it holds none. */
static int supervisor_of(const char *world)
{
    struct segment_paths paths;
    struct error_text error;
    int pid = 0;
    if (segment_paths(&paths, world, &error) != 0)
        return 0;
    FILE *file = fopen(paths.lock, "r");
    if (!file)
        return 0;
    if (fscanf(file, "%d", &pid) != 1)
        pid = 0;
    fclose(file);
    return pid;
}

static int start_once(const struct tested_set *set)
{
    const struct storm_options *options = set->options;
    char program[STORM_PATH_MAX], events[STORM_PATH_MAX];
    const char *arguments[24];
    int n = 0;
    snprintf(program, sizeof program, "%s/jolon", options->bin);
    snprintf(events, sizeof events, "%s/events.log", options->out);
    arguments[n++] = program;
    arguments[n++] = "start";
    arguments[n++] = "-w";
    arguments[n++] = options->world;
    arguments[n++] = "--out";
    arguments[n++] = options->out;
    arguments[n++] = "--events";
    arguments[n++] = events;
    if (!options->renderer) {
        arguments[n++] = "--without";
        arguments[n++] = "renderer";
    }
    if (options->commands == 0) {
        arguments[n++] = "--without";
        arguments[n++] = "reporter";
    }
    arguments[n++] = options->scenario;
    arguments[n] = NULL;
    char output[256];
    return tested_set_run(arguments, output, sizeof output, START_LIMIT_S);
}

/* Starts the set. A killed supervisor's processes may hold locks until the kernel has ended them,
 * so a refused start is tried again. */
static int start(struct tested_set *set, struct error_text *error)
{
    int code = 1;
    for (int tries = 0; tries < START_TRIES && code != 0 && !process_stopping(); tries++) {
        if (tries > 0) {
            set->starts_refused++;
            clock_sleep_until_ns(clock_now_ns() + 50 * (uint64_t)NS_PER_MS);
        }
        code = start_once(set);
    }
    if (code != 0)
        return error_text_set(error, "`jolon start` of world \"%s\" ended with %d, %d times",
                              set->options->world, code, START_TRIES);
    set->starts++;
    set->supervisor = supervisor_of(set->options->world);
    int pidfd = tested_set_supervisor_pidfd(set);
    if (pidfd < 0)
        return error_text_set(error,
                              "the supervisor of world \"%s\" (pid %d) is not alive or not ours",
                              set->options->world, (int)set->supervisor);
    close(pidfd);
    set->descriptors = 0;
    return 0;
}

int tested_set_start(struct tested_set *set, const struct storm_options *options,
                     struct error_text *error)
{
    *set = (struct tested_set){.options = options};
    if (start(set, error) != 0)
        return -1;
    if (segment_attach(&set->view, options->world, ROLE_NONE, error) != 0) {
        (void)tested_set_stop(set); /* it is a world of another build */
        return -1;
    }
    return 0;
}

int tested_set_restart(struct tested_set *set, struct error_text *error)
{
    return start(set, error);
}

int tested_set_stop(struct tested_set *set)
{
    char program[STORM_PATH_MAX];
    snprintf(program, sizeof program, "%s/jolon", set->options->bin);
    const char *arguments[] = {program, "stop", "-w", set->options->world, NULL};
    char output[256];
    int code = tested_set_run(arguments, output, sizeof output, START_LIMIT_S);
    set->supervisor = 0;
    return code;
}

static bool is_ready(const struct view *view, enum role role, uint64_t now)
{
    const struct role_slot *slot = view->slot[role];
    return atomic_load(&slot->state) == ROLE_READY &&
           now - atomic_load(&slot->beat_ns) < HEARTBEAT_AGE_MAX_NS;
}

/* Returns the first role that was there and is not ready, STRUCK_ROLES if there is none. */
static int not_ready(const struct view *view)
{
    uint64_t now = clock_now_ns();
    int role = 0;
    while (role < STRUCK_ROLES &&
           (atomic_load(&view->slot[role]->starts) == 0 || is_ready(view, (enum role)role, now)))
        role++;
    return role;
}

int tested_set_wait_ready(const struct tested_set *set, struct error_text *error)
{
    uint64_t until = clock_now_ns() + READY_WAIT_NS;
    for (;;) {
        int role = not_ready(&set->view);
        if (role == STRUCK_ROLES)
            return 0;
        uint64_t now = clock_now_ns();
        if (now > until || process_stopping()) {
            const struct role_slot *slot = set->view.slot[role];
            double age_s = 1e-9 * (double)(int64_t)(now - atomic_load(&slot->beat_ns));
            return error_text_set(
                error, "the %s (pid %d) is not ready again within %d s: it is %s, beat %.1f s ago",
                role_name((enum role)role), (int)atomic_load(&slot->pid),
                (int)(READY_WAIT_NS / NS_PER_S),
                role_state_name((enum role_state)atomic_load(&slot->state)), age_s);
        }
        clock_sleep_until_ns(now + 5 * (uint64_t)NS_PER_MS);
    }
}

void tested_set_count_descriptors(struct tested_set *set)
{
    char path[64];
    int count = 0;
    snprintf(path, sizeof path, "/proc/%d/fd", (int)set->supervisor);
    DIR *directory = opendir(path);
    if (!directory)
        return;
    while (readdir(directory))
        count++;
    closedir(directory);
    if (set->descriptors == 0)
        set->descriptors = count;
    else if (count - set->descriptors > set->descriptors_over)
        set->descriptors_over = count - set->descriptors;
}

/* --- what is left ------------------------------------------------------------------------------*/

int tested_set_processes_left(void)
{
    uint64_t until = clock_now_ns() + EXIT_WAIT_NS;
    int children[CHILDREN_MAX];
    for (;;) {
        tested_set_reap();
        int count = tested_set_children((int)getpid(), children, CHILDREN_MAX);
        if (count == 0 || clock_now_ns() > until)
            return count;
        clock_sleep_until_ns(clock_now_ns() + 10 * (uint64_t)NS_PER_MS);
    }
}

/* Counts the files of a folder that are called name, or name with a dot and more. */
static int files_of(const char *folder, const char *name)
{
    size_t length = strlen(name);
    int count = 0;
    DIR *directory = opendir(folder);
    if (!directory)
        return 0;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        count += strncmp(entry->d_name, name, length) == 0 &&
                 (entry->d_name[length] == '\0' || entry->d_name[length] == '.');
    closedir(directory);
    return count;
}

int tested_set_files_left(const struct storm_options *options)
{
    char folder[RUNTIME_FOLDER_MAX], object[64];
    struct error_text error;
    snprintf(object, sizeof object, "jolon.%u.%s", (unsigned)getuid(), options->world);
    return files_of("/dev/shm", object) +
           (runtime_folder(folder, &error) == 0 ? files_of(folder, options->world) : 0);
}
