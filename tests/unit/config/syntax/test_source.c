/* Sources: which files are opened for a name, how much of them is read, and what is refused before
 * it is parsed. */
#include "config/syntax/source.h"

#include "config/syntax/literals.h"
#include "config/syntax/schema.h"
#include "tests/support/quick_config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static struct error_text error;

/* --- names that came out of files --------------------------------------------------------------*/

static char folder[128]; /* with everything below in it */

static const char *in_folder(const char *name)
{
    static char path[256];

    snprintf(path, sizeof(path), "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    char outside[128];

    if (quick_config_make(state) != 0)
        return -1;
    snprintf(folder, sizeof(folder), "%s/in", quick_config.folder);
    snprintf(outside, sizeof(outside), "%s/outside", quick_config.folder);
    snprintf(address.sun_path, sizeof(address.sun_path), "%s/in/socket", quick_config.folder);
    if (mkdir(folder, 0700) != 0 || mkdir(in_folder("folder"), 0700) != 0)
        return -1;
    quick_config_write(in_folder("file"), "four");
    quick_config_write(in_folder("folder/file"), "");
    quick_config_write(outside, "secret");
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    int bound = bind(fd, (const struct sockaddr *)&address, sizeof(address));
    close(fd);
    return bound != 0 || symlink("../outside", in_folder("link-out")) != 0 ||
                   symlink("file", in_folder("link")) != 0 ||
                   symlink("/dev/zero", in_folder("link-device")) != 0 ||
                   symlink("nowhere", in_folder("link-nowhere")) != 0 ||
                   symlink("link-self", in_folder("link-self")) != 0 ||
                   mkfifo(in_folder("pipe"), 0600) != 0
               ? -1
               : 0;
}

static void test_names_stay_in_their_folder(void **state)
{
    static const struct {
        const char *name, *says;
    } rows[] = {
        {"link-out", "is a symbolic link; allowed: a regular file"},
        {"link", "is a symbolic link; allowed: a regular file"},
        {"link-device", "is a symbolic link; allowed: a regular file"},
        {"link-nowhere", "is a symbolic link; allowed: a regular file"},
        {"link-self", "is a symbolic link; allowed: a regular file"},
        {"pipe", "is a pipe; allowed: a regular file"},
        {"socket", "is a socket; allowed: a regular file"},
        {"folder", "is a directory; allowed: a regular file"},
        {"none", "cannot be opened: No such file or directory"},
        {"", "is not the name of a file in "},
        {".", "is not the name of a file in "},
        {"..", "is not the name of a file in "},
        {"../outside", "is not the name of a file in "},
        {"folder/file", "is not the name of a file in "},
        {"folder/../file", "is not the name of a file in "},
        {"/etc/passwd", "is not the name of a file in "},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct source source;
        char want[512];

        snprintf(want, sizeof(want), "%s/%s: %s", folder, rows[i].name, rows[i].says);
        assert_int_equal(source_read_in(&source, folder, rows[i].name, 100, &error), -1);
        assert_null(source.text);
        if (strncmp(error.text, want, strlen(want)) != 0)
            fail_msg("refused as\n  %s\ninstead of\n  %s", error.text, want);
    }
}

static void test_size_is_capped(void **state)
{
    struct source source;

    (void)state;
    assert_int_equal(source_read_in(&source, folder, "file", 4, &error), 0);
    assert_int_equal(source.bytes, 4);
    assert_string_equal(source.text, "four");
    assert_string_equal(source.path, in_folder("file"));
    source_free(&source);
    assert_int_equal(source_read_in(&source, folder, "file", 3, &error), -1);
    assert_non_null(strstr(error.text, "file: has 4 bytes; allowed: up to 3"));
}

/* --- names that the user gave ------------------------------------------------------------------*/

/* May be a link, and lie anywhere; must be a file. */
static void test_users_paths(void **state)
{
    struct source source;

    (void)state;
    assert_int_equal(source_read(&source, in_folder("link-out"), 100, &error), 0);
    assert_string_equal(source.text, "secret");
    source_free(&source);
    assert_int_equal(source_read(&source, in_folder("link-device"), 100, &error), -1);
    assert_non_null(strstr(error.text, "is a device; allowed: a regular file"));
    assert_int_equal(source_read(&source, in_folder("pipe"), 100, &error), -1);
    assert_non_null(strstr(error.text, "is a pipe; allowed: a regular file"));
    assert_int_equal(source_read(&source, in_folder("link-self"), 100, &error), -1);
    assert_non_null(strstr(error.text, "cannot be opened: Too many levels of symbolic links"));
}

/* --- shape -------------------------------------------------------------------------------------*/

static void test_measure(void **state)
{
    static const struct {
        const char *text;
        uint32_t deepest, fullest;
        int deepest_line, fullest_line, open_line;
    } rows[] = {
        {"", 0, 0, 0, 0, 0},
        {"a = 1;\nb : 2;", 0, 2, 0, 2, 0},
        {"a = (\n[1], { b = 2; }\n, { c = 3; d = 4;\n e = 5; } );", 2, 3, 2, 4, 0},
        {"# ((( = = =\n// (((\n/* (((\n*/ a = \"(((\n===\\\"((\";\n(", 1, 1, 6, 4, 0},
        {"))) a = ( )", 1, 1, 1, 1, 0},
        {"/*/ ( */ (", 1, 0, 1, 0, 0},
        {"\n\"( never closed", 0, 0, 0, 0, 2},
        {"\n\"( never closed\\\"", 0, 0, 0, 0, 2},
        {"\"\\\\\" \"", 0, 0, 0, 0, 1},
        {"\n\n/* never closed *", 0, 0, 0, 0, 3},
        {"# \" /*", 0, 0, 0, 0, 0},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct literals_shape shape;

        literals_measure(rows[i].text, &shape);
        assert_int_equal(shape.deepest, rows[i].deepest);
        assert_int_equal(shape.fullest, rows[i].fullest);
        assert_int_equal(shape.deepest_line, rows[i].deepest_line);
        assert_int_equal(shape.fullest_line, rows[i].fullest_line);
        assert_int_equal(shape.open_line, rows[i].open_line);
    }
}

/* Parses a text that repeats a part, "@" in it being its number; returns whether it was taken. */
static bool parses(const char *begin, const char *part, size_t times, const char *end)
{
    static char text[65536];
    struct source source = {.path = "a.cfg", .text = text};
    config_t config = {0};
    size_t used = (size_t)snprintf(text, sizeof(text), "%s", begin);

    for (size_t i = 0; i < times; i++) {
        for (const char *c = part; *c != '\0'; c++)
            used += *c == '@' ? (size_t)snprintf(text + used, sizeof(text) - used, "%zu", i)
                              : (size_t)snprintf(text + used, sizeof(text) - used, "%c", *c);
    }
    source.bytes = used + (size_t)snprintf(text + used, sizeof(text) - used, "%s", end);
    int result = source_parse(&source, &config, &error);
    config_destroy(&config);
    return result == 0;
}

/* The parser alone takes the rest of such a file for nothing. */
static void test_open_strings_are_refused(void **state)
{
    (void)state;
    assert_false(parses("a = 1;\nb = \"x; c = 2;\n", "", 0, ""));
    assert_string_equal(error.text, "a.cfg:2: has a string or comment that never ends; right "
                                    "would be: a closing \" or */");
    assert_false(parses("a = 1;\n", "", 0, "\"left out"));
    assert_false(parses("a = 1;\n", "", 0, "/* left out"));
    assert_true(parses("a = 1;\n", "", 0, "// left out"));
}

static void test_deep_and_full_are_refused(void **state)
{
    (void)state;
    assert_true(parses("a = ((((((((1))))))));", "", 0, ""));
    assert_false(parses("a =\n(((((((((1)))))))));", "", 0, ""));
    assert_string_equal(error.text, "a.cfg:2: is nested 9 deep; allowed: up to 8 levels of ( [ {");
    assert_false(parses("a = ", "(", 60000, ""));
    assert_non_null(strstr(error.text, "is nested 60000 deep; allowed: up to 8"));
    assert_true(parses("g = {\n", "k@ = 1;", SCHEMA_MEMBERS_MAX, "};"));
    assert_false(parses("g = {\n", "k@ = 1;\n", SCHEMA_MEMBERS_MAX + 1, "};"));
    assert_non_null(strstr(error.text, "is a group of 129 keys; allowed: up to 128"));
    /* Each entry of a list counts alone. */
    assert_true(parses("l = (\n", "{ a = @; },", 1000, "{ a = 1; } );"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_stay_in_their_folder),
        cmocka_unit_test(test_size_is_capped),
        cmocka_unit_test(test_users_paths),
        cmocka_unit_test(test_measure),
        cmocka_unit_test(test_open_strings_are_refused),
        cmocka_unit_test(test_deep_and_full_are_refused),
    };

    return cmocka_run_group_tests(tests, make_folder, quick_config_remove);
}
