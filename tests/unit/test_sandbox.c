/* Each role's sandbox is tried by doing what it forbids: the kernel must end the process, which
 * must have said why; and by doing what the role needs. */
#include "sandbox/sandbox.h"

#include "ipc/log.h"
#include "ipc/process.h"
#include "tests/support/child.h"
#include "tests/support/named_world.h"
#include "world/workers.h"

#include <dds/ddsrt/threads.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <sched.h>
#include <seccomp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#define NOT_ENTERED 77 /* exit code of a child whose sandbox the kernel refused */

/* Sets of roles, for the table. */
enum {
    M = 1 << ROLE_MOVER,
    C = 1 << ROLE_COLLIDER,
    I = 1 << ROLE_INTAKE,
    P = 1 << ROLE_REPORTER,
    D = 1 << ROLE_RECORDER,
    W = 1 << ROLE_CONSOLE
};
#define R    (1 << ROLE_RENDERER | 1 << ROLE_RENDERER_2 | 1 << ROLE_RENDERER_3 | 1 << ROLE_RENDERER_4)
#define NONE 0
#define ALL  (M | C | I | P | D | R | W)

static char folder[] = "/tmp/jolon-sandbox-XXXXXX";
static char said[512]; /* by the last child, on standard error */
static struct reason reason;

/* --- what is tried; the result does not matter, only whether it may be asked
 * --------------------*/

static void *nothing(void *argument)
{
    return argument;
}

static void new_thread(void)
{
    pthread_t thread;
    if (pthread_create(&thread, NULL, nothing, NULL) == 0)
        pthread_join(thread, NULL);
}

static void new_process(void)
{
    if (syscall(SYS_clone, SIGCHLD, NULL, NULL, NULL, 0) == 0)
        _exit(0);
}

static void new_process_fork(void)
{
    if (syscall(SYS_fork) == 0)
        _exit(0);
}

/* Its flags are out of a filter's sight, so there is none. */
static void new_process_clone3(void)
{
    if (syscall(SYS_clone3, NULL, 0) != -1 || errno != ENOSYS)
        syscall(SYS_fork);
}

/* Not done, but nobody dies of it. */
static void waived(long result)
{
    if (result != -1 || errno != EPERM)
        syscall(SYS_fork);
}

static void run_program(void)
{
    char path[] = "/bin/true";
    char *const arguments[] = {path, NULL};
    execve(path, arguments, environ);
}

static void run_descriptor(void)
{
    char name[] = "true";
    char *const arguments[] = {name, NULL};
    syscall(SYS_execveat, AT_FDCWD, "/bin/true", arguments, environ, 0);
}

static void map(int protection, int flags, int fd)
{
    void *at = mmap(NULL, 4096, protection, flags, fd, 0);
    if (at != MAP_FAILED)
        munmap(at, 4096);
}

static void make_executable(void)
{
    void *at = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    mprotect(at, 4096, PROT_READ | PROT_EXEC);
}

static void write_protect(void)
{
    void *at = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    mprotect(at, 4096, PROT_READ);
}

static void use_memory(void)
{
    for (size_t bytes = 1; bytes < 64u << 20; bytes *= 3) {
        unsigned char *volatile block = malloc(bytes);
        if (block)
            block[bytes - 1] = 1;
        block = realloc(block, bytes * 2);
        free(block);
    }
}

static void sleep_shortly(void)
{
    const struct timespec moment = {.tv_nsec = 1000};
    clock_nanosleep(CLOCK_MONOTONIC, 0, &moment, NULL);
}

static void say(int fd)
{
    ssize_t written = write(fd, "said\n", 5);
    (void)written;
}

static void hear(int fd)
{
    char byte;
    ssize_t got = read(fd, &byte, 1);
    (void)got;
}

static void handle(int signal_number)
{
    struct sigaction action = {.sa_handler = SIG_IGN};
    sigaction(signal_number, &action, NULL);
}

/* --- the table
 * ----------------------------------------------------------------------------------*/

/* An attempt: the system call that is said to be forbidden, who may, and what does it. Nothing is
 * said where signals are blocked: by a thread that makes another. */
#define ATTEMPTS(X)                                                                                \
    X("open", NONE, syscall(SYS_open, "/etc/passwd", O_RDONLY))                                    \
    X("openat", R | D | W, open("/etc/passwd", O_RDONLY | O_CLOEXEC))                              \
    X("openat", R | D | W, open("/dev/shm", O_RDONLY | O_CLOEXEC))                                 \
    X("unlink", R | D, unlink("/tmp/jolon-no-such-file"))                                          \
    X("rename", R | D, rename("/tmp/jolon-no-such-file", "/tmp/jolon-no-other"))                   \
    X("mkdir", R, mkdir("/etc/passwd", 0700))                                                      \
    X("rmdir", NONE, rmdir("/tmp/jolon-no-such-file"))                                             \
    X("symlink", NONE, symlink("/etc/passwd", "/etc/passwd"))                                      \
    X("mknod", NONE, mknod("/etc/passwd", S_IFIFO, 0))                                             \
    X("chmod", NONE, chmod("/tmp/jolon-no-such-file", 0777))                                       \
    X("chown", NONE, syscall(SYS_chown, "/tmp/jolon-no-such-file", 0, 0))                          \
    X("truncate", NONE, syscall(SYS_truncate, "/tmp/jolon-no-such-file", 0))                       \
    X("getdents64", R | D, syscall(SYS_getdents64, -1, NULL, 0))                                   \
    X("read", W | P | R | D, hear(-1))                                                             \
    X("write", W | P | R | D, say(-1))                                                             \
    X("dup", NONE, syscall(SYS_dup, 2))                                                            \
    X("dup2", NONE, syscall(SYS_dup2, 2, 9))                                                       \
    X("fcntl", NONE, fcntl(2, F_SETFL, 0))                                                         \
    X("openat", R | D | W | P, open("/", O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC))           \
    X("readlink", W, readlink("/", said, 1))                                                       \
    X("fcntl", R, fcntl(-1, F_DUPFD_CLOEXEC, 0))                                                   \
    X("socket", P, socket(AF_INET, SOCK_DGRAM, 0))                                                 \
    X("socket", P, socket(AF_INET6, SOCK_STREAM, 0))                                               \
    X("socket", W | P, socket(AF_UNIX, SOCK_STREAM, 0))                                            \
    X("socket", NONE, socket(AF_NETLINK, SOCK_RAW, 0))                                             \
    X("socket", NONE, socket(AF_PACKET, SOCK_RAW, 0))                                              \
    X("connect", W | P, connect(-1, NULL, 0))                                                      \
    X("bind", P, bind(-1, NULL, 0))                                                                \
    X("listen", P, listen(-1, 1))                                                                  \
    X("accept", NONE, syscall(SYS_accept, -1, NULL, NULL))                                         \
    X("accept4", W | P | R | I, accept4(-1, NULL, NULL, 0))                                        \
    X("sendto", W | P | R | I, sendto(-1, "", 0, 0, NULL, 0))                                      \
    X("sendmsg", W | P | R | I, sendmsg(-1, NULL, 0))                                              \
    X("recvfrom", W | P | R | I, recvfrom(-1, NULL, 0, 0, NULL, NULL))                             \
    X("shutdown", W | R | I, shutdown(-1, SHUT_WR))                                                \
    X("setsockopt", W | P | R | I, setsockopt(-1, IPPROTO_TCP, TCP_NODELAY, NULL, 0))              \
    X("getsockopt", W | P | R | I, getsockopt(-1, SOL_SOCKET, SO_PEERCRED, NULL, NULL))            \
    X("getsockopt", P, getsockopt(-1, SOL_SOCKET, SO_ERROR, NULL, NULL))                           \
    X("setsockopt", P, setsockopt(-1, SOL_SOCKET, SO_BINDTODEVICE, NULL, 0))                       \
    X("sysinfo", P | R, syscall(SYS_sysinfo, said))                                                \
    X("execve", NONE, run_program())                                                               \
    X("execveat", NONE, run_descriptor())                                                          \
    X("fork", NONE, new_process_fork())                                                            \
    X("clone", NONE, new_process())                                                                \
    X("clone3", ALL, new_process_clone3())                                                         \
    X("", W | P | R, new_thread())                                                                 \
    X("ptrace", NONE, ptrace(PTRACE_TRACEME, 0, NULL, NULL))                                       \
    X("process_vm_readv", NONE, syscall(SYS_process_vm_readv, 1, NULL, 0, NULL, 0, 0))             \
    X("process_vm_writev", NONE, syscall(SYS_process_vm_writev, 1, NULL, 0, NULL, 0, 0))           \
    X("kill", NONE, kill(0, 0))                                                                    \
    X("tgkill", NONE, syscall(SYS_tgkill, 1, 1, SIGABRT))                                          \
    X("tgkill", NONE, syscall(SYS_tgkill, getpid(), getpid(), SIGKILL))                            \
    X("tkill", NONE, syscall(SYS_tkill, 1, 0))                                                     \
    X("rt_sigqueueinfo", NONE, syscall(SYS_rt_sigqueueinfo, 1, SIGTERM, NULL))                     \
    X("pidfd_open", W, syscall(SYS_pidfd_open, 1, 0))                                              \
    X("pidfd_send_signal", W, syscall(SYS_pidfd_send_signal, -1, SIGKILL, NULL, 0))                \
    X("pidfd_send_signal", NONE, syscall(SYS_pidfd_send_signal, -1, SIGSTOP, NULL, 0))             \
    X("mmap", R, map(PROT_READ | PROT_WRITE, MAP_SHARED, 2))                                       \
    X("uname", P, syscall(SYS_uname, said))                                                        \
    X("getrandom", W | P, syscall(SYS_getrandom, said, 1, 0))                                      \
    X("rt_sigaction", NONE, handle(SIGSYS))                                                        \
    X("rt_sigaction", NONE, handle(SIGSEGV))                                                       \
    X("rt_sigaction", ALL, handle(SIGABRT))                                                        \
    X("rt_sigaction", P, handle(SIGALRM))                                                          \
    X("mmap", R, map(PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1))                      \
    X("mmap", R | W, map(PROT_READ, MAP_SHARED, 2))                                                \
    X("mmap", R | W, map(PROT_READ, MAP_PRIVATE, 2))                                               \
    X("mmap", R | W, map(PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1))                               \
    X("mprotect", W | P | I | R | D, write_protect())                                              \
    X("mprotect", R, make_executable())                                                            \
    X("pkey_mprotect", NONE, syscall(SYS_pkey_mprotect, NULL, 4096, PROT_EXEC, -1))                \
    X("remap_file_pages", NONE, syscall(SYS_remap_file_pages, NULL, 0, 0, 0, 0))                   \
    X("memfd_create", NONE, syscall(SYS_memfd_create, "m", 0))                                     \
    X("shmget", NONE, syscall(SYS_shmget, 0, 4096, 0600))                                          \
    X("personality", NONE, syscall(SYS_personality, 0x0400000))                                    \
    X("prctl", NONE, prctl(PR_SET_DUMPABLE, 1))                                                    \
    X("prctl", W | P | R, prctl(PR_SET_NAME, "name"))                                              \
    X("prctl", W | P | R, prctl(PR_GET_NAME, said))                                                \
    X("setuid", NONE, syscall(SYS_setuid, 0))                                                      \
    X("capset", NONE, syscall(SYS_capset, NULL, NULL))                                             \
    X("seccomp", NONE, syscall(SYS_seccomp, 1, 0, NULL))                                           \
    X("unshare", NONE, unshare(CLONE_NEWUSER))                                                     \
    X("setns", NONE, setns(-1, 0))                                                                 \
    X("mount", NONE, syscall(SYS_mount, "", "", "", 0, NULL))                                      \
    X("chroot", NONE, syscall(SYS_chroot, "/"))                                                    \
    X("bpf", NONE, syscall(SYS_bpf, 0, NULL, 0))                                                   \
    X("perf_event_open", NONE, syscall(SYS_perf_event_open, NULL, 0, -1, -1, 0))                   \
    X("userfaultfd", NONE, syscall(SYS_userfaultfd, 0))                                            \
    X("io_uring_setup", NONE, syscall(SYS_io_uring_setup, 1, NULL))                                \
    X("keyctl", NONE, syscall(SYS_keyctl, 0, 0, 0, 0, 0))                                          \
    X("init_module", NONE, syscall(SYS_init_module, NULL, 0, ""))                                  \
    X("ioctl", NONE, ioctl(2, TIOCSTI, "x"))                                                       \
    X("setpriority", R, waived(syscall(SYS_setpriority, 0, 0, 19)))                                \
    X("sched_setscheduler", R, waived(syscall(SYS_sched_setscheduler, 0, SCHED_BATCH, NULL)))      \
    X("sched_setaffinity", R, waived(syscall(SYS_sched_setaffinity, 0, 0, NULL)))                  \
    X("prlimit64", NONE, syscall(SYS_prlimit64, 0, 0, NULL, NULL))                                 \
    X("", ALL, say(STDERR_FILENO))                                                                 \
    X("mremap", W | P | I | R | D, use_memory())                                                   \
    X("", ALL, sleep_shortly())                                                                    \
    X("", ALL, close(0))

#define X(call, allowed, action) {call, #action, allowed},
static const struct {
    const char *call, *action;
    unsigned allowed;
} attempts[] = {ATTEMPTS(X)};
#undef X
#define ATTEMPT_COUNT ((int)(sizeof attempts / sizeof attempts[0]))

static void attempt(int wanted)
{
    int number = 0;
#define X(call, allowed, action)                                                                   \
    if (number++ == wanted)                                                                        \
        (void)(action);
    ATTEMPTS(X)
#undef X
}

/* --- children
 * -----------------------------------------------------------------------------------*/

static int enter(int role)
{
    struct sandbox sandbox;
    if (sandbox_begin(&sandbox, (enum role)role, false, &reason) == 0) {
        if (sandbox_enter(&sandbox, &reason) == 0)
            return sandbox.on ? 0 : NOT_ENTERED;
    }
    fprintf(stderr, "%s\n", reason.text);
    return NOT_ENTERED;
}

/* Runs a body as child_run() does, and keeps what it says. */
static int run(int (*body)(void *context), void *context)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    int before = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 10);
    assert_true(dup2(fileno(file), STDERR_FILENO) >= 0);
    pid_t pid = child_start(body, context);
    dup2(before, STDERR_FILENO);
    close(before);
    int status = child_wait(pid);
    rewind(file);
    said[fread(said, 1, sizeof said - 1, file)] = '\0';
    fclose(file);
    int result = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (result == NOT_ENTERED)
        fail_msg("the sandbox is not entered: %s", said);
    return result;
}

struct trial {
    int role;
    int attempt;
};

static int try_it(void *context)
{
    const struct trial *trial = context;
    new_thread(); /* the C library prepares itself for threads with the first */
    int result = enter(trial->role);
    if (result == 0)
        attempt(trial->attempt);
    return result;
}

static void check_trial(int role, int number)
{
    struct trial trial = {role, number};
    bool allowed = attempts[number].allowed & 1u << role;
    char wanted[128];
    int result = run(try_it, &trial);
    if (result != (allowed ? 0 : -SIGSYS))
        fail_msg("%s by the %s: %d, should be %s; it said: %s", attempts[number].action,
                 role_name((enum role)role), result, allowed ? "allowed" : "forbidden", said);
    if (allowed || attempts[number].call[0] == '\0')
        return;
    snprintf(wanted, sizeof wanted, "jolon-%s: the sandbox forbids system call ",
             role_name((enum role)role));
    const char *name = strchr(said, '(');
    if (strncmp(said, wanted, strlen(wanted)) != 0 || !name ||
        strncmp(name + 1, attempts[number].call, strlen(attempts[number].call)) != 0)
        fail_msg("%s by the %s: said \"%s\", not (%s)", attempts[number].action,
                 role_name((enum role)role), said, attempts[number].call);
}

static void test_each_role_may_do_what_it_needs_and_nothing_else(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        for (int i = 0; i < ATTEMPT_COUNT; i++)
            check_trial(role, i);
    }
}

/* --- all threads, for good
 * ----------------------------------------------------------------------*/

static _Atomic int entered;

static void *open_when_entered(void *argument)
{
    while (!entered)
        continue; /* without a system call: the filter may be there before entered is set */
    attempt(0);
    return argument;
}

static int confine_older_thread(void *context)
{
    pthread_t thread;
    (void)context;
    struct sandbox sandbox;
    if (sandbox_begin(&sandbox, ROLE_MOVER, false, &reason) != 0 ||
        pthread_create(&thread, NULL, open_when_entered, NULL) != 0 ||
        sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    entered = 1;
    pthread_join(thread, NULL);
    return 1;
}

static void test_a_thread_made_before_is_confined_too(void **state)
{
    (void)state;
    assert_int_equal(run(confine_older_thread, NULL), -SIGSYS);
}

/* The ways to block every signal: the C library's functions, and none of them. */
static int block_and_open(void *context)
{
    const int *way = context;
    sigset_t all;
    int result = enter(ROLE_MOVER);
    sigfillset(&all);
    if (*way == 0)
        sigprocmask(SIG_BLOCK, &all, NULL);
    else if (*way == 1)
        pthread_sigmask(SIG_SETMASK, &all, NULL);
    else
        syscall(SYS_rt_sigprocmask, SIG_BLOCK, &all, NULL, 8);
    attempt(0);
    return result;
}

static void test_blocking_the_signal_does_not_help(void **state)
{
    (void)state;
    for (int way = 0; way < 3; way++) {
        assert_int_equal(run(block_and_open, &way), -SIGSYS);
        if (!strstr(said, "forbids system call") != (way == 2))
            fail_msg("way %d to block all signals: it said \"%s\"", way, said);
    }
}

static uint32_t open_in_dds_thread(void *argument)
{
    (void)open_when_entered(argument);
    return 0;
}

/* Cyclone DDS blocks every signal in the threads that it makes. */
static int make_dds_thread(void *context)
{
    struct sandbox sandbox;
    ddsrt_thread_t thread;
    ddsrt_threadattr_t attributes;
    (void)context;
    ddsrt_threadattr_init(&attributes);
    if (sandbox_begin(&sandbox, ROLE_REPORTER, false, &reason) != 0 ||
        ddsrt_thread_create(&thread, "dds", &attributes, open_in_dds_thread, NULL) != 0 ||
        sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    entered = 1;
    ddsrt_thread_join(thread, NULL);
    return 1;
}

static void test_a_thread_of_dds_says_why_it_ends(void **state)
{
    (void)state;
    assert_int_equal(run(make_dds_thread, NULL), -SIGSYS);
    if (!strstr(said, "jolon-reporter: the sandbox forbids system call 2 (open)\n"))
        fail_msg("it said \"%s\"", said);
}

static void allocate_row(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    void **blocks = context;
    (void)worker;
    for (uint32_t i = first; i < end; i++)
        blocks[i] = malloc(100000);
}

/* Threads whose first allocation comes after it: glibc makes them arenas. */
static int work_inside(void *context)
{
    void *blocks[4096];
    struct sandbox sandbox;
    struct workers *workers;
    (void)context;
    if (sandbox_begin(&sandbox, ROLE_COLLIDER, false, &reason) != 0 ||
        !(workers = workers_create(WORKERS_MAX)) || sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    for (int turn = 0; turn < 20; turn++) {
        workers_run(workers, allocate_row, blocks, 4096, 16);
        for (int i = 0; i < 4096; i++)
            free(blocks[i]);
    }
    workers_destroy(workers);
    return 0;
}

static void test_workers_allocate_and_end_inside(void **state)
{
    (void)state;
    if (run(work_inside, NULL) != 0)
        fail_msg("%s", said);
}

/* --- ends that are not the sandbox's
 * ------------------------------------------------------------*/

static int fail_a_check(void *context)
{
    (void)context;
    if (enter(ROLE_COLLIDER) != 0)
        return NOT_ENTERED;
    CHECK(context != NULL);
    return 0;
}

static int free_twice(void *context)
{
    (void)context;
    void *volatile block = malloc(100000);
    void *volatile again = block;
    if (enter(ROLE_COLLIDER) != 0)
        return NOT_ENTERED;
    free(block);
    free(again);
    return 0;
}

static int fault(void *context)
{
    (void)context;
    if (enter(ROLE_MOVER) != 0)
        return NOT_ENTERED;
    volatile char *page = mmap(NULL, 4096, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    *page = 1;
    return 0;
}

static int refuse(void *context)
{
    (void)context;
    if (enter(ROLE_MOVER) != 0)
        return NOT_ENTERED;
    die_refused("out of patience");
}

static void test_crashes_stay_what_they_are(void **state)
{
    (void)state;
    assert_int_equal(run(fail_a_check, NULL), -SIGABRT);
    assert_non_null(strstr(said, "bug: context != NULL"));
    assert_int_equal(run(free_twice, NULL), -SIGABRT);
    assert_null(strstr(said, "sandbox"));
    assert_int_equal(run(fault, NULL), -SIGSEGV);
    assert_int_equal(run(refuse, NULL), EXIT_REFUSED);
    assert_non_null(strstr(said, "out of patience"));
}

static int sleep_inside(void *context)
{
    const struct timespec second = {.tv_sec = 1};
    (void)context;
    int result = enter(ROLE_MOVER);
    clock_nanosleep(CLOCK_MONOTONIC, 0, &second, NULL);
    return result;
}

/* The kernel lets a wait go on by a system call of its own (restart_syscall). */
static void test_a_wait_goes_on_after_stop_and_continue(void **state)
{
    (void)state;
    pid_t pid = child_start(sleep_inside, NULL);
    while (process_state(pid) == 'R')
        sched_yield();
    kill(pid, SIGSTOP);
    while (process_state(pid) != 'T' && process_state(pid) != 'Z')
        sched_yield();
    kill(pid, SIGCONT);
    assert_int_equal(child_wait(pid), 0);
}

/* --- files
 * --------------------------------------------------------------------------------------*/

/* What a role of files finds outside and inside its folder; the number of the first that is wrong.
 */
static int touch_files(void *context)
{
    const enum role *role = context;
    struct sandbox sandbox;
    char outside[] = "/tmp/jolon-sandbox-outside";
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (sandbox_begin(&sandbox, *role, false, &reason) != 0 ||
        sandbox_files(&sandbox, &fd, 1, &reason) != 0 || sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    int file = openat(fd, "inside", O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, 10) != 0)
        return 1;
    if (renameat(fd, "inside", fd, "renamed") != 0 || unlinkat(fd, "renamed", 0) != 0)
        return 2;
    if (open(outside, O_RDWR | O_CREAT | O_CLOEXEC, 0600) >= 0 || errno != EACCES)
        return 3;
    if (open("/etc/passwd", O_RDWR | O_CLOEXEC) >= 0 || errno != EACCES)
        return 4;
    if (open("/dev/shm", O_RDONLY | O_CLOEXEC) >= 0 || errno != EACCES)
        return 5;
    if ((open("/usr/bin/env", O_RDONLY | O_CLOEXEC) >= 0) != (*role == ROLE_RENDERER))
        return 6;
    if (open("/proc/1/environ", O_RDONLY | O_CLOEXEC) >= 0)
        return 7;
    return 0;
}

static void test_files_only_beneath_the_folder(void **state)
{
    enum role roles[] = {ROLE_RECORDER, ROLE_RENDERER};
    (void)state;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) < 0)
        skip(); /* this kernel has no Landlock; the role says so */
    for (size_t i = 0; i < 2; i++) {
        int result = run(touch_files, &roles[i]);
        if (result != 0)
            fail_msg("%s: %d: %s", role_name(roles[i]), result, said);
    }
}

/* A world of its own, and who attaches to it. */
struct loss {
    enum role role;
    char name[SEGMENT_NAME_MAX];
    struct segment_paths paths;
};

/* The console reads worlds, and writes and makes nothing anywhere. */
static int look_at_worlds(void *context)
{
    const char *shm = context;
    struct sandbox sandbox;
    if (sandbox_begin(&sandbox, ROLE_CONSOLE, false, &reason) != 0 ||
        sandbox_files(&sandbox, NULL, 0, &reason) != 0 || sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    if (open(shm, O_RDONLY | O_CLOEXEC) < 0)
        return 1;
    if (open(shm, O_RDWR | O_CLOEXEC) >= 0 || errno != EACCES)
        return 2;
    if (open("/dev/shm/jolon-none", O_RDWR | O_CREAT | O_CLOEXEC, 0600) >= 0 || errno != EACCES)
        return 3;
    if (open(folder, O_RDONLY | O_CLOEXEC) >= 0 || errno != EACCES)
        return 4;
    return 0;
}

static void test_a_console_only_reads_worlds(void **state)
{
    struct loss world;
    (void)state;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) < 0)
        skip(); /* this kernel has no Landlock; the console says so */
    named_world_make(world.name, "vehicles = ();");
    named_world_paths(&world.paths, world.name);
    int result = run(look_at_worlds, world.paths.object);
    named_world_remove(world.name);
    if (result != 0)
        fail_msg("%d: %s", result, said);
}

/* --- the keeper, and what it hands down
 * -----------------------------------------------------------*/

/* What fails with EPERM in the keeper and all that it starts; without the filter each of these
 * would do something, or fail with another error, also for a user without privileges. */
#define DENIED(X)                                                                                  \
    X(ptrace(PTRACE_TRACEME, 0, NULL, NULL))                                                       \
    X(syscall(SYS_process_vm_readv, getpid(), NULL, 0, NULL, 0, 0))                                \
    X(syscall(SYS_process_vm_writev, getpid(), NULL, 0, NULL, 0, 0))                               \
    X(syscall(SYS_pidfd_getfd, -1, 0, 0))                                                          \
    X(syscall(SYS_perf_event_open, NULL, 0, -1, -1, 0))                                            \
    X(syscall(SYS_userfaultfd, 1 << 30))                                                           \
    X(syscall(SYS_kcmp, getpid(), getpid(), 0, 0, 0))                                              \
    X(ioctl(-1, TIOCSTI, "x"))                                                                     \
    X(setuid(getuid()))                                                                            \
    X(setgid(getgid()))                                                                            \
    X(syscall(SYS_setgroups, -1, NULL))                                                            \
    X(fchown(-1, getuid(), getgid()))                                                              \
    X(unshare(CLONE_NEWUSER))                                                                      \
    X(unshare(0))                                                                                  \
    X(setns(-1, 0))                                                                                \
    X(syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, NULL, NULL, NULL, 0))                            \
    X(syscall(SYS_clone, CLONE_NEWNET | SIGCHLD, NULL, NULL, NULL, 0))                             \
    X(syscall(SYS_mount, NULL, NULL, NULL, 0, NULL))                                               \
    X(syscall(SYS_open_tree, -1, "none", 0))                                                       \
    X(chroot("none"))                                                                              \
    X(mknod("none/none", S_IFIFO, 0))                                                              \
    X(syscall(SYS_bpf, -1, NULL, 0))                                                               \
    X(syscall(SYS_io_uring_setup, 0, NULL))                                                        \
    X(syscall(SYS_keyctl, -1, 0, 0, 0, 0))                                                         \
    X(syscall(SYS_init_module, NULL, 0, NULL))                                                     \
    X(syscall(SYS_kexec_load, 0, 0, NULL, 0))                                                      \
    X(syscall(SYS_reboot, 0, 0, 0, NULL))                                                          \
    X(syscall(SYS_personality, 0xffffffff))                                                        \
    X(syscall(SYS_open_by_handle_at, -1, NULL, 0))

/* The number of the first that is not refused. */
static int try_denied(void)
{
    int number = 0;
#define X(action)                                                                                  \
    number++;                                                                                      \
    errno = 0;                                                                                     \
    if ((action) != -1 || errno != EPERM)                                                          \
        return number;
    DENIED(X)
#undef X
    return 0;
}

static int enter_as_keeper(void)
{
    const char *folders[] = {folder, "/none"};
    if (sandbox_keeper(folders, 2, &reason) == 0)
        return 0;
    fprintf(stderr, "%s\n", reason.text);
    return NOT_ENTERED;
}

static int keep(void *context)
{
    int *status = context;
    pid_t parent = getppid();
    if (enter_as_keeper() != 0)
        return NOT_ENTERED;
    int first = try_denied();
    if (first != 0)
        return first;
    pid_t pid = fork(); /* what it starts is confined as well */
    if (pid == 0)
        _exit(try_denied() == 0 ? 0 : 1);
    if (pid < 0 || waitpid(pid, status, 0) != pid || *status != 0)
        return 101;
    pid = fork();
    if (pid == 0)
        run_program();
    if (pid < 0 || waitpid(pid, status, 0) != pid || *status != 0)
        return 102;
    if (prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 1 || prctl(PR_CAPBSET_READ, 0) == 1)
        return 103;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) >= 6 &&
        (kill(parent, 0) == 0 || errno != EPERM))
        return 104;
    return 0;
}

static void test_the_keeper_and_what_it_starts_may_not_do_everything(void **state)
{
    int status = 0;
    (void)state;
    int result = run(keep, &status);
    if (result != 0)
        fail_msg("%d: %s", result, said);
}

static int touch_as_keeper(void *context)
{
    (void)context;
    if (enter_as_keeper() != 0)
        return NOT_ENTERED;
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    int file = openat(fd, "inside", O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, 10) != 0 || renameat(fd, "inside", fd, "renamed") != 0 ||
        unlinkat(fd, "renamed", 0) != 0)
        return 1;
    if (open("/tmp/jolon-sandbox-outside", O_RDWR | O_CREAT | O_CLOEXEC, 0600) >= 0 ||
        errno != EACCES)
        return 2;
    if (open("/etc/passwd", O_RDWR | O_CLOEXEC) >= 0 || errno != EACCES)
        return 3;
    if (open("/usr/bin/env", O_RDONLY | O_CLOEXEC) < 0)
        return 4;
    return mkdir("/tmp/jolon-sandbox-none", 0700) == 0 || errno != EACCES ? 5 : 0;
}

static void test_the_keeper_writes_only_beneath_its_folders(void **state)
{
    (void)state;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) < 0)
        skip(); /* this kernel has no Landlock; the keeper says so */
    int result = run(touch_as_keeper, NULL);
    if (result != 0)
        fail_msg("%d: %s", result, said);
}

/* A role's own sandbox lies over what it has inherited. */
static int enter_beneath_keeper(void *context)
{
    const enum role *role = context;
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    struct sandbox sandbox;
    if (enter_as_keeper() != 0 || sandbox_begin(&sandbox, *role, false, &reason) != 0 ||
        sandbox_files(&sandbox, &fd, 1, &reason) != 0 || sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    use_memory();
    attempt(0);
    return 0;
}

static void test_every_role_enters_its_sandbox_beneath_the_keepers(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        enum role entered_role = (enum role)role;
        int result = run(enter_beneath_keeper, &entered_role);
        if (result != -SIGSYS || !strstr(said, "forbids system call"))
            fail_msg("%s: %d: %s", role_name(entered_role), result, said);
    }
}

/* --- the world's memory taken away
 * --------------------------------------------------------------*/

static int lose_memory(void *context)
{
    const struct loss *loss = context;
    struct sandbox sandbox;
    struct view view;
    process_guard();
    if (segment_attach(&view, loss->name, loss->role, &reason) != 0 ||
        sandbox_begin(&sandbox, loss->role, false, &reason) != 0 ||
        truncate(loss->paths.object, 0) != 0 || sandbox_enter(&sandbox, &reason) != 0)
        return NOT_ENTERED;
    const volatile uint64_t *frame = &view.w[0].head->frame;
    return *frame == UINT64_MAX ? 2 : 3;
}

static void test_memory_that_goes_away_is_said_inside(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        struct loss loss = {.role = (enum role)role};
        named_world_make(loss.name, "vehicles = ();");
        named_world_paths(&loss.paths, loss.name);
        int result = run(lose_memory, &loss);
        named_world_remove(loss.name);
        if (result != EXIT_REFUSED || !strstr(said, "memory went away"))
            fail_msg("%s: %d: %s", role_name(loss.role), result, said);
    }
}

/* --- without
 * ------------------------------------------------------------------------------------*/

static int go_without(void *context)
{
    struct sandbox sandbox;
    (void)context;
    int before = prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0); /* a container's own */
    if (sandbox_begin(&sandbox, ROLE_MOVER, true, &reason) != 0 || sandbox.on ||
        sandbox_files(&sandbox, NULL, 0, &reason) != 0 || sandbox_enter(&sandbox, &reason) != 0)
        return 1;
    attempt(0);
    return prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != before;
}

static int enter_in_a_strange_environment(void *context)
{
    (void)context;
    setenv("LD_PRELOAD", "/usr/libexec/valgrind/vgpreload_core-amd64-linux.so", 1);
    setenv("JOLON_NO_SANDBOX", "1", 1);
    if (enter(ROLE_MOVER) != 0)
        return NOT_ENTERED;
    attempt(0);
    return 0;
}

static void test_the_environment_cannot_switch_it_off(void **state)
{
    (void)state;
    assert_int_equal(run(enter_in_a_strange_environment, NULL), -SIGSYS);
}

static void test_no_sandbox_is_said_loudly(void **state)
{
    (void)state;
    assert_int_equal(run(go_without, NULL), 0);
    assert_non_null(strstr(said, "warning"));
    assert_non_null(strstr(said, "WITHOUT its sandbox"));
}

/* A container that forbids filters. */
static int forbid_filters(void *context)
{
    struct sandbox sandbox;
    (void)context;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(seccomp), 0);
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prctl), 1,
                     SCMP_A0(SCMP_CMP_EQ, PR_SET_SECCOMP));
    if (seccomp_load(filter) != 0 || sandbox_begin(&sandbox, ROLE_MOVER, false, &reason) != 0)
        return NOT_ENTERED;
    int result = sandbox_enter(&sandbox, &reason);
    fprintf(stderr, "%s\n", reason.text);
    return result == -1 ? 0 : 1;
}

static void test_a_kernel_that_refuses_is_said_and_never_passed_over(void **state)
{
    (void)state;
    assert_int_equal(run(forbid_filters, NULL), 0);
    assert_non_null(strstr(said, "--no-sandbox"));
}

/* --- set-up
 * -------------------------------------------------------------------------------------*/

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return rmdir(folder);
}

/* Roles of sanitized builds have none, but for mover and collider (tests/system/test_heavy.sh). */
static int is_there(void *context)
{
    struct sandbox sandbox;
    (void)context;
    return sandbox_begin(&sandbox, ROLE_RECORDER, false, &reason) == 0 && sandbox.on;
}

int main(void)
{
    const struct CMUnitTest without[] = {cmocka_unit_test(test_no_sandbox_is_said_loudly)};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_role_may_do_what_it_needs_and_nothing_else),
        cmocka_unit_test(test_a_thread_made_before_is_confined_too),
        cmocka_unit_test(test_blocking_the_signal_does_not_help),
        cmocka_unit_test(test_a_thread_of_dds_says_why_it_ends),
        cmocka_unit_test(test_workers_allocate_and_end_inside),
        cmocka_unit_test(test_crashes_stay_what_they_are),
        cmocka_unit_test(test_a_wait_goes_on_after_stop_and_continue),
        cmocka_unit_test(test_files_only_beneath_the_folder),
        cmocka_unit_test(test_a_console_only_reads_worlds),
        cmocka_unit_test(test_the_keeper_and_what_it_starts_may_not_do_everything),
        cmocka_unit_test(test_the_keeper_writes_only_beneath_its_folders),
        cmocka_unit_test(test_every_role_enters_its_sandbox_beneath_the_keepers),
        cmocka_unit_test(test_memory_that_goes_away_is_said_inside),
        cmocka_unit_test(test_the_environment_cannot_switch_it_off),
        cmocka_unit_test(test_no_sandbox_is_said_loudly),
        cmocka_unit_test(test_a_kernel_that_refuses_is_said_and_never_passed_over),
    };
    if (child_run(is_there, NULL) == 0)
        return cmocka_run_group_tests_name("without a sandbox", without, NULL, NULL);
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
