/* The lists in the gateway's settings. */
#include "world/gateway_lists.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;

static void test_peers(void **state)
{
    struct gateway_lists_peers peers;
    struct internet_address address;
    (void)state;
    assert_int_equal(gateway_lists_peers(&peers, "127.0.0.0/8, ::1,10.0.0.7", &error), 0);
    assert_int_equal(peers.count, 3);
    assert_int_equal(internet_address_read(&address, "10.0.0.7:3000", 0, &error), 0);
    assert_true(gateway_lists_has_peer(&peers, &address));
    assert_int_equal(internet_address_read(&address, "10.0.0.8", 0, &error), 0);
    assert_false(gateway_lists_has_peer(&peers, &address));
    assert_int_equal(gateway_lists_peers(&peers, "none", &error), 0);
    assert_false(gateway_lists_has_peer(&peers, &address));
    assert_int_equal(gateway_lists_peers(&peers, "", &error), 0);
    assert_int_equal(peers.count, 0);
}

static void test_control(void **state)
{
    struct gateway_lists_control control;
    (void)state;
    assert_int_equal(gateway_lists_control(&control, "7:1, 8:*", &error), 0);
    assert_true(gateway_lists_has_control(&control, 7, 1));
    assert_false(gateway_lists_has_control(&control, 7, 2));
    assert_true(gateway_lists_has_control(&control, 8, 65533));
    assert_false(gateway_lists_has_control(&control, 9, 1));
    assert_int_equal(gateway_lists_control(&control, "none", &error), 0);
    assert_false(gateway_lists_has_control(&control, 7, 1));
}

static void test_refusals(void **state)
{
    static const char *const bad_peers[] = {"localhost", "10.0.0.1;10.0.0.2", ",10.0.0.1",
                                            "10.0.0.1,,10.0.0.2", "10.0.0.0/40"},
                             *const bad_control[] = {"7",   "0:1",   "7:0", "7:65534", "65534:1",
                                                     "*:1", "7:1:1", ":",   "7:",      "a:b"};
    struct gateway_lists_peers peers;
    struct gateway_lists_control control;
    char many[256] = "";
    (void)state;
    for (unsigned i = 0; i < sizeof bad_peers / sizeof bad_peers[0]; i++) {
        if (gateway_lists_peers(&peers, bad_peers[i], &error) == 0)
            fail_msg("%s is taken", bad_peers[i]);
    }
    for (unsigned i = 0; i < sizeof bad_control / sizeof bad_control[0]; i++) {
        if (gateway_lists_control(&control, bad_control[i], &error) == 0)
            fail_msg("%s is taken", bad_control[i]);
        assert_non_null(strstr(error.text, "SITE:APPLICATION"));
    }
    for (unsigned i = 0; i <= GATEWAY_LISTS_MAX; i++)
        strcat(many, "10.0.0.1,");
    assert_int_equal(gateway_lists_peers(&peers, many, &error), -1);
    assert_non_null(strstr(error.text, "more than 16 members"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_peers),
        cmocka_unit_test(test_control),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
