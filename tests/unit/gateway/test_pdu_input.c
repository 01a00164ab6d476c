/* What the gateway takes from a socket on the loopback: PDUs for us alone, and a count of all else.
 */
#include "gateway/pdu_input.h"

#include "gateway/pdu/pdu_write.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

static struct pdu_input input;
static struct error_text error;
static struct udp_address to;
static int out;
static unsigned taken;
static struct pdu last;
static struct udp_address last_from;

static void handler(void *context, const struct pdu *pdu, const struct udp_address *from,
                    uint64_t now_ns)
{
    assert_ptr_equal(context, &taken);
    assert_int_equal(now_ns, 77);
    taken++;
    last = *pdu;
    last_from = *from;
}

static int set_up(void **state)
{
    socklen_t length = sizeof to;
    (void)state;
    input = (struct pdu_input){.exercise = 3, .own = {1991, 10, 2}};
    assert_int_equal(gateway_lists_peers(&input.peers, "127.0.0.0/8", &error), 0);
    taken = 0;
    /* Port 0 is refused to users, so the test takes a free one first. */
    assert_int_equal(udp_address_parse(&to, "127.0.0.1", 3000, &error), 0);
    to.v4.sin_port = 0;
    input.at = to;
    input.socket = udp_socket_listener(&to, 0, &error);
    assert_true(input.socket >= 0);
    assert_int_equal(getsockname(input.socket, &to.any, &length), 0);
    out = udp_socket_sender(&to, 0, &error);
    assert_true(out >= 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    close(input.socket);
    close(out);
    return 0;
}

static size_t state_of(uint8_t bytes[PDU_WRITE_BYTES_MAX], uint8_t exercise, struct pdu_id id)
{
    static struct pdu pdu;
    pdu.header = (struct pdu_header){.version = 7, .exercise = exercise, .type = PDU_ENTITY_STATE};
    pdu.entity_state = (struct pdu_entity_state){.id = id, .type = {1, 1, 225, 1, 1, 2, 0}};
    return pdu_write(&pdu, bytes, PDU_WRITE_BYTES_MAX);
}

static void send_state(uint8_t exercise, struct pdu_id id)
{
    uint8_t bytes[PDU_WRITE_BYTES_MAX];
    size_t size = state_of(bytes, exercise, id);
    assert_int_equal(udp_socket_send(out, &to, bytes, size), 0);
}

static uint32_t receive(void)
{
    return pdu_input_receive(&input, handler, &taken, 77);
}

static void test_pdus_for_us_are_taken(void **state)
{
    struct udp_address self;
    socklen_t length = sizeof self;
    (void)state;
    assert_int_equal(receive(), 0);
    send_state(3, (struct pdu_id){7, 1, 5});
    send_state(3, (struct pdu_id){1991, 12, 5}); /* beyond our applications */
    assert_int_equal(receive(), 2);
    assert_int_equal(taken, 2);
    assert_int_equal(last.entity_state.id.application, 12);
    assert_int_equal(getsockname(out, &self.any, &length), 0);
    assert_int_equal(udp_address_port(&last_from), udp_address_port(&self));
    assert_true(udp_address_loopback(&last_from));
}

static void test_our_own_come_back(void **state)
{
    static struct pdu fire;
    uint8_t bytes[PDU_WRITE_BYTES_MAX];
    (void)state;
    send_state(3, (struct pdu_id){1991, 10, 5});
    send_state(3, (struct pdu_id){1991, 11, 5});
    fire.header = (struct pdu_header){.version = 6, .exercise = 3, .type = PDU_FIRE};
    fire.fire.event = (struct pdu_id){1991, 10, 9}; /* of a shot without a firer */
    size_t size = pdu_write(&fire, bytes, sizeof bytes);
    assert_int_equal(udp_socket_send(out, &to, bytes, size), 0);
    assert_int_equal(receive(), 3);
    assert_int_equal(taken, 0);
    assert_int_equal(input.echoes, 3);
}

static void test_other_exercises_are_ignored(void **state)
{
    (void)state;
    send_state(4, (struct pdu_id){7, 1, 5});
    assert_int_equal(receive(), 1);
    assert_int_equal(taken, 0);
    assert_int_equal(input.foreign, 1);
}

/* Our own numbers from another port are those of another simulator, which is told once a minute. */
static void test_others_with_our_numbers(void **state)
{
    struct udp_address self;
    socklen_t length = sizeof self;
    (void)state;
    send_state(3, (struct pdu_id){1991, 10, 5});
    assert_int_equal(getsockname(out, &self.any, &length), 0);
    input.sender_port = udp_address_port(&self);
    assert_int_equal(receive(), 1);
    assert_false(pdu_input_tell_twins(&input, 77));
    input.sender_port = (uint16_t)(udp_address_port(&self) ^ 1);
    send_state(3, (struct pdu_id){1991, 10, 5});
    assert_int_equal(receive(), 1);
    assert_int_equal(input.echoes, 2);
    assert_int_equal(input.twins, 1);
    assert_true(pdu_input_tell_twins(&input, 77));
    send_state(3, (struct pdu_id){1991, 10, 5});
    assert_int_equal(receive(), 1);
    assert_false(pdu_input_tell_twins(&input, 77 + 59000000000u));
    assert_true(pdu_input_tell_twins(&input, 77 + 60000000000u));
    assert_int_equal(taken, 0);
}

/* Datagrams of strangers are not read, whatever they hold. */
static void test_strangers_are_refused(void **state)
{
    (void)state;
    assert_int_equal(gateway_lists_peers(&input.peers, "10.0.0.0/8, 127.0.0.2", &error), 0);
    send_state(3, (struct pdu_id){7, 1, 5});
    assert_int_equal(udp_socket_send(out, &to, "junk", 4), 0);
    assert_int_equal(receive(), 2);
    assert_int_equal(taken, 0);
    assert_int_equal(input.strangers, 2);
    assert_int_equal(input.bad, 0);
    assert_int_equal(input.counts.datagrams, 0);
    assert_true(pdu_input_tell_strangers(&input, 77)); /* one line of both */
    assert_false(pdu_input_tell_strangers(&input, 77));
    assert_int_equal(gateway_lists_peers(&input.peers, "10.0.0.0/8, 127.0.0.1", &error), 0);
    send_state(3, (struct pdu_id){7, 1, 5});
    assert_int_equal(receive(), 1);
    assert_int_equal(taken, 1);
}

static void test_faults_are_counted(void **state)
{
    uint8_t bytes[3 * PDU_WRITE_BYTES_MAX];
    (void)state;
    assert_int_equal(udp_socket_send(out, &to, "junk", 4), 0);
    assert_int_equal(udp_socket_send(out, &to, "", 0), 0);
    /* A bundle: a good one, one of an unknown type, a good one. */
    size_t size = state_of(bytes, 3, (struct pdu_id){7, 1, 5});
    size_t second = state_of(bytes + size, 3, (struct pdu_id){7, 1, 6});
    bytes[size + 2] = 27;
    size_t third = state_of(bytes + size + second, 3, (struct pdu_id){7, 1, 7});
    assert_int_equal(udp_socket_send(out, &to, bytes, size + second + third), 0);
    assert_int_equal(receive(), 3);
    assert_int_equal(taken, 2);
    assert_int_equal(last.entity_state.id.entity, 7);
    assert_int_equal(input.counts.result[PDU_SKIPPED], 1);
    assert_int_equal(input.bad, 2);
    assert_int_equal(input.counts.result[PDU_BAD_HEADER], 2);
}

static void test_a_pass_is_bounded(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 2 * UDP_SOCKET_AT_ONCE + 3; i++)
        send_state(3, (struct pdu_id){7, 1, (uint16_t)(i + 1)});
    assert_int_equal(receive(), 2 * UDP_SOCKET_AT_ONCE + 3); /* several calls of the system */
    assert_int_equal(taken, 2 * UDP_SOCKET_AT_ONCE + 3);
    unsigned sent = 0;
    for (; sent < 3 * PDU_INPUT_DATAGRAMS; sent++) /* the system drops what finds no room */
        assert_int_equal(udp_socket_send(out, &to, "x", 1), 0);
    assert_in_range(receive(), 1, PDU_INPUT_DATAGRAMS);
}

static void test_addresses(void **state)
{
    struct pdu_input none = {.socket = 5};
    (void)state;
    assert_int_equal(pdu_input_open(&none, "none", 0, &error), 0);
    assert_int_equal(none.socket, -1);
    assert_int_equal(pdu_input_receive(&none, handler, &taken, 77), 0);
    assert_int_equal(pdu_input_open(&none, "localhost", 0, &error), -1);
    assert_non_null(strstr(error.text, "gateway.listen = \"localhost\""));
    assert_int_equal(pdu_input_open(&none, "198.51.100.7:3001", 0, &error), -1); /* not of here */
    assert_non_null(strstr(error.text, "198.51.100.7:3001"));
}

/* What others send to the group or the broadcast to which we send is not heard everywhere. */
static void test_what_is_heard(void **state)
{
    static const struct {
        const char *listen, *to;
        bool heard;
    } rows[] = {{"127.0.0.1:3000", "127.0.0.1:3000", true},
                {"127.0.0.1:3000", "239.1.2.3:3000", false},
                {"239.1.2.3:3000", "239.1.2.3:3000", true},
                {"239.1.2.3:3001", "239.1.2.3:3000", false},
                {"0.0.0.0:3000", "239.1.2.3:3000", false},
                {"127.0.0.1:3000", "127.255.255.255:3000", false},
                {"127.255.255.255:3000", "127.255.255.255:3000", true},
                {"0.0.0.0:3000", "127.255.255.255:3000", true}};
    (void)state;
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct udp_address other;
        assert_int_equal(udp_address_parse(&input.at, rows[i].listen, 0, &error), 0);
        assert_int_equal(udp_address_parse(&other, rows[i].to, 0, &error), 0);
        if (pdu_input_hears(&input, &other) != rows[i].heard)
            fail_msg("%s, %s", rows[i].listen, rows[i].to);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_pdus_for_us_are_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_our_own_come_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_other_exercises_are_ignored, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_strangers_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_others_with_our_numbers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_faults_are_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_a_pass_is_bounded, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_what_is_heard, set_up, tear_down),
        cmocka_unit_test(test_addresses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
