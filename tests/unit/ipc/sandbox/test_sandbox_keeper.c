/* The keeper's sandbox, which its children inherit. */
#include "ipc/process/log.h"
#include "ipc/sandbox/sandbox.h"
#include "tests/support/confined.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static struct error_text error;

/* Calls that fail with EPERM in the keeper and its children. Without the filter each would have an
 * effect, or fail with another error, also for a user without privileges. */
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

/* Returns the number of the first that is not refused. */
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
    const char *folders[] = {confined_folder, "/none"};
    if (sandbox_keeper(folders, 2, &error) == 0)
        return 0;
    fprintf(stderr, "%s\n", error.text);
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
    pid_t pid = fork(); /* its children are confined too */
    if (pid == 0)
        _exit(try_denied() == 0 ? 0 : 1);
    if (pid < 0 || waitpid(pid, status, 0) != pid || *status != 0)
        return 101;
    pid = fork();
    if (pid == 0)
        execl("/bin/true", "/bin/true", (char *)NULL);
    if (pid < 0 || waitpid(pid, status, 0) != pid || *status != 0)
        return 102;
    if (prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 1 || prctl(PR_CAPBSET_READ, 0) == 1)
        return 103;
    if (syscall(SYS_landlock_create_ruleset, NULL, 0, 1) >= 6 &&
        (kill(parent, 0) == 0 || errno != EPERM))
        return 104;
    return 0;
}

static void test_the_keeper_and_its_children_are_confined(void **state)
{
    int status = 0;
    (void)state;
    int result = confined_run(keep, &status);
    if (result != 0)
        fail_msg("%d: %s", result, confined_output);
}

static int touch_as_keeper(void *context)
{
    (void)context;
    if (enter_as_keeper() != 0)
        return NOT_ENTERED;
    int fd = open(confined_folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
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
    int result = confined_run(touch_as_keeper, NULL);
    if (result != 0)
        fail_msg("%d: %s", result, confined_output);
}

/* A role enters its own sandbox within the inherited one. */
static int enter_beneath_keeper(void *context)
{
    const enum role *role = context;
    int fd = open(confined_folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    struct sandbox sandbox;
    if (enter_as_keeper() != 0 || sandbox_begin(&sandbox, *role, false, &error) != 0 ||
        sandbox_files(&sandbox, &fd, 1, &error) != 0 || sandbox_enter(&sandbox, &error) != 0)
        return NOT_ENTERED;
    confined_use_memory();
    syscall(SYS_open, "/etc/passwd", O_RDONLY);
    return 0;
}

static void test_every_role_enters_its_sandbox_beneath_the_keepers(void **state)
{
    (void)state;
    for (int role = 0; role < ROLE_COUNT; role++) {
        enum role entered_role = (enum role)role;
        int result = confined_run(enter_beneath_keeper, &entered_role);
        if (result != -SIGSYS || !strstr(confined_output, "forbids system call"))
            fail_msg("%s: %d: %s", role_name(entered_role), result, confined_output);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_keeper_and_its_children_are_confined),
        cmocka_unit_test(test_the_keeper_writes_only_beneath_its_folders),
        cmocka_unit_test(test_every_role_enters_its_sandbox_beneath_the_keepers),
    };
    if (!confined_available())
        return confined_skip();
    return cmocka_run_group_tests(tests, confined_make_folder, confined_remove_folder);
}
