/* Simulation management: which requests are obeyed, what is acknowledged, and when. The commands go
 * to a link of the test, the acknowledgements to a socket on the loopback. */
#include "gateway/management.h"

#include "gateway/pdu/pdu_read.h"
#include "gateway/pdu/timestamp.h"
#include "gateway/udp/udp_socket.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define COMMANDS_MAX 256
#define UTC_S        1795838582.0

static struct management management;
static struct pdu_output output;
static struct error_text error;
static jolon_Command sent[COMMANDS_MAX];
static jolon_CommandReply reply;
static bool replies;
static int commands, listener, count;
static struct pdu received[64];
static uint64_t now_ns;

/* --- the link ----------------------------------------------------------------------------------*/

static void take_command(void *self, const jolon_Command *command)
{
    (void)self;
    assert_true(commands < COMMANDS_MAX);
    sent[commands++] = *command;
}

static bool give_reply(void *self, jolon_CommandReply *to)
{
    (void)self;
    *to = reply;
    bool given = replies;
    replies = false;
    return given;
}

static bool reachable(void *self)
{
    (void)self;
    return true;
}

static int descriptor(void *self)
{
    (void)self;
    return -1;
}

static const struct command_transport transport = {take_command, give_reply, reachable, descriptor};

/* The mover answers command i. */
static void answer(int i, jolon_CommandResult result)
{
    reply = (jolon_CommandReply){.source = sent[i].source,
                                 .sequence = sent[i].sequence,
                                 .type = sent[i].type,
                                 .result = result};
    replies = true;
}

static int set_up(void **state)
{
    struct udp_address at;
    socklen_t length = sizeof at;
    (void)state;
    now_ns = 1000000000000u;
    commands = 0;
    replies = false;
    output = (struct pdu_output){.version = 7, .exercise = 3};
    assert_int_equal(udp_address_parse(&at, "127.0.0.1", 3000, &error), 0);
    at.v4.sin_port = 0;
    listener = udp_socket_listener(&at, NULL, &error);
    assert_true(listener >= 0);
    assert_int_equal(getsockname(listener, &at.any, &length), 0);
    assert_int_equal(pdu_output_open(&output, "127.0.0.1", udp_address_port(&at), 100000, &error),
                     0);
    assert_int_equal(management_open(&management, &output, (struct entity_ids){1991, 36, 2},
                                     "7:1, 8:*", (struct command_link){&transport, NULL}, &error),
                     0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    close(output.udp.socket);
    close(listener);
    return 0;
}

static void receive(void)
{
    static uint8_t bytes[2048];
    struct udp_address from;
    int size;
    count = 0;
    while ((size = udp_socket_receive(listener, bytes, sizeof bytes, &from)) >= 0) {
        struct pdu_cursor cursor = {bytes, (size_t)size, 0};
        assert_true(count < 64);
        assert_int_equal(pdu_read(&cursor, &received[count]), PDU_GOOD);
        assert_int_equal(received[count++].header.type, PDU_ACKNOWLEDGE);
    }
}

static void poll_at(double utc_s)
{
    management_poll(&management, now_ns, utc_s);
    receive();
}

/* --- requests ----------------------------------------------------------------------------------*/

static struct pdu request_of(uint8_t type, uint32_t number)
{
    return (struct pdu){
        .header = {.version = 7, .exercise = 3, .type = type},
        .management = {.originator = {7, 1, 0}, .receiver = {1991, 36, 0}, .request = number}};
}

static void give(const struct pdu *pdu)
{
    management_receive(&management, pdu, now_ns, UTC_S);
    receive();
}

static void assert_acknowledged(int i, uint16_t what, uint16_t response, uint32_t number)
{
    const struct pdu_management *body = &received[i].management;
    assert_true(i < count);
    assert_int_equal(body->acknowledge, what);
    assert_int_equal(body->response, response);
    assert_int_equal(body->request, number);
    assert_int_equal(body->originator.site, 1991);
    assert_int_equal(body->originator.application, 36);
    assert_int_equal(body->originator.entity, 0);
    assert_int_equal(body->receiver.site, 7);
    assert_int_equal(body->receiver.application, 1);
}

static void test_stop_and_start(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 77), start = request_of(PDU_START_RESUME, 78);
    (void)state;
    give(&stop);
    assert_int_equal(commands, 1);
    assert_int_equal(sent[0].type, jolon_COMMAND_PAUSE);
    assert_int_equal(count, 0); /* not before the world has done it */
    answer(0, jolon_RESULT_DONE);
    poll_at(UTC_S);
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 77);
    give(&start);
    assert_int_equal(commands, 2);
    assert_int_equal(sent[1].type, jolon_COMMAND_RESUME);
    answer(1, jolon_RESULT_DONE);
    poll_at(UTC_S);
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_START, PDU_RESPONSE_ABLE, 78);
}

static void test_who_is_allowed(void **state)
{
    static const struct {
        uint16_t site, application;
        bool allowed;
    } rows[] = {{7, 1, true}, {7, 2, false}, {8, 99, true}, {9, 1, false}, {1991, 1, false}};
    uint64_t refused = 0;
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct pdu stop = request_of(PDU_STOP_FREEZE, i);
        int before = commands;
        stop.management.originator = (struct pdu_id){rows[i].site, rows[i].application, 5};
        give(&stop);
        assert_int_equal(commands - before, rows[i].allowed);
        assert_int_equal(count, 0);
        refused += !rows[i].allowed;
        assert_int_equal(management.refused, refused);
    }
}

static void test_who_is_meant(void **state)
{
    static const struct {
        struct pdu_id receiver;
        bool ours;
    } rows[] = {{{1991, 36, 0}, true},          {{1991, 37, 0}, true},
                {{1991, 38, 0}, false},         {{1991, 35, 0}, false},
                {{1990, 36, 0}, false},         {{PDU_ID_ALL, PDU_ID_ALL, PDU_ID_ALL}, true},
                {{1991, PDU_ID_ALL, 0}, true},  {{PDU_ID_ALL, 36, PDU_ID_ALL}, true},
                {{1990, PDU_ID_ALL, 0}, false}, {{0, 0, 0}, false}};
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct pdu stop = request_of(PDU_STOP_FREEZE, i);
        int before = commands;
        stop.management.receiver = rows[i].receiver;
        give(&stop);
        if ((commands - before == 1) != rows[i].ours)
            fail_msg("row %u", i);
        assert_int_equal(count, 0);
    }
    assert_int_equal(management.refused, 0);
}

/* A request that comes three times is carried out once and acknowledged three times. */
static void test_repetitions(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 5);
    (void)state;
    give(&stop);
    give(&stop);
    assert_int_equal(count, 0);
    answer(0, jolon_RESULT_DONE);
    poll_at(UTC_S);
    assert_int_equal(count, 2);
    assert_acknowledged(1, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 5);
    give(&stop);
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 5);
    assert_int_equal(commands, 1);
    struct pdu start = request_of(PDU_START_RESUME, 5); /* another request: of another type, */
    give(&start);
    assert_int_equal(commands, 2);
    stop.management.originator = (struct pdu_id){8, 1, 0}; /* and of another sender */
    give(&stop);
    assert_int_equal(commands, 3);
}

static struct pdu_clock clock_of(double utc_s)
{
    double hours = floor(utc_s / 3600.0);
    return (struct pdu_clock){(int32_t)hours, timestamp_of(utc_s - 3600.0 * hours, true)};
}

static void test_the_time_of_a_start(void **state)
{
    struct pdu start = request_of(PDU_START_RESUME, 9);
    (void)state;
    start.management.real_time = clock_of(UTC_S + 2.0);
    give(&start);
    assert_int_equal(commands, 0);
    assert_int_equal(count, 1); /* it will be carried out */
    assert_acknowledged(0, PDU_ACKNOWLEDGE_START, PDU_RESPONSE_ABLE, 9);
    give(&start);
    assert_int_equal(count, 1);
    poll_at(UTC_S + 1.99);
    assert_int_equal(commands, 0);
    poll_at(UTC_S + 2.01);
    assert_int_equal(commands, 1);
    assert_int_equal(sent[0].type, jolon_COMMAND_RESUME);
    answer(0, jolon_RESULT_DONE);
    poll_at(UTC_S + 2.1);
    assert_int_equal(count, 0);
    start.management.request = 10; /* in the past: at once */
    start.management.real_time = clock_of(UTC_S - 5000.0);
    give(&start);
    assert_int_equal(commands, 2);
    start.management.request = 11; /* a clock that is an hour wrong */
    start.management.real_time = clock_of(UTC_S + 3601.0);
    give(&start);
    assert_int_equal(commands, 2);
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_START, PDU_RESPONSE_UNABLE, 11);
}

static void test_what_cannot_be_done(void **state)
{
    struct pdu one = request_of(PDU_STOP_FREEZE, 1), stop = request_of(PDU_STOP_FREEZE, 2),
               create = request_of(PDU_CREATE, 3), remove_one = request_of(PDU_REMOVE, 4),
               acknowledge = request_of(PDU_ACKNOWLEDGE, 5);
    (void)state;
    one.management.receiver.entity = 12; /* of ours, not the whole */
    give(&one);
    assert_int_equal(commands, 0);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_UNABLE, 1);
    give(&create);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_CREATE, PDU_RESPONSE_UNABLE, 3);
    give(&remove_one);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_REMOVE, PDU_RESPONSE_UNABLE, 4);
    give(&acknowledge); /* of others: nothing to do */
    assert_int_equal(count, 0);
    give(&stop);
    answer(0, jolon_RESULT_CANNOT);
    poll_at(UTC_S);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_UNABLE, 2);
    assert_int_equal(commands, 1);
}

/* A world whose mover is dead does not answer. The command is repeated under its number, and the
 * request answered when its time is over. */
static void test_no_answer(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 6);
    (void)state;
    give(&stop);
    now_ns += MANAGEMENT_ANSWER_NS - 1;
    poll_at(UTC_S + 3.0);
    assert_int_equal(count, 0);
    now_ns += 1;
    poll_at(UTC_S + 3.0);
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_UNABLE, 6);
    for (int i = 1; i < commands; i++)
        assert_int_equal(sent[i].sequence, sent[0].sequence);
}

/* Requests without end neither grow the memory nor disturb an earlier one that is known. */
static void test_many_requests(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3 * MANAGEMENT_REQUESTS; i++) {
        struct pdu stop = request_of(PDU_STOP_FREEZE, i);
        give(&stop);
        answer(commands - 1, jolon_RESULT_DONE);
        poll_at(UTC_S);
        assert_int_equal(count, 1);
        assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, i);
    }
    assert_int_equal(commands, 3 * MANAGEMENT_REQUESTS);
    struct pdu last = request_of(PDU_STOP_FREEZE, 3 * MANAGEMENT_REQUESTS - 1);
    give(&last);
    assert_int_equal(commands, 3 * MANAGEMENT_REQUESTS);
    assert_int_equal(count, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_stop_and_start), TEST(test_who_is_allowed),      TEST(test_who_is_meant),
        TEST(test_repetitions),    TEST(test_the_time_of_a_start), TEST(test_what_cannot_be_done),
        TEST(test_no_answer),      TEST(test_many_requests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
