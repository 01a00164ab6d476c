/* Snapshots, events and commands, each in one process; races are in tests/property. */
#include "ipc/frame/command_ring.h"
#include "ipc/frame/event_cursor.h"
#include "ipc/frame/snapshot.h"

#include "tests/support/bare_view.h"
#include "tests/support/fixture.h"
#include "world/entity/persistent_contact.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define SLOTS     64u
#define PER_FRAME 8u
#define COMMANDS  8u

static struct view view;
static struct view collider;

static int make_view(void **state)
{
    const struct bare_sizes sizes = {.capacity = 20,
                                     .fixed = 9,
                                     .event_slots = SLOTS,
                                     .events_per_frame = PER_FRAME,
                                     .command_slots = COMMANDS};
    (void)state;
    bare_view_make(&view, &sizes);
    collider = bare_view_as(&view, ROLE_COLLIDER);
    return 0;
}

static int drop_view(void **state)
{
    (void)state;
    segment_abandon(&view);
    return 0;
}

/* A frame with this many rows and events; an event's tick is three times its sequence. */
static void make_frame(uint32_t rows, uint32_t events)
{
    struct state *next = bare_view_begin(&collider);
    next->head->used = rows;
    for (uint32_t i = 0; i < rows; i++) {
        next->entities.row[i].x = (double)next->head->frame + i;
        next->entities.row[i].id = i + 1;
    }
    memset(next->fixed_damage, (int)next->head->frame, view.header->counts.fixed);
    for (uint32_t i = 0; i < events; i++) {
        uint64_t sequence = next->head->event_end++;
        view.events[sequence & (SLOTS - 1)] = (struct event){
            .sequence = sequence, .tick = 3 * sequence, .frame = next->head->frame, .index = i};
    }
    bare_view_end(&collider);
}

/* --- snapshots ---------------------------------------------------------------------------------*/

static void test_rows_after_those_in_use_have_no_id(void **state)
{
    struct snapshot snapshot;
    static const uint32_t used[] = {15, 4, 9, 0, 20, 19};
    (void)state;
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    for (size_t n = 0; n < sizeof used / sizeof used[0]; n++) {
        make_frame(used[n], 0);
        assert_int_equal(snapshot_take(&snapshot, &view), 0);
        for (uint32_t row = 0; row < 20; row++)
            assert_int_equal(snapshot.entities.row[row].id, row < used[n] ? row + 1 : 0);
    }
    snapshot_free(&snapshot);
}

static void test_snapshot_is_the_committed_frame(void **state)
{
    struct snapshot snapshot;
    struct fixture f;
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [1000.0, 1000.0]; } );"
                     "vehicles = ( { kind = \"tank\"; count = 20; } );");
    assert_int_equal(snapshot_init(&snapshot, &f.view), 0);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(snapshot_take(&snapshot, &f.view), 0);
        assert_int_equal(snapshot.head.frame, atomic_load(&f.view.commit->commit));
        struct state taken = snapshot_state(&snapshot, &f.view);
        uint64_t digest = state_digest(&f.view.world, &taken);
        assert_int_equal(digest, fixture_digest(&f));
        fixture_run(&f, 3); /* the copy is private: it stays as it was */
        assert_int_equal(state_digest(&f.view.world, &taken), digest);
        assert_int_not_equal(fixture_digest(&f), digest);
    }
    snapshot_free(&snapshot);
    fixture_close(&f);
}

/* Some rows of a copy go on to the last committed frame, and the others stay as they were. */
static void test_rows_of_a_snapshot_go_on(void **state)
{
    struct snapshot snapshot;
    static const uint32_t rows[] = {4, 1};
    (void)state;
    make_frame(6, 0);
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    assert_int_equal(snapshot_take(&snapshot, &view), 0);
    assert_false(snapshot_take_row_poses(&snapshot, &view, rows, 2)); /* there is no later frame */
    make_frame(6, 0);
    bare_view_begin(&collider)->entities.row[4].x = -1.0; /* a frame that is being made */
    assert_true(snapshot_take_row_poses(&snapshot, &view, rows, 2));
    assert_int_equal(snapshot.head.frame, 2);
    for (uint32_t row = 0; row < 6; row++)
        assert_true(snapshot.entities.row[row].x == (row == 4 || row == 1 ? 2.0 : 1.0) + row);
    assert_false(snapshot_take_row_poses(&snapshot, &view, rows, 2));
    atomic_store(&view.commit->writing, 4); /* the buffer of frame 2 is being written */
    snapshot.head.frame = 1;
    assert_false(snapshot_take_row_poses(&snapshot, &view, rows, 2));
    assert_int_equal(snapshot.head.frame, 1);
    snapshot_free(&snapshot);
}

static void test_snapshot_has_the_contacts(void **state)
{
    struct snapshot snapshot;
    (void)state;
    struct state *next = bare_view_begin(&collider);
    next->contacts[1] = (struct persistent_contact){.a_id = 2, .b_id = 7, .begin_tick = 11};
    next->head->contact_count = 2;
    bare_view_end(&collider);
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    assert_int_equal(snapshot_take(&snapshot, &view), 0);
    assert_int_equal(snapshot.head.contact_count, 2);
    assert_int_equal(snapshot.contacts[1].begin_tick, 11);
    next->contacts[1].begin_tick = 12; /* damage: the copy fails its checksum */
    assert_int_equal(snapshot.contacts[1].begin_tick, 11);
    assert_int_equal(snapshot_take(&snapshot, &view), -1);
    assert_int_equal(errno, EBADMSG);
    snapshot_free(&snapshot);
}

static void test_frame_being_made_does_not_hinder_a_snapshot(void **state)
{
    struct snapshot snapshot;
    (void)state;
    make_frame(5, 0);
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    bare_view_begin(&collider)->entities.row[0].x = -1.0;
    assert_int_equal(snapshot_take(&snapshot, &view), 0);
    assert_int_equal(snapshot.head.frame, 1);
    assert_true(snapshot.entities.row[4].x == 5.0);
    assert_int_equal(snapshot.fixed_damage[8], 1);
    snapshot_free(&snapshot);
}

static void test_constant_writing_is_eagain(void **state)
{
    struct snapshot snapshot;
    struct state_head head;
    (void)state;
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    atomic_store(&view.commit->writing, 2); /* W[0], which holds frame 0, is always being written */
    errno = 0;
    assert_int_equal(snapshot_take(&snapshot, &view), -1);
    assert_int_equal(errno, EAGAIN);
    errno = 0;
    assert_int_equal(snapshot_head(&head, &view), -1);
    assert_int_equal(errno, EAGAIN);
    atomic_store(&view.commit->writing, 1);
    assert_int_equal(snapshot_take(&snapshot, &view), 0);
    assert_int_equal(snapshot_head(&head, &view), 0);
    snapshot_free(&snapshot);
}

static void check_damaged(struct snapshot *snapshot, const char *what)
{
    errno = 0;
    if (snapshot_take(snapshot, &view) != -1 || errno != EBADMSG)
        fail_msg("taken with %s damaged", what);
}

static void test_damaged_column_or_head_is_ebadmsg(void **state)
{
    struct snapshot snapshot;
    (void)state;
    make_frame(5, 0);
    const struct state *w = &view.w[1];
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
#define X(type, name)                                                                              \
    *(unsigned char *)&w->entities.row[4].name ^= 8;                                               \
    check_damaged(&snapshot, #name);                                                               \
    *(unsigned char *)&w->entities.row[4].name ^= 8;
    ENTITY_FIELDS(X)
#undef X
    for (size_t i = 0; i < offsetof(struct state_head, debris); i++) {
        ((unsigned char *)w->head)[i] ^= 8;
        check_damaged(&snapshot, "head");
        ((unsigned char *)w->head)[i] ^= 8;
    }
    assert_int_equal(snapshot_take(&snapshot, &view), 0);
    snapshot_free(&snapshot);
}

static void test_used_past_the_capacity_reads_nothing_there(void **state)
{
    struct snapshot snapshot;
    (void)state;
    assert_int_equal(snapshot_init(&snapshot, &view), 0);
    view.w[0].head->used = UINT32_MAX;
    check_damaged(&snapshot, "used");
    view.w[0].head->used = 21;
    check_damaged(&snapshot, "used");
    snapshot_free(&snapshot);
}

static void test_head_of_another_frame_is_ebadmsg(void **state)
{
    struct state_head head;
    (void)state;
    make_frame(1, 0);
    assert_int_equal(snapshot_head(&head, &view), 0);
    assert_int_equal(head.frame, 1);
    view.w[1].head->frame = 3;
    errno = 0;
    assert_int_equal(snapshot_head(&head, &view), -1);
    assert_int_equal(errno, EBADMSG);
}

/* --- events ------------------------------------------------------------------------------------*/

static void check_events(const struct event *events, uint32_t count, uint64_t first)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(events[i].sequence, first + i);
        assert_int_equal(events[i].tick, 3 * (first + i));
    }
}

static void test_events_come_in_order_once(void **state)
{
    struct event_cursor cursor = {0};
    struct event events[SLOTS];
    uint64_t next = 0;
    (void)state;
    assert_int_equal(events_read(&view, &cursor, events, SLOTS), 0);
    for (uint32_t i = 0; i < 100; i++) {
        make_frame(1, i % (PER_FRAME + 1));
        uint32_t count = events_read(&view, &cursor, events, SLOTS);
        assert_int_equal(count, i % (PER_FRAME + 1));
        check_events(events, count, next);
        next += count;
        assert_int_equal(events_read(&view, &cursor, events, SLOTS), 0);
    }
    assert_int_equal(cursor.gap, 0);
    assert_int_equal(cursor.next, next);
}

static void test_events_come_in_parts_of_max(void **state)
{
    struct event_cursor cursor = {0};
    struct event events[SLOTS];
    (void)state;
    for (int i = 0; i < 5; i++)
        make_frame(1, 8);
    for (uint64_t next = 0; next < 40; next += 3) {
        uint32_t count = events_read(&view, &cursor, events, 3);
        assert_int_equal(count, next + 3 <= 40 ? 3 : 40 - next);
        check_events(events, count, next);
    }
    assert_int_equal(events_read(&view, &cursor, events, 0), 0);
}

static void test_events_not_yet_committed_are_not_read(void **state)
{
    struct event_cursor cursor = {0};
    struct event events[SLOTS];
    (void)state;
    make_frame(1, 2);
    struct state *next = bare_view_begin(&collider);
    view.events[2] = (struct event){.sequence = 2};
    next->head->event_end = 3;
    assert_int_equal(events_read(&view, &cursor, events, SLOTS), 2);
}

/* A reader that falls behind gets the number of lost events, and continues with the oldest safe
 * one. */
static void test_overwritten_events_are_a_counted_gap(void **state)
{
    struct event_cursor cursor = {0};
    struct event events[SLOTS];
    (void)state;
    for (int i = 0; i < 20; i++)
        make_frame(1, 8);
    uint32_t count = events_read(&view, &cursor, events, SLOTS);
    assert_int_equal(count, SLOTS - PER_FRAME); /* one frame's maximum is left to the writer */
    assert_int_equal(cursor.gap, 160 - count);
    check_events(events, count, cursor.gap);
    assert_int_equal(cursor.next, 160);
    make_frame(1, 8);
    assert_int_equal(events_read(&view, &cursor, events, SLOTS), 8);
    assert_int_equal(cursor.gap, 160 - count); /* kept until the caller resets it */
}

static void test_cursor_ahead_of_the_world_reads_nothing(void **state)
{
    struct event_cursor cursor = {.next = 1000};
    struct event events[SLOTS];
    (void)state;
    make_frame(1, 8);
    assert_int_equal(events_read(&view, &cursor, events, SLOTS), 0);
    assert_int_equal(cursor.gap, 0);
}

/* --- commands ----------------------------------------------------------------------------------*/

static int put(enum command_ring ring, uint64_t source, uint64_t sequence)
{
    struct command command = {.source = source,
                              .source_sequence = sequence,
                              .type = COMMAND_PAUSE,
                              .amount = (uint32_t)sequence * 7};
    errno = 0;
    return command_put(&view, ring, &command);
}

static void take(enum command_ring ring, uint64_t count)
{
    bare_view_begin(&collider)->head->command_cursor[ring] += count;
    bare_view_end(&collider);
}

static void test_commands_keep_their_order_and_content(void **state)
{
    (void)state;
    for (uint64_t i = 1; i <= 50; i++) {
        assert_int_equal(put(RING_RECORDER, 5, i), 0);
        assert_int_equal(atomic_load(&view.commands[RING_RECORDER]->head), i);
        const struct command *slot = &view.commands[RING_RECORDER]->slot[(i - 1) % COMMANDS];
        assert_int_equal(slot->sequence, i - 1);
        assert_int_equal(slot->source, 5);
        assert_int_equal(slot->source_sequence, i);
        assert_int_equal(slot->amount, i * 7);
        take(RING_RECORDER, 1);
    }
    assert_int_equal(atomic_load(&view.commands[RING_CLIENTS]->head), 0);
}

static void test_full_ring_is_enobufs_until_a_commit_takes_some(void **state)
{
    (void)state;
    for (uint64_t i = 1; i <= COMMANDS; i++)
        assert_int_equal(put(RING_CLIENTS, 1, i), 0);
    assert_int_equal(put(RING_CLIENTS, 1, COMMANDS + 1), -1);
    assert_int_equal(errno, ENOBUFS);
    assert_int_equal(put(RING_RECORDER, 1, 1), 0); /* each ring has its own slots */
    take(RING_CLIENTS, 3);
    for (uint64_t i = 1; i <= 3; i++)
        assert_int_equal(put(RING_CLIENTS, 1, COMMANDS + i), 0);
    assert_int_equal(put(RING_CLIENTS, 1, COMMANDS + 4), -1);
    assert_int_equal(errno, ENOBUFS);
    assert_int_equal(atomic_load(&view.commands[RING_CLIENTS]->head), COMMANDS + 3);
}

static void test_repeat_is_eexist_also_after_it_was_taken(void **state)
{
    (void)state;
    assert_int_equal(put(RING_CLIENTS, 1, 1), 0);
    assert_int_equal(put(RING_CLIENTS, 1, 1), -1);
    assert_int_equal(errno, EEXIST);
    take(RING_CLIENTS, 1);
    assert_int_equal(put(RING_CLIENTS, 1, 1), -1);
    assert_int_equal(errno, EEXIST);
    assert_int_equal(put(RING_CLIENTS, 2, 1), 0); /* another source has its own sequences */
    assert_int_equal(put(RING_CLIENTS, 1, 2), 0);
    assert_int_equal(atomic_load(&view.commands[RING_CLIENTS]->head), 3);
}

static void test_repeat_in_a_full_ring_is_eexist(void **state)
{
    (void)state;
    for (uint64_t i = 1; i <= COMMANDS; i++)
        assert_int_equal(put(RING_CLIENTS, 1, i), 0);
    for (uint64_t i = 1; i <= COMMANDS; i++) { /* also the oldest, which still waits to be taken */
        assert_int_equal(put(RING_CLIENTS, 1, i), -1);
        assert_int_equal(errno, EEXIST);
    }
}

/* The slot of a writer that was killed before it stored the head does not count. */
static void test_command_that_was_never_finished_can_be_put_again(void **state)
{
    (void)state;
    for (uint64_t i = 1; i <= COMMANDS; i++)
        assert_int_equal(put(RING_CLIENTS, 1, i), 0);
    take(RING_CLIENTS, COMMANDS);
    struct command *left = &view.commands[RING_CLIENTS]->slot[0];
    left->source = 1;
    left->source_sequence = COMMANDS + 1;
    left->sequence = COMMANDS;
    assert_int_equal(put(RING_CLIENTS, 1, COMMANDS + 1), 0);
    assert_int_equal(atomic_load(&view.commands[RING_CLIENTS]->head), COMMANDS + 1);
}

static void test_putting_a_command_rings_the_movers_bell(void **state)
{
    int value = -1;
    (void)state;
    assert_int_equal(put(RING_CLIENTS, 1, 1), 0);
    assert_int_equal(sem_getvalue(&view.doorbells->role[ROLE_MOVER].bell, &value), 0);
    assert_int_equal(value, 1);
}

#define TEST(function) cmocka_unit_test_setup_teardown(function, make_view, drop_view)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_rows_after_those_in_use_have_no_id),
        cmocka_unit_test(test_snapshot_is_the_committed_frame),
        TEST(test_rows_of_a_snapshot_go_on),
        TEST(test_snapshot_has_the_contacts),
        TEST(test_frame_being_made_does_not_hinder_a_snapshot),
        TEST(test_constant_writing_is_eagain),
        TEST(test_damaged_column_or_head_is_ebadmsg),
        TEST(test_used_past_the_capacity_reads_nothing_there),
        TEST(test_head_of_another_frame_is_ebadmsg),
        TEST(test_events_come_in_order_once),
        TEST(test_events_come_in_parts_of_max),
        TEST(test_events_not_yet_committed_are_not_read),
        TEST(test_overwritten_events_are_a_counted_gap),
        TEST(test_cursor_ahead_of_the_world_reads_nothing),
        TEST(test_commands_keep_their_order_and_content),
        TEST(test_full_ring_is_enobufs_until_a_commit_takes_some),
        TEST(test_repeat_is_eexist_also_after_it_was_taken),
        TEST(test_repeat_in_a_full_ring_is_eexist),
        TEST(test_command_that_was_never_finished_can_be_put_again),
        TEST(test_putting_a_command_rings_the_movers_bell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
