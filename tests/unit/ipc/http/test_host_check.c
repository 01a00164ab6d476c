/* Names of this machine, and the origins of pages. */
#include "ipc/http/host_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_only_names_of_this_machine_are_ours(void **state)
{
    static const char *const ours[] = {"localhost", "localhost:8080", "127.0.0.1:1",
                                       "[::1]:80",  "LocalHost",      "127.0.0.2"};
    static const char *const others[] = {"evil.example",
                                         "localhost.evil.example",
                                         "",
                                         "127.0.0.1.evil.example",
                                         "127.evil.example",
                                         "[::1",
                                         "10.0.0.1"};
    (void)state;
    for (size_t i = 0; i < sizeof ours / sizeof ours[0]; i++)
        assert_true(http_host_local(ours[i]));
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        assert_false(http_host_local(others[i]));
    assert_true(http_host_numeric("10.0.0.1:8080"));
    assert_true(http_host_numeric("[fe80::1]:8080"));
    assert_false(http_host_numeric("evil.example"));
    assert_false(http_host_numeric("[evil.example]"));
    assert_true(http_origin_is("http://localhost:8080", "localhost:8080"));
    assert_false(http_origin_is("http://localhost:8081", "localhost:8080"));
    assert_false(http_origin_is("https://localhost:8080", "localhost:8080"));
    assert_false(http_origin_is("null", "localhost:8080"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_only_names_of_this_machine_are_ours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
