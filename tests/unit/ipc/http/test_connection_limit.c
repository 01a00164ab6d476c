/* The connections of a server: which is shut when all slots are taken, and which exceed their
 * time. */
#include "ipc/http/connection_limit.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define SECOND 1000000000ull
#define PAIRS  3

static struct connection_limit limit;
static int pair[PAIRS][2];
static struct connection *connection[PAIRS];

/* The first connections; a test checks whether they are shut. */
static int set_up(void **state)
{
    (void)state;
    limit = (struct connection_limit){.slots = CONNECTION_SLOTS_MAX};
    for (unsigned i = 0; i < PAIRS; i++) {
        if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair[i]) != 0)
            return -1;
        connection[i] = connection_come(&limit, pair[i][0], SECOND + i);
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (int i = 0; i < PAIRS; i++) {
        close(pair[i][0]);
        close(pair[i][1]);
    }
    return 0;
}

/* The peer of a socket that is shut reads end of file. */
static bool is_shut(int i)
{
    char byte;
    return recv(pair[i][1], &byte, 1, MSG_DONTWAIT) == 0;
}

static struct connection *come(uint64_t now_ns)
{
    struct connection *new_one = connection_come(&limit, -1, now_ns);
    assert_non_null(new_one);
    return new_one;
}

static void fill_with_newcomers(uint64_t now_ns)
{
    while (limit.taken < limit.slots)
        come(now_ns);
}

static void fill_with_askers(uint64_t now_ns)
{
    while (limit.taken < limit.slots)
        connection_note(come(now_ns), CONNECTION_ASKING, now_ns + 1);
    for (uint32_t i = 0; i < limit.slots; i++)
        limit.connection[i].asked = true;
}

static void test_silent_connections_are_shut_first(void **state)
{
    (void)state;
    connection_note(connection[0], CONNECTION_ANSWERING, SECOND); /* older, but it has asked */
    connection_note(connection[0], CONNECTION_ASKING, SECOND);
    fill_with_newcomers(3 * SECOND);
    assert_false(is_shut(1));
    come(3 * SECOND);
    assert_true(is_shut(1));
    assert_false(is_shut(0));
    assert_false(is_shut(2));
    come(3 * SECOND);
    assert_true(is_shut(2));
    assert_false(is_shut(0));
}

static void test_a_new_connection_has_time_to_ask(void **state)
{
    (void)state;
    for (int i = 0; i < PAIRS; i++)
        connection_note(connection[i], CONNECTION_ANSWERING, (2 + (unsigned)i) * SECOND);
    fill_with_askers(9 * SECOND);
    for (int i = 0; i < PAIRS; i++) { /* those without progress for longest */
        assert_false(is_shut(i));
        struct connection *newcomer = come(9 * SECOND);
        assert_true(is_shut(i));
        assert_false(newcomer->ending);
    }
}

static void test_connections_with_progress_stay(void **state)
{
    (void)state;
    connection_note(connection[0], CONNECTION_ANSWERING, 2 * SECOND); /* takes nothing */
    connection_note(connection[1], CONNECTION_WAITING, 2 * SECOND);   /* waits for the server */
    connection_note(connection[2], CONNECTION_ANSWERING, 2 * SECOND);
    fill_with_askers(3 * SECOND);
    connection_note(connection[2], CONNECTION_ANSWERING, 4 * SECOND); /* took a part */
    come(5 * SECOND);
    come(5 * SECOND);
    assert_true(is_shut(0));
    assert_false(is_shut(1));
    assert_false(is_shut(2));
}

static void test_room_is_limited(void **state)
{
    (void)state;
    while (limit.taken < CONNECTION_ROOM(limit.slots))
        come(2 * SECOND);
    assert_null(connection_come(&limit, -1, 2 * SECOND));
    connection_leave(&limit, connection[1]);
    assert_ptr_equal(connection_come(&limit, -1, 2 * SECOND), connection[1]);
}

static void test_connections_out_of_time_are_shut(void **state)
{
    (void)state;
    connection_note(connection[0], CONNECTION_ANSWERING, SECOND);
    connection_note(connection[1], CONNECTION_WAITING, SECOND);
    connection_note(connection[2], CONNECTION_ASKING, SECOND);
    connection_sweep(&limit, SECOND + CONNECTION_ASKING_NS);
    assert_false(is_shut(2));
    connection_sweep(&limit, SECOND + CONNECTION_ASKING_NS + 1);
    assert_true(is_shut(2));
    assert_false(is_shut(0));
    connection_sweep(&limit, SECOND + CONNECTION_ANSWERING_NS + 1);
    assert_true(is_shut(0));
    assert_false(is_shut(1));
}

static void test_only_an_answer_that_is_not_taken_stalls(void **state)
{
    (void)state;
    connection_note(connection[0], CONNECTION_ANSWERING, SECOND);
    assert_false(connection_stalls(connection[0], SECOND, 2 * SECOND));
    assert_true(connection_stalls(connection[0], SECOND, 2 * SECOND + 1));
    connection_note(connection[0], CONNECTION_WAITING, SECOND);
    assert_false(connection_stalls(connection[0], SECOND, 9 * SECOND));
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_silent_connections_are_shut_first),
        TEST(test_a_new_connection_has_time_to_ask),
        TEST(test_connections_with_progress_stay),
        TEST(test_room_is_limited),
        TEST(test_connections_out_of_time_are_shut),
        TEST(test_only_an_answer_that_is_not_taken_stalls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
