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
static struct management_notes notes;
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

/* A gateway that starts, or that starts anew and finds the notes of the one before. */
static void open_management(void)
{
    assert_int_equal(management_open(&management, &output, (struct entity_ids){1991, 36, 2},
                                     "7:1, 8:*", (struct command_link){&transport, NULL}, &notes,
                                     &error),
                     0);
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
    listener = udp_socket_listener(&at, 0, &error);
    assert_true(listener >= 0);
    assert_int_equal(getsockname(listener, &at.any, &length), 0);
    assert_int_equal(
        pdu_output_open(&output, "127.0.0.1", udp_address_port(&at), 0, 100000, &error), 0);
    memset(&notes, 0, sizeof notes);
    open_management();
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

/* Gives a request, and expects that the world is asked and has done it. */
static void assert_done(const struct pdu *pdu, int command_type)
{
    int before = commands;
    give(pdu);
    assert_int_equal(commands, before + 1);
    assert_int_equal(sent[before].type, command_type);
    answer(before, jolon_RESULT_DONE);
    poll_at(UTC_S);
    assert_int_equal(count, 1);
    assert_int_equal(received[0].management.response, PDU_RESPONSE_ABLE);
}

/* A simulation that always says the same number, or that starts anew and counts from the beginning
 * again, is obeyed: by its time stamps at once, and without a clock when the network has no more
 * copies. */
static void test_a_number_is_used_again(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 0), start = request_of(PDU_START_RESUME, 0);
    (void)state;
    for (int i = 0; i < 4; i++) {
        now_ns += 500000000u;
        stop.header.timestamp = timestamp_of(100.0 + i, true);
        start.header.timestamp = timestamp_of(100.5 + i, true);
        assert_done(&stop, jolon_COMMAND_PAUSE);
        assert_done(&start, jolon_COMMAND_RESUME);
    }
    stop.header.timestamp = start.header.timestamp = 0;
    for (int i = 0; i < 3; i++) {
        now_ns += (uint64_t)(MANAGEMENT_NETWORK_S * 1e9);
        assert_done(&stop, jolon_COMMAND_PAUSE);
        assert_done(&start, jolon_COMMAND_RESUME);
    }
}

/* What the network has doubled or delayed does not stop a world that was started since. */
static void test_overtaken(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 1), start = request_of(PDU_START_RESUME, 2),
               late = request_of(PDU_STOP_FREEZE, 3);
    (void)state;
    stop.header.timestamp = timestamp_of(100.0, true);
    late.header.timestamp = timestamp_of(100.2, true);
    start.header.timestamp = timestamp_of(100.4, true);
    assert_done(&stop, jolon_COMMAND_PAUSE);
    assert_done(&start, jolon_COMMAND_RESUME);
    give(&stop); /* a copy: acknowledged again */
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 1);
    give(&late); /* sent before the start, and never done */
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_UNABLE, 3);
    assert_int_equal(commands, 2);
    late.header.timestamp = timestamp_of(100.6, true); /* repeated because it was refused */
    assert_done(&late, jolon_COMMAND_PAUSE);
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

/* What was acknowledged is done also by a gateway that starts anew, once. */
static void test_a_kill_before_the_time(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 50);
    (void)state;
    stop.management.real_time = clock_of(UTC_S + 4.0);
    give(&stop);
    assert_int_equal(count, 1);
    open_management();
    poll_at(UTC_S + 3.9);
    give(&stop); /* a copy: acknowledged, and not another request */
    assert_int_equal(count, 1);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 50);
    assert_int_equal(commands, 0);
    poll_at(UTC_S + 4.0);
    assert_int_equal(commands, 1);
    open_management(); /* killed before the world has answered: asked again */
    poll_at(UTC_S + 4.1);
    assert_int_equal(commands, 2);
    answer(1, jolon_RESULT_DONE);
    poll_at(UTC_S + 4.2);
    open_management();
    poll_at(UTC_S + 5.0);
    assert_int_equal(commands, 2);
}

/* Half a note, of a gateway that was killed while it wrote, is none. */
static void test_half_a_note(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 50);
    struct management_note note;
    (void)state;
    stop.management.real_time = clock_of(UTC_S + 4.0);
    give(&stop);
    assert_true(management_notes_get(&notes, 0, &note));
    assert_int_equal(note.number, 50);
    notes.place[0].note.number = 51;
    assert_false(management_notes_get(&notes, 0, &note));
    open_management();
    poll_at(UTC_S + 5.0);
    assert_int_equal(commands, 0);
}

/* Others do not push out a request that waits. */
static void test_waiting_among_many(void **state)
{
    struct pdu stop = request_of(PDU_STOP_FREEZE, 1000);
    (void)state;
    stop.management.real_time = clock_of(UTC_S + 10.0);
    give(&stop);
    for (uint32_t i = 0; i < 2 * MANAGEMENT_REQUESTS; i++) {
        struct pdu start = request_of(PDU_START_RESUME, i);
        assert_done(&start, jolon_COMMAND_RESUME);
    }
    int before = commands;
    poll_at(UTC_S + 10.0);
    assert_int_equal(commands, before + 1);
    assert_int_equal(sent[before].type, jolon_COMMAND_PAUSE);
    answer(before, jolon_RESULT_DONE);
    poll_at(UTC_S + 10.0);
    for (uint32_t i = 0; i < MANAGEMENT_REQUESTS; i++) { /* no place is left */
        stop.management.request = 2000 + i;
        stop.management.real_time = clock_of(UTC_S + 100.0);
        give(&stop);
        assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_ABLE, 2000 + i);
    }
    stop.management.request = 3000;
    give(&stop);
    assert_acknowledged(0, PDU_ACKNOWLEDGE_STOP, PDU_RESPONSE_UNABLE, 3000);
    assert_int_equal(management.full, 1);
    assert_string_equal(management.done_why,
                        "too many requests wait, for their time or for the world");
}

/* What the rate puts off is acknowledged later. */
static void test_acknowledgements_wait(void **state)
{
    struct pdu create = request_of(PDU_CREATE, 0);
    int acknowledged = 0;
    (void)state;
    output.rate_ps = 4; /* three answers at once */
    for (uint32_t i = 0; i < 6; i++) {
        create.management.request = i;
        give(&create);
        acknowledged += count;
    }
    assert_int_equal(acknowledged, 3);
    for (int i = 0; i < 10; i++) {
        now_ns += 250000000u;
        poll_at(UTC_S);
        acknowledged += count;
    }
    assert_int_equal(acknowledged, 6);
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
        TEST(test_stop_and_start),
        TEST(test_who_is_allowed),
        TEST(test_who_is_meant),
        TEST(test_repetitions),
        TEST(test_the_time_of_a_start),
        TEST(test_what_cannot_be_done),
        TEST(test_no_answer),
        TEST(test_many_requests),
        TEST(test_a_number_is_used_again),
        TEST(test_overtaken),
        TEST(test_a_kill_before_the_time),
        TEST(test_half_a_note),
        TEST(test_waiting_among_many),
        TEST(test_acknowledgements_wait),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
