/* The verb of a command line, and how the program ends without one. */
#include "ipc/process/program_verbs.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static int seven(int argc, char **argv)
{
    (void)argc, (void)argv;
    return 7;
}

static const struct program_verb verbs[] = {{"one", seven}, {"two", seven}, {NULL, NULL}};

/* Returns how a program with this first argument ends, and what it prints to both outputs. */
static int ends(const char *word, char *printed, size_t room)
{
    char *argv[] = {(char[]){"x"}, (char *)(uintptr_t)word, NULL};
    int pipes[2], status = 0;
    assert_int_equal(pipe(pipes), 0);
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        dup2(pipes[1], STDOUT_FILENO);
        dup2(pipes[1], STDERR_FILENO);
        (void)program_verbs_find(verbs, "usage: x VERB\n", word ? 2 : 1, argv);
        _exit(99);
    }
    close(pipes[1]);
    ssize_t size = 0, more;
    while ((more = read(pipes[0], printed + size, room - 1 - (size_t)size)) > 0)
        size += more;
    printed[size] = '\0';
    close(pipes[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WEXITSTATUS(status);
}

static void test_it_finds_a_verb(void **state)
{
    char *argv[] = {(char[]){"x"}, (char[]){"two"}, (char[]){"--json"}, NULL};
    (void)state;
    const struct program_verb *verb = program_verbs_find(verbs, "", 3, argv);
    assert_string_equal(verb->name, "two");
    assert_int_equal(verb->run(2, argv + 1), 7);
}

static void test_help_is_no_error(void **state)
{
    static const char *const words[] = {"help", "--help", "-h"};
    char printed[400];
    (void)state;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ends(words[i], printed, sizeof printed), EXIT_OK);
        assert_string_equal(printed, "usage: x VERB\n");
    }
}

static void test_no_verb_and_an_unknown_one_are(void **state)
{
    char printed[400];
    (void)state;
    assert_int_equal(ends(NULL, printed, sizeof printed), EXIT_USAGE);
    assert_string_equal(printed, "usage: x VERB\n");
    assert_int_equal(ends("three", printed, sizeof printed), EXIT_USAGE);
    assert_non_null(strstr(printed, "three: no such verb; there are one, two"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_finds_a_verb),
        cmocka_unit_test(test_help_is_no_error),
        cmocka_unit_test(test_no_verb_and_an_unknown_one_are),
    };
    log_open("x");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
