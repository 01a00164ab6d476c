/* sendmsg() and recvmsg() between two sockets of loopback: received datagrams are filtered, and
 * announcements go only to known participants. */
#include "ipc/topics/dds_datagrams.h"

#include <netinet/in.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

/* An announcement without addresses, so that its source counts: DATA of the participants' writer
 * with an empty parameter list. */
static const uint8_t come[] =
    "RTPS\2\1\1\20prefix-of-it\x15\x05\x1c\0\0\0\x10\0\0\1\0\xc7\0\1\0\xc2"
    "\0\0\0\0\1\0\0\0\0\3\0\0\1\0\0";
/* The same with a key instead of data. */
static const uint8_t go[] = "RTPS\2\1\1\20prefix-of-it\x15\x09\x1c\0\0\0\x10\0\0\1\0\xc7\0\1\0\xc2"
                            "\0\0\0\0\2\0\0\0\0\3\0\0\1\0\0";
/* DATA of another writer, with type information. */
static const uint8_t typed[] =
    "RTPS\2\1\1\20prefix-of-it\x15\x05\x24\0\0\0\x10\0\0\0\3\xc7\0\0\3\xc2"
    "\0\0\0\0\1\0\0\0\0\3\0\0\x75\0\4\0\1\2\3\4\1\0\0";

struct ends {
    int fd[2]; /* this side's, and the other's */
    struct sockaddr_in at[2];
};

static int open_ends(void **state)
{
    static struct ends ends;
    for (int i = 0; i < 2; i++) {
        socklen_t bytes = sizeof ends.at[i];
        ends.at[i] =
            (struct sockaddr_in){.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
        ends.fd[i] = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        if (ends.fd[i] < 0 || bind(ends.fd[i], (struct sockaddr *)&ends.at[i], bytes) != 0 ||
            getsockname(ends.fd[i], (struct sockaddr *)&ends.at[i], &bytes) != 0)
            return -1;
    }
    dds_datagrams_begin(true);
    *state = &ends;
    return 0;
}

static int close_ends(void **state)
{
    struct ends *ends = *state;
    close(ends->fd[0]);
    close(ends->fd[1]);
    return 0;
}

static void send_to_other(const struct ends *ends, const uint8_t *bytes, size_t length)
{
    uint8_t copy[128];
    struct sockaddr_in to = ends->at[1];
    /* In parts, as Cyclone DDS sends. */
    struct iovec parts[] = {{copy, 20}, {copy + 20, length - 20}};
    struct msghdr message = {
        .msg_name = &to, .msg_namelen = sizeof to, .msg_iov = parts, .msg_iovlen = 2};
    memcpy(copy, bytes, length);
    assert_int_equal(sendmsg(ends->fd[0], &message, 0), length);
}

/* Reads what the other side has received, without waiting. */
static bool other_got(const struct ends *ends)
{
    uint8_t bytes[128];
    return recv(ends->fd[1], bytes, sizeof bytes, MSG_DONTWAIT) > 0;
}

/* Sends from the other side, and reads by recvmsg(). */
static size_t hear(const struct ends *ends, const uint8_t *bytes, size_t length, uint8_t *heard)
{
    struct sockaddr_in from;
    struct iovec part = {heard, 128};
    struct msghdr message = {
        .msg_name = &from, .msg_namelen = sizeof from, .msg_iov = &part, .msg_iovlen = 1};
    assert_int_equal(sendto(ends->fd[1], bytes, length, 0, (const struct sockaddr *)&ends->at[0],
                            sizeof ends->at[0]),
                     length);
    ssize_t got = recvmsg(ends->fd[0], &message, 0);
    assert_true(got >= 0);
    return (size_t)got;
}

static void test_only_known_participants_get_announcements(void **state)
{
    const struct ends *ends = *state;
    uint8_t heard[128];
    send_to_other(ends, come, sizeof come);
    assert_false(other_got(ends));
    assert_int_equal(hear(ends, come, sizeof come, heard), sizeof come);
    send_to_other(ends, come, sizeof come);
    assert_true(other_got(ends));
    (void)hear(ends, go, sizeof go, heard);
    send_to_other(ends, come, sizeof come);
    assert_false(other_got(ends));
}

static void test_other_datagrams_are_sent(void **state)
{
    const struct ends *ends = *state;
    send_to_other(ends, typed, sizeof typed);
    assert_true(other_got(ends));
    dds_datagrams_begin(false);
    send_to_other(ends, come, sizeof come);
    assert_true(other_got(ends));
}

static void test_a_thousand_others_leave_room_for_the_last(void **state)
{
    const struct ends *ends = *state;
    uint8_t heard[128], forged[sizeof come - 4 + 28 + 4];
    /* Own locators, parameter 0x32, before the end of the list. */
    memcpy(forged, come, sizeof come - 4);
    uint8_t *locator = forged + sizeof come - 4;
    memset(locator, 0, 32);
    memcpy(locator, "\x32\0\x18\0\1\0\0\0", 8);
    memcpy(locator + 24, "\x7f\0\0\1\1\0\0\0", 8);
    forged[22] = (uint8_t)(sizeof forged - 24);
    for (uint32_t i = 1; i <= 3000; i++) {
        memcpy(locator + 8, &i, sizeof i);
        (void)hear(ends, forged, sizeof forged, heard);
    }
    (void)hear(ends, come, sizeof come, heard);
    send_to_other(ends, come, sizeof come);
    assert_true(other_got(ends));
}

static void test_received_datagrams_are_filtered(void **state)
{
    const struct ends *ends = *state;
    uint8_t heard[128], fragment[sizeof typed];
    (void)hear(ends, typed, sizeof typed, heard);
    assert_int_equal(heard[48], 0x75);
    assert_int_equal(heard[49], 0x80);
    memcpy(fragment, typed, sizeof typed);
    fragment[20] = 0x16;
    assert_int_equal(hear(ends, fragment, sizeof fragment, heard), sizeof fragment);
    assert_int_equal(heard[0], 0); /* no longer RTPS */
}

static void test_other_messages_are_left_alone(void **state)
{
    const struct ends *ends = *state;
    const uint8_t text[] = "no such thing";
    uint8_t heard[128];
    assert_int_equal(hear(ends, text, sizeof text, heard), sizeof text);
    assert_memory_equal(heard, text, sizeof text);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, open_ends, close_ends)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_only_known_participants_get_announcements),
        TEST(test_other_datagrams_are_sent),
        TEST(test_a_thousand_others_leave_room_for_the_last),
        TEST(test_received_datagrams_are_filtered),
        TEST(test_other_messages_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
