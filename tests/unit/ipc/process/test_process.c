/* The start of a role, its end as others see it, and priorities: each process of a world keeps its
 * distance to the others when all run at a low one. */
#include "ipc/process/process.h"

#include "tests/support/child.h"

#include <fcntl.h>
#include <pthread.h>
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

static int niceness(void)
{
    return getpriority(PRIO_PROCESS, 0);
}

static int lower_by(int from, int steps)
{
    return from + steps < 19 ? from + steps : 19; /* the lowest that there is */
}

static void *in_thread(void *seen)
{
    process_lower_priority(7);
    *(int *)seen = niceness();
    return NULL;
}

/* In a process that begins two steps below this one. */
static int lower(void *context)
{
    int before = lower_by(niceness(), 2), of_thread = 0;
    pthread_t thread;
    (void)context;
    if (setpriority(PRIO_PROCESS, 0, before) != 0 || process_lower_priority(5) != 0 ||
        niceness() != lower_by(before, 5))
        return 1;
    if (pthread_create(&thread, NULL, in_thread, &of_thread) != 0 ||
        pthread_join(thread, NULL) != 0 || of_thread != lower_by(before, 7))
        return 2;
    if (niceness() != lower_by(before, 5)) /* the thread's was its own */
        return 3;
    return process_lower_priority(100) != 0 || niceness() != 19 ? 4 : 0;
}

static void test_priority_is_lowered_from_that_of_the_start(void **state)
{
    (void)state;
    assert_int_equal(child_run(lower, NULL), 0);
}

/* A role begins: what it inherited is closed, it takes signals, and it yields to the frames. */
static int begin(void *context)
{
    int before = niceness(), inherited = dup(1);
    (void)context;
    if (inherited < 3)
        return 1;
    process_begin_beside(getppid());
    if (fcntl(inherited, F_GETFD) != -1)
        return 2;
    if (niceness() != lower_by(before, 5))
        return 3;
    if (process_stopping() || raise(SIGTERM) != 0 || !process_stopping())
        return 4;
    int death_signal = 0;
    return prctl(PR_GET_PDEATHSIG, &death_signal) != 0 || death_signal != SIGKILL ? 5 : 0;
}

static void test_a_role_begins(void **state)
{
    (void)state;
    assert_int_equal(child_run(begin, NULL), 0);
}

/* A role knows whether its parent has stopped it. context: where to tell the parent that it may, or
 * NULL: the role itself sends the signal. */
static int stop(void *context)
{
    int *ready = context, told = ready ? dup2(*ready, STDOUT_FILENO) : -1; /* begin closes others */
    process_begin(getppid());
    if (ready && (told < 0 || write(told, "", 1) != 1))
        return 1;
    if (!ready && raise(SIGHUP) != 0)
        return 2;
    while (!process_stopping())
        continue;
    return process_stopped_by_parent() == (ready != NULL) ? 0 : 3;
}

static void test_who_has_stopped_it(void **state)
{
    int ready[2];
    char byte;
    (void)state;
    assert_int_equal(child_run(stop, NULL), 0);
    assert_int_equal(pipe(ready), 0);
    pid_t child = child_start(stop, &ready[1]);
    assert_int_equal(read(ready[0], &byte, 1), 1);
    assert_int_equal(kill(child, SIGTERM), 0);
    assert_int_equal(child_wait(child), 0);
    close(ready[0]);
    close(ready[1]);
}

static void test_a_process_has_ended_as_a_zombie_too(void **state)
{
    siginfo_t info;
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        pause();
        _exit(0);
    }
    assert_false(process_has_ended(child));
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitid(P_PID, (id_t)child, &info, WEXITED | WNOWAIT), 0);
    assert_true(process_has_ended(child));
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_true(process_has_ended(child));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_priority_is_lowered_from_that_of_the_start),
        cmocka_unit_test(test_a_role_begins),
        cmocka_unit_test(test_who_has_stopped_it),
        cmocka_unit_test(test_a_process_has_ended_as_a_zombie_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
