/* Rings between processes: events arrive in order and once, and losses are counted; so do
 * commands. */
#include "ipc/frame/command_ring.h"
#include "ipc/frame/event_cursor.h"

#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/fixture.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define SLOTS     256u
#define PER_FRAME 32u
#define FRAMES    60000u
#define COMMANDS  30000u

static struct view view;
static uint64_t seed;

static int make_view(void **state)
{
    const struct bare_sizes sizes = {
        .capacity = 16, .event_slots = SLOTS, .events_per_frame = PER_FRAME, .command_slots = 16};
    (void)state;
    bare_view_make(&view, &sizes);
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    segment_abandon(&view);
    return 0;
}

/* --- events ------------------------------------------------------------------------------------*/

static void fill_event(struct event *event, uint64_t sequence, uint64_t frame, uint32_t index)
{
    memset(event->bytes, (int)(sequence * 131 & 0xff), sizeof event->bytes);
    event->sequence = sequence;
    event->frame = frame;
    event->index = index;
    event->tick = sequence * 3;
}

static bool event_whole(const struct event *event)
{
    for (size_t i = 0; i < sizeof event->bytes; i++) {
        if (event->bytes[i] != (event->sequence * 131 & 0xff))
            return false;
    }
    return event->tick == event->sequence * 3;
}

static int write_events(void *context)
{
    uint64_t random = seed;
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    (void)context;
    for (uint32_t f = 0; f < FRAMES; f++) {
        struct state *next = bare_view_begin(&collider);
        uint32_t count = (uint32_t)(fixture_random(&random) % (PER_FRAME + 1));
        for (uint32_t i = 0; i < count; i++) {
            uint64_t sequence = next->head->event_end++;
            fill_event(&collider.events[sequence & (SLOTS - 1)], sequence, next->head->frame, i);
        }
        bare_view_end(&collider);
    }
    return 0;
}

struct tale {
    uint64_t events, gaps;
};

/* Checks one batch; the cursor stood at first before it. */
static void check_batch(const struct event *events, uint32_t count,
                        const struct event_cursor *cursor, uint64_t first)
{
    assert_int_equal(cursor->next, first + cursor->gap + count);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(events[i].sequence, first + cursor->gap + i);
        assert_true(event_whole(&events[i]));
        if (i > 0 && events[i].frame == events[i - 1].frame)
            assert_int_equal(events[i].index, events[i - 1].index + 1);
        else if (i > 0)
            assert_true(events[i].frame > events[i - 1].frame && events[i].index == 0);
    }
}

static struct tale read_all(bool slow)
{
    uint64_t random = seed + 1;
    struct event_cursor cursor = {0};
    struct event events[SLOTS];
    struct tale tale = {0, 0};
    uint64_t end = 0;
    for (;;) {
        bool last = atomic_load(&view.commit->commit) == FRAMES;
        uint64_t first = cursor.next;
        uint32_t max = 1 + (uint32_t)(fixture_random(&random) % SLOTS);
        uint32_t count = events_read(&view, &cursor, events, max);
        check_batch(events, count, &cursor, first);
        tale.events += count;
        tale.gaps += cursor.gap;
        cursor.gap = 0;
        end = view.w[FRAMES & 1].head->event_end;
        if (last && cursor.next == end)
            break;
        if (slow && fixture_random(&random) % 16 == 0)
            usleep(100);
    }
    assert_int_equal(tale.events + tale.gaps,
                     end); /* each event arrived once or was counted as lost */
    return tale;
}

static void check_readers(bool slow)
{
    pid_t writer = child_start(write_events, NULL);
    struct tale tale = read_all(slow);
    assert_int_equal(child_wait(writer), 0);
    print_message("%llu events read, %llu lost and counted\n", (unsigned long long)tale.events,
                  (unsigned long long)tale.gaps);
    assert_true(tale.events > 0);
    if (slow)
        assert_true(tale.gaps > 0); /* the ring has overwritten events */
}

static void test_events_beside_a_writer(void **state)
{
    (void)state;
    check_readers(false);
}

static void test_events_read_too_slowly_are_counted(void **state)
{
    (void)state;
    check_readers(true);
}

/* --- commands ----------------------------------------------------------------------------------*/

/* Puts every command twice. The second must be refused as a repeat. */
static int put_commands(void *context)
{
    struct view sender = bare_view_as(&view, ROLE_INTAKE);
    (void)context;
    for (uint64_t i = 1; i <= COMMANDS; i++) {
        struct command command = {.source = 9, .source_sequence = i, .amount = (uint32_t)(i * 3)};
        while (command_put(&sender, RING_CLIENTS, &command) != 0) {
            if (errno != ENOBUFS)
                return 1;
        }
        if (command_put(&sender, RING_CLIENTS, &command) == 0 || errno != EEXIST)
            return 2;
    }
    return 0;
}

static void test_commands_arrive_once_and_in_order(void **state)
{
    uint64_t random = seed + 2, taken = 0;
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    const struct command_ring_words *ring = view.commands[RING_CLIENTS];
    (void)state;
    pid_t sender = child_start(put_commands, NULL);
    while (taken < COMMANDS) {
        uint64_t head = atomic_load_explicit(&ring->head, memory_order_acquire);
        uint64_t most = fixture_random(&random) % 20; /* sometimes none, or not all */
        struct state *next = bare_view_begin(&collider);
        for (; taken < head && most > 0; taken++, most--) {
            const struct command *command = &ring->slot[taken & 15];
            assert_int_equal(command->sequence, taken);
            assert_int_equal(command->source_sequence, taken + 1);
            assert_int_equal(command->amount, (taken + 1) * 3);
        }
        next->head->command_cursor[RING_CLIENTS] = taken;
        bare_view_end(&collider);
    }
    assert_int_equal(child_wait(sender), 0);
    assert_int_equal(atomic_load(&ring->head), COMMANDS);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_events_beside_a_writer),
        TEST(test_events_read_too_slowly_are_counted),
        TEST(test_commands_arrive_once_and_in_order),
    };
    seed = fixture_seed(1991);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
