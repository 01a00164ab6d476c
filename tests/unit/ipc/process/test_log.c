/* The log: one line for each entry and any text, and the ways in which a program ends. Each test
 * reads the standard error of a child. */
#include "ipc/process/log.h"

#include "ipc/process/clock.h"
#include "tests/support/child.h"
#include "world/runtime/check.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char written[65536];
static int pipe_end;

struct run {
    int (*body)(void *context);
    void *context;
};

static int redirected(void *context)
{
    struct run *run = context;
    dup2(pipe_end, STDERR_FILENO);
    return run->body(run->context);
}

/* Runs body in a child and reads its output into written. Returns its exit code, or minus its
 * signal. */
static int run(int (*body)(void *context), void *context)
{
    struct run what = {body, context};
    int ends[2];
    size_t length = 0;
    assert_int_equal(pipe(ends), 0);
    pipe_end = ends[1];
    int result = child_run(redirected, &what); /* entries fit the pipe */
    close(ends[1]);
    for (ssize_t got = 1; got > 0; length += (size_t)got) {
        got = read(ends[0], written + length, sizeof written - 1 - length);
        assert_true(got >= 0);
    }
    written[length] = '\0';
    close(ends[0]);
    return result;
}

static int lines(void)
{
    int count = 0;
    for (const char *c = written; *c; c++)
        count += *c == '\n';
    return count;
}

static int say(void *context)
{
    log_open("mover");
    log_frame(1234);
    log_info("%s", (const char *)context);
    return 0;
}

static int say_untrusted(const char *text)
{
    char copy[4096];
    snprintf(copy, sizeof copy, "%s", text);
    return run(say, copy);
}

static void test_entry_has_time_role_level_frame_and_text(void **state)
{
    unsigned long long seconds, micros, frame;
    char role[16], level[16], text[64];
    (void)state;
    assert_int_equal(say_untrusted("all well"), 0);
    uint64_t now = clock_now_ns();
    assert_int_equal(sscanf(written, "%llu.%llu %15s %15s frame %llu: %63[^\n]", &seconds, &micros,
                            role, level, &frame, text),
                     6);
    assert_in_range(seconds, now / NS_PER_S - 30, now / NS_PER_S);
    assert_true(micros < 1000000);
    assert_string_equal(role, "mover");
    assert_string_equal(level, "info");
    assert_int_equal(frame, 1234);
    assert_string_equal(text, "all well");
    assert_int_equal(lines(), 1);
}

static void test_control_bytes_do_not_pass(void **state)
{
    (void)state;
    say_untrusted("one\ntwo\r\x1b[2J\x7f\ttab");
    assert_int_equal(lines(), 1);
    assert_null(strpbrk(written, "\r\x1b\x7f\t"));
    assert_non_null(strstr(written, "one"));
    assert_non_null(strstr(written, "tab"));
}

static void test_long_text_is_one_bounded_line(void **state)
{
    char text[4000];
    (void)state;
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = '\0';
    say_untrusted(text);
    assert_int_equal(lines(), 1);
    assert_in_range(strlen(written), 500, 1024);
    assert_true(written[strlen(written) - 1] == '\n');
}

static int warn(void *context)
{
    (void)context;
    log_warn("value %d", 7);
    return 0;
}

static void test_warning_says_so(void **state)
{
    (void)state;
    run(warn, NULL);
    assert_non_null(strstr(written, " warning frame 0: value 7\n"));
}

static int refuse(void *context)
{
    log_open("collider");
    die_refused("world \"%s\" is bad", (const char *)context);
}

static int usage(void *context)
{
    die_usage("try %s", (const char *)context);
}

static void test_refusal_ends_with_1_and_one_line(void **state)
{
    char name[] = "a\nb";
    (void)state;
    assert_int_equal(run(refuse, name), EXIT_REFUSED);
    assert_string_equal(written, "jolon-collider: world \"a?b\" is bad\n");
}

static void test_wrong_usage_ends_with_2_and_one_line(void **state)
{
    char what[] = "--help";
    (void)state;
    assert_int_equal(run(usage, what), EXIT_USAGE);
    assert_string_equal(written, "jolon: try --help\n");
}

static int bug(void *context)
{
    const int *one = context;
    CHECK(*one == 1);
    CHECK(*one == 2);
    return 0;
}

static void test_check_that_fails_aborts_with_its_place(void **state)
{
    int one = 1;
    (void)state;
    assert_int_equal(run(bug, &one), -SIGABRT);
    assert_non_null(strstr(written, "*one == 2"));
    assert_non_null(strstr(written, "test_log.c:"));
    assert_null(strstr(written, "*one == 1"));
    assert_int_equal(lines(), 1);
}

static void test_due_is_true_once_an_interval(void **state)
{
    uint64_t last = 0, always = 0;
    int times = 0;
    (void)state;
    for (int i = 0; i < 1000; i++)
        times += log_due(&last, 3600 * (uint64_t)NS_PER_S);
    assert_int_equal(times, 1);
    last = clock_now_ns() - NS_PER_S;
    assert_true(log_due(&last, NS_PER_S));
    assert_true(log_due(&always, 0));
    assert_true(log_due(&always, 0));
}

static int many(void *context)
{
    for (int i = 0; i < 200; i++)
        log_info("%s says the same again and again, so that lines could mix",
                 (const char *)context);
    return 0;
}

struct pair {
    char first[8], second[8];
};

static int two_writers(void *context)
{
    struct pair *names = context;
    pid_t other = fork();
    many(other == 0 ? names->second : names->first);
    if (other == 0)
        _exit(0);
    int status = 1;
    waitpid(other, &status, 0);
    return status;
}

static void test_lines_of_two_processes_do_not_mix(void **state)
{
    struct pair names = {"alpha", "beta"};
    (void)state;
    assert_int_equal(run(two_writers, &names), 0);
    assert_int_equal(lines(), 400);
    for (char *line = strtok(written, "\n"); line; line = strtok(NULL, "\n")) {
        assert_non_null(strstr(line, " jolon info frame 0: "));
        assert_non_null(strstr(line, "could mix"));
        assert_int_not_equal(strstr(line, "alpha") != NULL, strstr(line, "beta") != NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_entry_has_time_role_level_frame_and_text),
        cmocka_unit_test(test_control_bytes_do_not_pass),
        cmocka_unit_test(test_long_text_is_one_bounded_line),
        cmocka_unit_test(test_warning_says_so),
        cmocka_unit_test(test_refusal_ends_with_1_and_one_line),
        cmocka_unit_test(test_wrong_usage_ends_with_2_and_one_line),
        cmocka_unit_test(test_check_that_fails_aborts_with_its_place),
        cmocka_unit_test(test_due_is_true_once_an_interval),
        cmocka_unit_test(test_lines_of_two_processes_do_not_mix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
