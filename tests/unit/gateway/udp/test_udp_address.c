/* Addresses of UDP, and sockets on the loopback. */
#include "gateway/udp/udp_address.h"
#include "gateway/udp/udp_interface.h"
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
    struct udp_address at, from;
    char bytes[16];
    unsigned by;
    assert_int_equal(udp_address_parse(&at, host, 3000, &error), 0);
    assert_int_equal(udp_interface_find(&by, interface, &error), 0);
    at.v4.sin_port = 0;
    int in = udp_socket_listener(&at, by, &error);
    socklen_t length = sizeof at;
    assert_true(in >= 0);
    assert_int_equal(getsockname(in, &at.any, &length), 0);
    int out = udp_socket_sender(&at, by, &error);
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
    send_to("127.0.0.1", "any");
    send_to("239.255.78.12", "127.0.0.1");
    send_to("239.255.78.12", "lo");
    send_to("127.255.255.255", "any"); /* a broadcast */
}

static void test_interfaces(void **state)
{
    unsigned lo, by;
    (void)state;
    assert_int_equal(udp_interface_find(&lo, "lo", &error), 0);
    assert_true(lo > 0);
    assert_int_equal(udp_interface_find(&by, "127.0.0.1", &error), 0);
    assert_int_equal(by, lo);
    assert_int_equal(udp_interface_find(&by, "any", &error), 0);
    assert_int_equal(by, 0);
    assert_int_equal(udp_interface_find(&by, "eth77", &error), -1);
    assert_ptr_equal(strstr(error.text, "is no interface of this machine"), error.text);
    assert_int_equal(udp_interface_find(&by, "192.0.2.1", &error), -1);
}

/* An address of one link needs its interface, and gets it. */
static void test_links(void **state)
{
    struct udp_address group, one, wide;
    unsigned lo;
    (void)state;
    assert_int_equal(udp_address_parse(&group, "[ff02::77]:3000", 0, &error), 0);
    assert_int_equal(udp_address_parse(&one, "[fe80::1]:3000", 0, &error), 0);
    assert_int_equal(udp_address_parse(&wide, "[ff05::77]:3000", 0, &error), 0);
    assert_true(udp_address_link_local(&group) && udp_address_link_local(&one));
    assert_false(udp_address_link_local(&wide));
    assert_int_equal(udp_socket_listener(&group, 0, &error), -1);
    assert_non_null(strstr(error.text, "[ff02::77]:3000: is an address of one link, and needs an "
                                       "interface: set gateway.interface"));
    assert_int_equal(udp_socket_sender(&one, 0, &error), -1);
    assert_int_equal(udp_interface_find(&lo, "lo", &error), 0);
    udp_address_scope(&group, lo);
    udp_address_scope(&wide, lo);
    assert_int_equal(group.v6.sin6_scope_id, lo);
    assert_int_equal(wide.v6.sin6_scope_id, 0);
    int probe = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (probe < 0)
        return; /* a machine without IPv6 */
    close(probe);
    group.v6.sin6_port = 0;
    int in = udp_socket_listener(&group, lo, &error);
    if (in < 0)
        fail_msg("%s", error.text);
    close(in);
}

/* What is sent to an address of this machine has one receiver, and the second is refused. A group
 * and a broadcast may have several. */
static void test_two_receivers(void **state)
{
    static const struct {
        const char *host;
        bool shared;
    } rows[] = {{"127.0.0.1", false}, {"239.255.78.12", true}, {"127.255.255.255", true}};
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        struct udp_address at;
        socklen_t length = sizeof at;
        assert_int_equal(udp_address_parse(&at, rows[i].host, 3000, &error), 0);
        at.v4.sin_port = 0;
        int first = udp_socket_listener(&at, 0, &error);
        assert_true(first >= 0);
        assert_int_equal(getsockname(first, &at.any, &length), 0);
        int second = udp_socket_listener(&at, 0, &error);
        assert_int_equal(second >= 0, rows[i].shared);
        if (second < 0)
            assert_non_null(strstr(error.text, "cannot receive there: another program does"));
        else
            close(second);
        close(first);
    }
}

static void test_the_port_of_a_sender(void **state)
{
    struct udp_address to, own;
    socklen_t length = sizeof own;
    (void)state;
    assert_int_equal(udp_address_parse(&to, "127.0.0.1:3000", 0, &error), 0);
    int out = udp_socket_sender(&to, 0, &error);
    uint16_t port = udp_socket_port(out, 0);
    assert_int_not_equal(port, 0);
    assert_int_equal(udp_socket_send(out, &to, "hello", 5), 0);
    assert_int_equal(getsockname(out, &own.any, &length), 0);
    assert_int_equal(udp_address_port(&own), port);
    int other = udp_socket_sender(&to, 0, &error); /* while the port is in use: another */
    uint16_t another = udp_socket_port(other, port);
    assert_true(another != 0 && another != port);
    close(other);
    close(out);
    out = udp_socket_sender(&to, 0, &error); /* a process that starts anew gets it again */
    assert_int_equal(udp_socket_port(out, port), port);
    close(out);
}

static void test_an_address_of_another_machine(void **state)
{
    struct udp_address at;
    (void)state;
    assert_int_equal(udp_address_parse(&at, "192.0.2.1", 3000, &error), 0);
    assert_int_equal(udp_socket_listener(&at, 0, &error), -1);
    assert_non_null(strstr(error.text, "192.0.2.1:3000: cannot receive there"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_addresses),
        cmocka_unit_test(test_bad_addresses),
        cmocka_unit_test(test_kinds_of_addresses),
        cmocka_unit_test(test_sockets),
        cmocka_unit_test(test_interfaces),
        cmocka_unit_test(test_links),
        cmocka_unit_test(test_two_receivers),
        cmocka_unit_test(test_the_port_of_a_sender),
        cmocka_unit_test(test_an_address_of_another_machine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
