/* Addresses of the Internet in numbers, and ranges of them. */
#include "world/runtime/internet_address.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;

static void test_addresses(void **state)
{
    static const char *const bad[] = {
        "",          "]",           "[",        "localhost",   "1.2.3",
        "1.2.3.4:0", "[1.2.3.4]:1", "1.2.3.4 ", "[::1]:70000", "::1]:5"};
    struct internet_address address;
    (void)state;
    assert_int_equal(internet_address_read(&address, "10.1.2.3:4242", 7, &error), 0);
    assert_false(address.ipv6);
    assert_memory_equal(address.bytes, ((uint8_t[]){10, 1, 2, 3}), 4);
    assert_int_equal(address.port, 4242);
    assert_int_equal(internet_address_read(&address, "[ff02::1]:9", 7, &error), 0);
    assert_true(address.ipv6);
    assert_int_equal(address.bytes[0], 0xff);
    assert_int_equal(address.bytes[15], 1);
    assert_int_equal(address.port, 9);
    assert_int_equal(internet_address_read(&address, "::1", 7, &error), 0);
    assert_int_equal(address.port, 7);
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        if (internet_address_read(&address, bad[i], 7, &error) == 0)
            fail_msg("%s is taken", bad[i]);
    }
}

static void test_ranges(void **state)
{
    static const struct {
        const char *range, *address;
        bool in;
    } rows[] = {
        {"10.1.2.3", "10.1.2.3", true},
        {"10.1.2.3", "10.1.2.2", false},
        {"10.1.0.0/16", "10.1.255.7", true},
        {"10.1.0.0/16", "10.2.0.0", false},
        {"10.1.2.3/15", "10.0.0.0", true}, /* only the first bits count */
        {"10.1.2.128/25", "10.1.2.127", false},
        {"10.1.2.128/25", "10.1.2.129", true},
        {"0.0.0.0/0", "255.255.255.255", true},
        {"0.0.0.0/0", "::1", false},
        {"::/0", "::1", true},
        {"::/0", "10.1.2.3", false},
        {"fd00::/8", "fd12:3456::9", true},
        {"fd00::/8", "fe80::1", false},
        {"::1", "::1", true},
        {"2001:db8::/33", "2001:db8:8000::1", false},
        {"10.1.0.0/16", "::ffff:10.1.2.3", true}, /* as a socket of both kinds shows it */
        {"10.1.0.0/16", "::fffe:10.1.2.3", false},
    };
    static const char *const bad[] = {"",        "10.1.0.0/33", "10.1.0.0/", "::/129",
                                      "10.1/16", "10.1.0.0/-1", "all"};
    struct internet_address_range range;
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct internet_address address;
        assert_int_equal(internet_address_range_read(&range, rows[i].range, &error), 0);
        assert_int_equal(internet_address_read(&address, rows[i].address, 0, &error), 0);
        if (internet_address_in(&address, &range) != rows[i].in)
            fail_msg("%s in %s", rows[i].address, rows[i].range);
    }
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        if (internet_address_range_read(&range, bad[i], &error) == 0)
            fail_msg("%s is taken", bad[i]);
        assert_non_null(strstr(error.text, "10.1.0.0/16"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_addresses),
        cmocka_unit_test(test_ranges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
