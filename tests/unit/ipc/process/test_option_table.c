/* Command lines: each kind of value, each refusal and its words, and the help. */
#include "ipc/process/option_table.h"

#include "ipc/process/log.h"
#include "tests/support/child.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define WORDS_MAX 24

static struct {
    bool flag, sandbox_off;
    const char *world, *text, *alone;
    int choice, integer, parent;
    uint32_t u32;
    uint64_t u64;
    double real;
    struct option_size size;
    char taken[64]; /* the values of --take, one after the other */
} given;

static int take(const char *value, struct error_text *wrong)
{
    strncat(given.taken, value, sizeof given.taken - strlen(given.taken) - 1);
    return strcmp(value, "bad") == 0 ? error_text_set(wrong, "not good") : 0;
}

static const struct option_row rows[] = {
    OPTION_ROW_WORLD(given, NULL),
    {"flag", NULL, "a flag", .flag = &given.flag, .letter = 'f'},
    {"text", "TEXT",
     "a text whose help is so long that it does not fit into one line of the terminal and goes on",
     .text = &given.text},
    {"choice", "one|two|three|and-a-fourth", "a choice", .choice = &given.choice, .least = 10},
    {"integer", "N", NULL, .integer = &given.integer, .least = 1, .most = INT_MAX},
    {"u32", "N", NULL, .u32 = &given.u32, .most = UINT32_MAX},
    {"u64", "N", NULL, .u64 = &given.u64, .least = 3, .most = UINT64_MAX},
    {"real", "X", NULL, .real = &given.real, .low = -0.5, .high = 2.5},
    {"size", "WxH", NULL, .size = &given.size, .least = 64, .most = 4096},
    {"take", "X", NULL, .take = take},
    OPTION_ROW_PARENT(given),
    OPTION_ROW_NO_SANDBOX(given),
    OPTION_ROWS_END};

static const struct option_row more[] = {{"alone", NULL, "not listed", .text = &given.alone},
                                         {"tail", "X", NULL, .text = &given.text},
                                         OPTION_ROWS_END};

static const struct option_table table = {.program = "jolon-test",
                                          .usage = "[options] [FILE]\nTests.",
                                          .ending = "That is all.\n",
                                          .rows = rows,
                                          .more = more,
                                          .plain = 1};

static struct error_text error;
static char line[1024], *words[WORDS_MAX + 1];

/* Splits a line at its blanks ('_' stands for an empty word). Returns the number of words. */
static int split(const char *text)
{
    int count = 0;
    words[count++] = line;
    (void)snprintf(line, sizeof line, "program %s", text);
    for (char *at = strchr(line, ' '); at; at = strchr(at, ' ')) {
        *at++ = '\0';
        assert_true(count < WORDS_MAX);
        words[count++] = at;
    }
    for (int i = 0; i < count; i++)
        words[i] += strcmp(words[i], "_") == 0;
    words[count] = NULL;
    return count;
}

static int read_line(const struct option_table *by, const char *text)
{
    int count = split(text);
    memset(&given, 0, sizeof given);
    return option_table_try(by, count, words, &error);
}

static void takes(const char *text)
{
    if (read_line(&table, text) != 0)
        fail_msg("%s: %s", text, error.text);
}

static void refuses(const struct option_table *by, const char *text, const char *says)
{
    assert_int_equal(read_line(by, text), -1);
    assert_string_equal(error.text, says);
}

static void test_values(void **state)
{
    (void)state;
    takes("--flag --text some --choice two --integer 7 --u32 0 --u64 3 --real -0.5 --size 64x4096");
    assert_true(given.flag && !given.sandbox_off);
    assert_string_equal(given.text, "some");
    assert_int_equal(given.choice, 11);
    assert_int_equal(given.integer, 7);
    assert_int_equal(given.u32, 0);
    assert_true(given.u64 == 3);
    assert_true(given.real == -0.5);
    assert_true(given.size.width == 64 && given.size.height == 4096);
    takes("--integer 2147483647 --u32 4294967295 --u64 18446744073709551615 --real 2.5");
    assert_int_equal(given.integer, INT_MAX);
    assert_true(given.u32 == UINT32_MAX && given.u64 == UINT64_MAX && given.real == 2.5);
    takes("--choice one");
    assert_int_equal(given.choice, 10);
    takes("--choice and-a-fourth --no-sandbox --parent 12");
    assert_int_equal(given.choice, 13);
    assert_true(given.sandbox_off && given.parent == 12);
}

static void test_all_ways_to_write_an_option(void **state)
{
    static const char *const ways[] = {"-w here",      "-where -w here", "--world here",
                                       "--world=here", "--wor here",     "-fw here"};
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        takes(ways[i]);
        assert_string_equal(given.world, "here");
    }
    assert_true(given.flag);
    takes("--text _");
    assert_string_equal(given.text, "");
    takes("--text --flag"); /* a value may look like an option */
    assert_string_equal(given.text, "--flag");
    assert_false(given.flag);
}

static void test_of_repeated_options_the_last_wins(void **state)
{
    (void)state;
    takes("--u32 1 --text a --take x --u32 2 --text b --take y --choice two --choice one");
    assert_int_equal(given.u32, 2);
    assert_string_equal(given.text, "b");
    assert_string_equal(given.taken, "xy");
    assert_int_equal(given.choice, 10);
}

static void test_wrong_values(void **state)
{
    static const char *const wrong[][2] = {
        {"--integer 0", "--integer 0: must be a whole number from 1 to 2147483647"},
        {"--integer 2147483648", "--integer 2147483648: must be a whole number from 1 to "
                                 "2147483647"},
        {"--u32 -1", "--u32 -1: must be a whole number from 0 to 4294967295"},
        {"--u32 +1", "--u32 +1: must be a whole number from 0 to 4294967295"},
        {"--u32 1x", "--u32 1x: must be a whole number from 0 to 4294967295"},
        {"--u32 0x1", "--u32 0x1: must be a whole number from 0 to 4294967295"},
        {"--u32 _", "--u32 : must be a whole number from 0 to 4294967295"},
        {"--u64 2", "--u64 2: must be a whole number from 3 to 18446744073709551615"},
        {"--u64 18446744073709551616", "--u64 18446744073709551616: must be a whole number from 3 "
                                       "to 18446744073709551615"},
        {"--real 2.6", "--real 2.6: must be a number from -0.5 to 2.5"},
        {"--real -0.6", "--real -0.6: must be a number from -0.5 to 2.5"},
        {"--real nan", "--real nan: must be a number from -0.5 to 2.5"},
        {"--real 1,5", "--real 1,5: must be a number from -0.5 to 2.5"},
        {"--size 63x64", "--size 63x64: not WxH with each from 64 to 4096, as 1280x720"},
        {"--size 64x4097", "--size 64x4097: not WxH with each from 64 to 4096, as 1280x720"},
        {"--size 64", "--size 64: not WxH with each from 64 to 4096, as 1280x720"},
        {"--size 64x64x", "--size 64x64x: not WxH with each from 64 to 4096, as 1280x720"},
        {"--choice four", "--choice four: not one of one, two, three, and-a-fourth"},
        {"--choice tw", "--choice tw: not one of one, two, three, and-a-fourth"},
        {"--choice one|two", "--choice one|two: not one of one, two, three, and-a-fourth"},
        {"--choice _", "--choice : not one of one, two, three, and-a-fourth"},
        {"--take bad", "--take bad: not good"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        refuses(&table, wrong[i][0], wrong[i][1]);
}

static void test_wrong_options(void **state)
{
    static const char *const wrong[][2] = {
        {"--frob", "--frob: no such option; see jolon-test --help"},
        {"--frob=3", "--frob=3: no such option; see jolon-test --help"},
        {"--flagx", "--flagx: no such option; see jolon-test --help"},
        {"-x", "-x: no such option; see jolon-test --help"},
        {"-fx", "-x: no such option; see jolon-test --help"},
        {"-xf", "-x: no such option; see jolon-test --help"},
        {"--text", "--text: its value is missing; see jolon-test --help"},
        {"--flag -w", "-w: its value is missing; see jolon-test --help"},
        {"--flag=1", "--flag=1: takes no value; see jolon-test --help"},
        {"--u 1", "--u: the beginning of several options; see jolon-test --help"},
        {"one two", "'two': one argument too many; see jolon-test --help"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        refuses(&table, wrong[i][0], wrong[i][1]);
}

static void test_a_long_word_leaves_room_for_what_would_be_right(void **state)
{
    char text[700] = "", copy[800];
    (void)state;
    memset(text, 'x', 600);
    (void)snprintf(copy, sizeof copy, "--u32 %s", text);
    assert_int_equal(read_line(&table, copy), -1);
    assert_non_null(strstr(error.text, "xxx: must be a whole number from 0 to 4294967295"));
    text[0] = text[1] = '-';
    assert_int_equal(read_line(&table, text), -1);
    assert_non_null(strstr(error.text, "xxx: no such option; see jolon-test --help"));
}

static void test_plain_arguments_go_to_the_end(void **state)
{
    (void)state;
    assert_int_equal(read_line(&table, "one --flag"), 1);
    assert_true(given.flag);
    assert_string_equal(words[2], "one");
    assert_int_equal(read_line(&table, "--text a -- --flag"), 1);
    assert_false(given.flag);
    assert_string_equal(words[4], "--flag");
    assert_int_equal(read_line(&table, "-"), 1);
    assert_int_equal(read_line(&table, "_"), 1);
}

static void test_more_rows(void **state)
{
    (void)state;
    takes("--alone --tail x");
    assert_string_equal(given.alone, "alone");
    assert_string_equal(given.text, "x");
}

static void test_only_options_that_the_usage_names(void **state)
{
    static const struct option_table verb = {.program = "jolon-test verb",
                                             .usage = "[--u64 N] [--choice-of-it] [--text TEXT]",
                                             .rows = rows,
                                             .usage_rows = true};
    (void)state;
    assert_int_equal(read_line(&verb, "--u64 5 --text x"), 0);
    refuses(&verb, "--u32 5",
            "--u32: jolon-test verb does not take it; see jolon-test verb --help");
    refuses(&verb, "--choice one",
            "--choice: jolon-test verb does not take it; see jolon-test verb --help");
    refuses(&verb, "-w x", "--world: jolon-test verb does not take it; see jolon-test verb --help");
}

static void test_the_verb_behind_options(void **state)
{
    static const struct {
        const char *line;
        int at;
    } verbs[] = {{"verb -w x", 1},      {"-w x verb --flag", 3}, {"-wx verb", 2},
                 {"--world=x verb", 2}, {"--flag verb", 2},      {"--frob verb", 2},
                 {"-w x", 3},           {"-- verb", 2}};
    (void)state;
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        int count = split(verbs[i].line);
        assert_int_equal(option_table_verb(&table, count, words), verbs[i].at);
    }
}

static void test_without_a_usage_there_is_no_help(void **state)
{
    static const struct option_table bare = {.program = "jolon-test", .rows = rows};
    (void)state;
    refuses(&bare, "--help", "--help: no such option; see jolon-test --help");
}

/* --- what ends the process ---------------------------------------------------------------------*/

static int pipe_end;

static int read_redirected(void *context)
{
    const char *text = context;
    dup2(pipe_end, STDOUT_FILENO);
    dup2(pipe_end, STDERR_FILENO);
    log_open("test");
    (void)option_table_read(&table, split(text), words);
    return 0;
}

/* Reads a line in a child, and keeps its exit code and output. */
static int end_with(const char *text, char *written, size_t bytes)
{
    char copy[64];
    int ends[2];
    (void)snprintf(copy, sizeof copy, "%s", text);
    assert_int_equal(pipe(ends), 0);
    pipe_end = ends[1];
    int code = child_run(read_redirected, copy);
    close(ends[1]);
    ssize_t length = read(ends[0], written, bytes - 1);
    assert_true(length >= 0);
    written[length] = '\0';
    close(ends[0]);
    return code;
}

static void test_help(void **state)
{
    static const char *const lines[] = {"--help", "-h", "--flag --help --frob", "one two --help"};
    char written[4096];
    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        assert_int_equal(end_with(lines[i], written, sizeof written), EXIT_OK);
        assert_string_equal(
            written,
            "usage: jolon-test [options] [FILE]\n"
            "Tests.\n"
            "  -w, --world NAME       the world (default \"default\")\n"
            "  -f, --flag             a flag\n"
            "  --text TEXT            a text whose help is so long that it does not fit into\n"
            "                         one line of the terminal and goes on\n"
            "  --choice one|two|three|and-a-fourth\n"
            "                         a choice\n"
            "  --parent PID           end when this process does\n"
            "  --no-sandbox           give up no privileges\n"
            "That is all.\n");
    }
}

static void test_wrong_usage_ends_with_2_and_one_line(void **state)
{
    char written[4096];
    (void)state;
    assert_int_equal(end_with("--u32 x", written, sizeof written), EXIT_USAGE);
    assert_string_equal(written,
                        "jolon-test: --u32 x: must be a whole number from 0 to 4294967295\n");
    assert_int_equal(end_with("--flag", written, sizeof written), 0);
    assert_string_equal(written, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_all_ways_to_write_an_option),
        cmocka_unit_test(test_of_repeated_options_the_last_wins),
        cmocka_unit_test(test_wrong_values),
        cmocka_unit_test(test_wrong_options),
        cmocka_unit_test(test_a_long_word_leaves_room_for_what_would_be_right),
        cmocka_unit_test(test_plain_arguments_go_to_the_end),
        cmocka_unit_test(test_more_rows),
        cmocka_unit_test(test_only_options_that_the_usage_names),
        cmocka_unit_test(test_the_verb_behind_options),
        cmocka_unit_test(test_without_a_usage_there_is_no_help),
        cmocka_unit_test(test_help),
        cmocka_unit_test(test_wrong_usage_ends_with_2_and_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
