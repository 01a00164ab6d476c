/* Forked children of a test. */
#include "tests/support/child.h"

#include "ipc/process/clock.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

pid_t child_start(int (*body)(void *context), void *context)
{
    fixture_data_dir(); /* made in the parent: children skip the exit handlers that remove it */
    pid_t parent = getpid();
    pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid > 0)
        return pid;
    const struct rlimit none = {0, 0};
    setrlimit(RLIMIT_CORE, &none);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(0);
    /* No handlers of cmocka or a sanitizer. */
    signal(SIGSEGV, SIG_DFL);
    signal(SIGBUS, SIG_DFL);
    signal(SIGABRT, SIG_DFL);
    _exit(body(context));
}

int child_wait(pid_t pid)
{
    uint64_t until = clock_now_ns() + (uint64_t)CHILD_TIMEOUT_S * NS_PER_S;
    int status = 0;
    for (;;) {
        pid_t ended = waitpid(pid, &status, WNOHANG);
        assert_true(ended >= 0);
        if (ended == pid)
            return status;
        if (clock_now_ns() > until) {
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
            fail_msg("child %d did not end within %d s", (int)pid, CHILD_TIMEOUT_S);
        }
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS / 4);
    }
}

void child_kill(pid_t pid)
{
    assert_int_equal(kill(pid, SIGKILL), 0);
    child_wait(pid);
}

int child_run(int (*body)(void *context), void *context)
{
    int status = child_wait(child_start(body, context));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}
