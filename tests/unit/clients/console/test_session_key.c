/* Keys: how they are compared, and files of tokens. */
#include "clients/console/session_key.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void test_keys_are_equal_or_not(void **state)
{
    (void)state;
    assert_true(session_key_equal("abcd", "abcd"));
    assert_false(session_key_equal("abcd", "abce"));
    assert_false(session_key_equal("abcd", "Abcd"));
    assert_false(session_key_equal("abcd", "abc"));
    assert_false(session_key_equal("abcd", "abcdabcd"));
    assert_false(session_key_equal("abcd", ""));
    assert_false(session_key_equal("", ""));
    assert_false(session_key_equal("", "x"));
}

static int write_file(const char *path, const char *text, mode_t mode)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    bool good =
        fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text) && fchmod(fd, mode) == 0;
    close(fd);
    return good ? 0 : -1;
}

static void test_a_token_file_is_made_kept_and_checked(void **state)
{
    char path[64], first[SESSION_KEY_MAX], token[SESSION_KEY_MAX];
    struct error_text error;
    struct stat status;
    (void)state;
    (void)snprintf(path, sizeof path, "/tmp/jolon-token-%d", (int)getpid());
    assert_int_equal(session_key_file(first, path, &error), 0);
    assert_int_equal(strlen(first), 32);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0600);
    assert_int_equal(session_key_file(token, path, &error), 0);
    assert_string_equal(token, first);
    assert_int_equal(chmod(path, 0644), 0);
    assert_int_equal(session_key_file(token, path, &error), -1);
    assert_non_null(strstr(error.text, "others may read it"));
    static const char *const wrong[] = {"", "short\n", "0123456789abcdef 0\n",
                                        "0123456789abcdef\n0123456789abcdef\n"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(write_file(path, wrong[i], 0600), 0);
        assert_int_equal(session_key_file(token, path, &error), -1);
    }
    assert_int_equal(write_file(path, "0123456789abcdef\r\n", 0600), 0);
    assert_int_equal(session_key_file(token, path, &error), 0);
    assert_string_equal(token, "0123456789abcdef");
    assert_int_equal(unlink(path), 0);
    assert_int_equal(session_key_file(token, "/tmp", &error), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys_are_equal_or_not),
        cmocka_unit_test(test_a_token_file_is_made_kept_and_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
