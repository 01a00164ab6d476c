/* Each role makes forbidden system calls, for which the kernel must end it after a line that names
 * the call, and those that it needs. */
#include "ipc/sandbox/sandbox.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "tests/support/child.h"
#include "tests/support/confined.h"
#include "world/runtime/check.h"
#include "world/runtime/thread_pool.h"

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

/* Sets of roles, for the table. */
enum {
    M = 1 << ROLE_MOVER,
    C = 1 << ROLE_COLLIDER,
    I = 1 << ROLE_INTAKE,
    P = 1 << ROLE_REPORTER,
    D = 1 << ROLE_RECORDER,
    W = 1 << ROLE_CONSOLE,
    G = 1 << ROLE_GATEWAY
};
#define R    (1 << ROLE_RENDERER | 1 << ROLE_RENDERER_2 | 1 << ROLE_RENDERER_3 | 1 << ROLE_RENDERER_4)
#define NONE 0
#define ALL  (M | C | I | P | D | R | W | G)

static struct error_text error;

/* --- what is tried; the result does not matter, only whether it may be asked --- */

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

/* A filter cannot see its flags, so it is hidden. */
static void new_process_clone3(void)
{
    if (syscall(SYS_clone3, NULL, 0) != -1 || errno != ENOSYS)
        syscall(SYS_fork);
}

/* Refused, but does not end the process. */
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

/* --- the table --- */

/* An attempt: the system call in the report, the roles that may make it, and the code. A thread
 * that starts another has signals blocked, and reports nothing. */
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
    X("openat", R | D | W | P | G, open("/", O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC))       \
    X("readlink", W, readlink("/", confined_output, 1))                                            \
    X("fcntl", R, fcntl(-1, F_DUPFD_CLOEXEC, 0))                                                   \
    X("socket", P, socket(AF_INET, SOCK_DGRAM, 0))                                                 \
    X("socket", P, socket(AF_INET6, SOCK_STREAM, 0))                                               \
    X("socket", W | P | G, socket(AF_UNIX, SOCK_STREAM, 0))                                        \
    X("socket", NONE, socket(AF_NETLINK, SOCK_RAW, 0))                                             \
    X("socket", NONE, socket(AF_PACKET, SOCK_RAW, 0))                                              \
    X("connect", W | P | G, connect(-1, NULL, 0))                                                  \
    X("bind", P, bind(-1, NULL, 0))                                                                \
    X("listen", P, listen(-1, 1))                                                                  \
    X("accept", NONE, syscall(SYS_accept, -1, NULL, NULL))                                         \
    X("accept4", W | P | R | I, accept4(-1, NULL, NULL, 0))                                        \
    X("sendto", W | P | R | I | G, sendto(-1, "", 0, 0, NULL, 0))                                  \
    X("sendmsg", W | P | R | I, sendmsg(-1, NULL, 0))                                              \
    X("recvfrom", W | P | R | I | G, recvfrom(-1, NULL, 0, 0, NULL, NULL))                         \
    X("shutdown", W | R | I, shutdown(-1, SHUT_WR))                                                \
    X("setsockopt", W | P | R | I, setsockopt(-1, IPPROTO_TCP, TCP_NODELAY, NULL, 0))              \
    X("getsockopt", W | P | R | I | G, getsockopt(-1, SOL_SOCKET, SO_PEERCRED, NULL, NULL))        \
    X("getsockopt", P, getsockopt(-1, SOL_SOCKET, SO_ERROR, NULL, NULL))                           \
    X("setsockopt", P, setsockopt(-1, SOL_SOCKET, SO_BINDTODEVICE, NULL, 0))                       \
    X("sysinfo", P | R, syscall(SYS_sysinfo, confined_output))                                     \
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
    X("uname", P, syscall(SYS_uname, confined_output))                                             \
    X("getrandom", W | P, syscall(SYS_getrandom, confined_output, 1, 0))                           \
    X("rt_sigaction", NONE, handle(SIGSYS))                                                        \
    X("rt_sigaction", NONE, handle(SIGSEGV))                                                       \
    X("rt_sigaction", ALL, handle(SIGABRT))                                                        \
    X("rt_sigaction", P, handle(SIGALRM))                                                          \
    X("mmap", R, map(PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1))                      \
    X("mmap", R | W, map(PROT_READ, MAP_SHARED, 2))                                                \
    X("mmap", R | W, map(PROT_READ, MAP_PRIVATE, 2))                                               \
    X("mmap", R | W, map(PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1))                               \
    X("mprotect", W | P | I | R | D | G, write_protect())                                          \
    X("mprotect", R, make_executable())                                                            \
    X("pkey_mprotect", NONE, syscall(SYS_pkey_mprotect, NULL, 4096, PROT_EXEC, -1))                \
    X("remap_file_pages", NONE, syscall(SYS_remap_file_pages, NULL, 0, 0, 0, 0))                   \
    X("memfd_create", NONE, syscall(SYS_memfd_create, "m", 0))                                     \
    X("shmget", NONE, syscall(SYS_shmget, 0, 4096, 0600))                                          \
    X("personality", NONE, syscall(SYS_personality, 0x0400000))                                    \
    X("prctl", NONE, prctl(PR_SET_DUMPABLE, 1))                                                    \
    X("prctl", W | P | R, prctl(PR_SET_NAME, "name"))                                              \
    X("prctl", W | P | R, prctl(PR_GET_NAME, confined_output))                                     \
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
    X("mremap", W | P | I | R | D | G, confined_use_memory())                                      \
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

/* --- children --- */

static int enter(int role)
{
    struct sandbox sandbox;
    if (sandbox_begin(&sandbox, (enum role)role, false, &error) == 0) {
        if (sandbox_enter(&sandbox, &error) == 0)
            return sandbox.on ? 0 : NOT_ENTERED;
    }
    fprintf(stderr, "%s\n", error.text);
    return NOT_ENTERED;
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
    int result = confined_run(try_it, &trial);
    if (result != (allowed ? 0 : -SIGSYS))
        fail_msg("%s by the %s: %d, should be %s; it said: %s", attempts[number].action,
                 role_name((enum role)role), result, allowed ? "allowed" : "forbidden",
                 confined_output);
    if (allowed || attempts[number].call[0] == '\0')
        return;
    snprintf(wanted, sizeof wanted, "jolon-%s: the sandbox forbids system call ",
             role_name((enum role)role));
    const char *name = strchr(confined_output, '(');
    if (strncmp(confined_output, wanted, strlen(wanted)) != 0 || !name ||
        strncmp(name + 1, attempts[number].call, strlen(attempts[number].call)) != 0)
        fail_msg("%s by the %s: said \"%s\", not (%s)", attempts[number].action,
                 role_name((enum role)role), confined_output, attempts[number].call);
}

static void test_each_role_may_do_what_it_needs_and_nothing_else(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        for (int i = 0; i < ATTEMPT_COUNT; i++)
            check_trial(role, i);
    }
}

/* --- all threads, for good --- */

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
    if (sandbox_begin(&sandbox, ROLE_MOVER, false, &error) != 0 ||
        pthread_create(&thread, NULL, open_when_entered, NULL) != 0 ||
        sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    entered = 1;
    pthread_join(thread, NULL);
    return 1;
}

static void test_a_thread_made_before_is_confined_too(void **state)
{
    (void)state;
    assert_int_equal(confined_run(confine_older_thread, NULL), -SIGSYS);
}

/* Blocks every signal by the C library's functions, and by the system call. */
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
        assert_int_equal(confined_run(block_and_open, &way), -SIGSYS);
        if (!strstr(confined_output, "forbids system call") != (way == 2))
            fail_msg("way %d to block all signals: it said \"%s\"", way, confined_output);
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
    if (sandbox_begin(&sandbox, ROLE_REPORTER, false, &error) != 0 ||
        ddsrt_thread_create(&thread, "dds", &attributes, open_in_dds_thread, NULL) != 0 ||
        sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    entered = 1;
    ddsrt_thread_join(thread, NULL);
    return 1;
}

static void test_a_thread_of_dds_reports_its_forbidden_call(void **state)
{
    (void)state;
    assert_int_equal(confined_run(make_dds_thread, NULL), -SIGSYS);
    if (!strstr(confined_output, "jolon-reporter: the sandbox forbids system call 2 (open)\n"))
        fail_msg("it said \"%s\"", confined_output);
}

static void allocate_row(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    void **blocks = context;
    (void)worker;
    for (uint32_t i = first; i < end; i++)
        blocks[i] = malloc(100000);
}

/* Threads whose first allocation comes after the sandbox: glibc makes arenas for them. */
static int work_inside(void *context)
{
    void *blocks[4096];
    struct sandbox sandbox;
    struct thread_pool *workers;
    (void)context;
    if (sandbox_begin(&sandbox, ROLE_COLLIDER, false, &error) != 0 ||
        !(workers = thread_pool_create(THREAD_POOL_MAX)) || sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    for (int turn = 0; turn < 20; turn++) {
        thread_pool_run(workers, allocate_row, blocks, 4096, 16);
        for (int i = 0; i < 4096; i++)
            free(blocks[i]);
    }
    thread_pool_destroy(workers);
    return 0;
}

static void test_workers_allocate_and_end_inside(void **state)
{
    (void)state;
    if (confined_run(work_inside, NULL) != 0)
        fail_msg("%s", confined_output);
}

/* --- ends that are not the sandbox's --- */

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

static void test_crashes_keep_their_signals(void **state)
{
    (void)state;
    assert_int_equal(confined_run(fail_a_check, NULL), -SIGABRT);
    assert_non_null(strstr(confined_output, "bug: context != NULL"));
    assert_int_equal(confined_run(free_twice, NULL), -SIGABRT);
    assert_null(strstr(confined_output, "sandbox"));
    assert_int_equal(confined_run(fault, NULL), -SIGSEGV);
    assert_int_equal(confined_run(refuse, NULL), EXIT_REFUSED);
    assert_non_null(strstr(confined_output, "out of patience"));
}

static int sleep_inside(void *context)
{
    const struct timespec second = {.tv_sec = 1};
    (void)context;
    int result = enter(ROLE_MOVER);
    clock_nanosleep(CLOCK_MONOTONIC, 0, &second, NULL);
    return result;
}

/* The kernel continues a wait by a system call of its own (restart_syscall). */
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

/* --- without --- */

static int go_without(void *context)
{
    struct sandbox sandbox;
    (void)context;
    int before = prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0); /* a container's own */
    if (sandbox_begin(&sandbox, ROLE_MOVER, true, &error) != 0 || sandbox.on ||
        sandbox_files(&sandbox, NULL, 0, &error) != 0 || sandbox_enter(&sandbox, &error) != 0)
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
    assert_int_equal(confined_run(enter_in_a_strange_environment, NULL), -SIGSYS);
}

static void test_no_sandbox_is_logged(void **state)
{
    (void)state;
    assert_int_equal(confined_run(go_without, NULL), 0);
    assert_non_null(strstr(confined_output, "warning"));
    assert_non_null(strstr(confined_output, "WITHOUT its sandbox"));
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
    if (seccomp_load(filter) != 0 || sandbox_begin(&sandbox, ROLE_MOVER, false, &error) != 0)
        return NOT_ENTERED;
    int result = sandbox_enter(&sandbox, &error);
    fprintf(stderr, "%s\n", error.text);
    return result == -1 ? 0 : 1;
}

static void test_a_refusing_kernel_is_an_error(void **state)
{
    (void)state;
    assert_int_equal(confined_run(forbid_filters, NULL), 0);
    assert_non_null(strstr(confined_output, "--no-sandbox"));
}

int main(void)
{
    const struct CMUnitTest without[] = {cmocka_unit_test(test_no_sandbox_is_logged)};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_role_may_do_what_it_needs_and_nothing_else),
        cmocka_unit_test(test_a_thread_made_before_is_confined_too),
        cmocka_unit_test(test_blocking_the_signal_does_not_help),
        cmocka_unit_test(test_a_thread_of_dds_reports_its_forbidden_call),
        cmocka_unit_test(test_workers_allocate_and_end_inside),
        cmocka_unit_test(test_crashes_keep_their_signals),
        cmocka_unit_test(test_a_wait_goes_on_after_stop_and_continue),
        cmocka_unit_test(test_the_environment_cannot_switch_it_off),
        cmocka_unit_test(test_no_sandbox_is_logged),
        cmocka_unit_test(test_a_refusing_kernel_is_an_error),
    };
    if (!confined_available())
        return cmocka_run_group_tests_name("without a sandbox", without, NULL, NULL);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
