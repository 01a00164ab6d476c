/* Events into the ring: keys, the frame's limit, the chain of digests. */
#include "collider/response/event_writer.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define SLOTS 8

static struct event ring[SLOTS];
static struct counters tally;

static struct event_writer sink_from(uint64_t first, uint32_t most)
{
    return (struct event_writer){.slot = ring,
                                 .slots = SLOTS,
                                 .first = first,
                                 .frame = 12,
                                 .tick = 10,
                                 .most = most,
                                 .tally = &tally};
}

static int soil(void **state)
{
    (void)state;
    memset(ring, 0xa5, sizeof ring);
    tally = (struct counters){0};
    return 0;
}

static void test_events_carry_their_key_and_nothing_of_the_slots_past(void **state)
{
    struct event_writer events = sink_from(6, 5);
    (void)state;
    for (uint32_t n = 0; n < 5; n++) { /* over the ring's end */
        struct event *event = event_writer_event(&events, EVENT_CRATER);
        assert_ptr_equal(event, &ring[(6 + n) % SLOTS]);
        assert_int_equal(event->sequence, 6 + n);
        assert_int_equal(event->frame, 12);
        assert_int_equal(event->tick, 10);
        assert_int_equal(event->index, n);
        assert_int_equal(event->type, EVENT_CRATER);
        for (size_t i = 0; i < sizeof event->bytes; i++)
            assert_int_equal(event->bytes[i], 0);
    }
}

static void test_what_is_more_than_a_frame_holds_is_counted(void **state)
{
    struct event_writer events = sink_from(0, 3);
    (void)state;
    for (int n = 0; n < 3; n++)
        assert_non_null(event_writer_event(&events, EVENT_FIRE));
    for (int n = 0; n < 4; n++)
        assert_null(event_writer_event(&events, EVENT_FIRE));
    assert_int_equal(events.count, 3);
    assert_int_equal(tally.events_dropped, 4);
    assert_int_equal(ring[3].type, 0xa5a5a5a5);
}

static uint64_t digest_of(uint64_t before, uint32_t count, uint8_t last)
{
    struct event_writer events = sink_from(0, SLOTS);
    for (uint32_t n = 0; n < count; n++)
        event_writer_event(&events, EVENT_AGENT)->bytes[0] = n + 1 < count ? 1 : last;
    return event_writer_digest(&events, before);
}

static void test_the_digest_chains_every_event_onto_those_before(void **state)
{
    (void)state;
    assert_true(digest_of(77, 0, 0) == 77);
    assert_true(digest_of(77, 3, 5) == digest_of(77, 3, 5));
    assert_true(digest_of(77, 3, 5) != digest_of(78, 3, 5));
    assert_true(digest_of(77, 3, 5) != digest_of(77, 3, 6));
    assert_true(digest_of(77, 3, 1) != digest_of(77, 2, 1));
}

/* --- in a whole frame --------------------------------------------------------------------------*/

static void test_a_frames_limit_is_kept_and_the_rest_is_counted(void **state)
{
    struct fixture f;
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 512; };");
    steps_params(&f)->events_per_frame = 20;
    for (int n = 0; n < 50; n++) {
        for (int side = 0; side < 2; side++)
            fixture_put(&f, (struct fixture_entity){
                                .kind = "tank",
                                .at = {25000.0 + 6.05 * side, 100.0, 20000.0 + 100.0 * n},
                                .velocity = {side ? -10.0 : 10.0, 0.0, 0.0}});
    }
    fixture_run(&f, 1);
    const struct state_head *head = fixture_state(&f).head;
    assert_int_equal(head->event_end, 20);
    assert_int_equal(head->tally.collisions, 50);
    assert_int_equal(head->tally.events_dropped, 30);
    for (uint32_t n = 0; n < 20; n++)
        assert_int_equal(fixture_event(&f, EVENT_COLLISION, n)->index, n);
    fixture_close(&f);
}

static void test_the_key_is_frame_and_index_from_zero_in_every_frame(void **state)
{
    struct fixture f;
    uint64_t frame = 0;
    uint32_t index = 0, seen = 0;
    (void)state;
    fixture_open(&f, "world = { seed = 3; hz = 20.0; capacity = 256; };\n"
                     "vehicles = ( { kind = \"jeep\"; count = 120;\n"
                     "  area = [25000.0, 25000.0, 25100.0, 25100.0]; },\n"
                     "  { kind = \"jeep\"; count = 20; behaviour = \"hold\"; speed_mps = 8.0;\n"
                     "  area = [25000.0, 25000.0, 25100.0, 25100.0]; } );\n");
    for (int n = 0; n < 40; n++)
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_NONE});
    fixture_run(&f, 400);
    const struct event *event;
    for (; (event = fixture_event(&f, EVENT_NONE, seen)); seen++) {
        assert_int_equal(event->sequence, seen);
        assert_true(event->frame >= frame);
        index = event->frame == frame ? index + 1 : 0;
        frame = event->frame;
        assert_int_equal(event->index, index);
        assert_int_equal(event->tick, event->frame);
    }
    assert_int_equal(seen, fixture_state(&f).head->event_end);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 2);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_events_carry_their_key_and_nothing_of_the_slots_past, soil),
        cmocka_unit_test_setup(test_what_is_more_than_a_frame_holds_is_counted, soil),
        cmocka_unit_test_setup(test_the_digest_chains_every_event_onto_those_before, soil),
        cmocka_unit_test(test_a_frames_limit_is_kept_and_the_rest_is_counted),
        cmocka_unit_test(test_the_key_is_frame_and_index_from_zero_in_every_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
