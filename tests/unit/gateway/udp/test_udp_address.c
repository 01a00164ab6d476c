/* Addresses of UDP, and sockets on the loopback. */
#include "gateway/udp/udp_address.h"
#include "gateway/udp/udp_socket.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define SECOND_NS 1000000000u

static struct error_text error;

static void test_good_addresses(void **state)
{
    static const char *const pairs[][2] = {
        {"127.0.0.1", "127.0.0.1:3000"},
        {"127.0.0.1:1", "127.0.0.1:1"},
        {"::1", "[::1]:3000"},
        {"[::1]", "[::1]:3000"},
        {"[ff02::1]:65535", "[ff02::1]:65535"},
        {"239.1.2.3:3001", "239.1.2.3:3001"},
        {"2001:db8::1:3000", "[2001:db8::1:3000]:3000"}, /* an address of IPv6 as a whole */
    };
    (void)state;
    for (unsigned i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        struct udp_address address;
        char text[UDP_ADDRESS_TEXT];
        assert_int_equal(udp_address_parse(&address, pairs[i][0], 3000, &error), 0);
        assert_string_equal(udp_address_text(&address, text, sizeof text), pairs[i][1]);
    }
}

static void test_bad_addresses(void **state)
{
    static const char *const texts[] = {"",         "localhost",      "1.2.3", "1.2.3.4:0",
                                        "1.2.3.4:", "1.2.3.4:65536",  "[::1",  "[::1]x",
                                        "[1.2.3.4", "1.2.3.4:3000:1", ":3000", "[]:3000"};
    (void)state;
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct udp_address address;
        if (udp_address_parse(&address, texts[i], 3000, &error) == 0)
            fail_msg("%s is taken", texts[i]);
        assert_non_null(strstr(error.text, "127.0.0.1:3000"));
    }
}

static void test_kinds_of_addresses(void **state)
{
    struct udp_address group, loop, other, loop6;
    (void)state;
    assert_int_equal(udp_address_parse(&group, "239.1.2.3", 3000, &error), 0);
    assert_int_equal(udp_address_parse(&loop, "127.9.9.9", 3000, &error), 0);
    assert_int_equal(udp_address_parse(&other, "127.9.9.9:5", 3000, &error), 0);
    assert_int_equal(udp_address_parse(&loop6, "::1", 3000, &error), 0);
    assert_true(udp_address_multicast(&group) && !udp_address_loopback(&group));
    assert_true(udp_address_loopback(&loop) && !udp_address_multicast(&loop));
    assert_true(udp_address_loopback(&loop6) && !udp_address_multicast(&loop6));
    assert_true(udp_address_same_host(&loop, &other));
    assert_false(udp_address_same_host(&loop, &group) || udp_address_same_host(&loop, &loop6));
}

/* Opens a listener on a free port and a sender to it, and sends through both. */
static void send_to(const char *host, const char *interface)
{
    struct udp_address at, by, from;
    char bytes[16];
    assert_int_equal(udp_address_parse(&at, host, 3000, &error), 0);
    if (interface)
        assert_int_equal(udp_address_parse(&by, interface, 0, &error), 0);
    at.v4.sin_port = 0;
    int in = udp_socket_listener(&at, interface ? &by : NULL, &error);
    socklen_t length = sizeof at;
    assert_true(in >= 0);
    assert_int_equal(getsockname(in, &at.any, &length), 0);
    int out = udp_socket_sender(&at, interface ? &by : NULL, &error);
    assert_true(out >= 0);
    assert_int_equal(udp_socket_receive(in, bytes, sizeof bytes, &from), -1);
    assert_int_equal(udp_socket_send(out, &at, "hello", 5), 0);
    assert_true(udp_socket_wait(in, 5 * (uint64_t)SECOND_NS));
    assert_int_equal(udp_socket_receive(in, bytes, sizeof bytes, &from), 5);
    assert_memory_equal(bytes, "hello", 5);
    close(in);
    /* Nobody receives now. That is no error, however often it is tried. */
    for (int i = 0; i < 5; i++)
        assert_int_equal(udp_socket_send(out, &at, "hello", 5), 0);
    close(out);
}

static void test_sockets(void **state)
{
    (void)state;
    send_to("127.0.0.1", NULL);
    send_to("239.255.78.12", "127.0.0.1");
}

static void test_an_address_of_another_machine(void **state)
{
    struct udp_address at;
    (void)state;
    assert_int_equal(udp_address_parse(&at, "192.0.2.1", 3000, &error), 0);
    assert_int_equal(udp_socket_listener(&at, NULL, &error), -1);
    assert_non_null(strstr(error.text, "192.0.2.1:3000: cannot receive there"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_addresses),
        cmocka_unit_test(test_bad_addresses),
        cmocka_unit_test(test_kinds_of_addresses),
        cmocka_unit_test(test_sockets),
        cmocka_unit_test(test_an_address_of_another_machine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
