/* The layout: regions on pages of their own, one writer each, nothing out of bounds. */
#include "ipc/layout.h"

#include "ipc/segment.h"
#include "tests/support/fixture.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static struct segment_header small(void)
{
    return (struct segment_header){.counts = {.kinds = 3, .posts_side = 2, .fixed = 5, .names = 1},
                                   .capacity = 16,
                                   .event_slots = 64,
                                   .intents_per_frame = 8,
                                   .command_slots = 4,
                                   .crater_slots = 10};
}

static void check_layout(const struct segment_header *header)
{
    struct layout layout;
    size_t page = (size_t)sysconf(_SC_PAGESIZE), end = 0;
    assert_int_equal(layout_compute(&layout, header), 0);
    for (int i = 0; i < REGION_COUNT; i++) {
        assert_int_equal(layout.offset[i] % page, 0);
        assert_true(layout.offset[i] >= end);
        end = layout.offset[i] + layout.bytes[i];
    }
    assert_true(layout.total >= end);
    assert_int_equal(layout.total % page, 0);
}

static void test_regions_are_on_pages_and_do_not_overlap(void **state)
{
    struct segment_header header = small();
    uint64_t random = fixture_seed(1);
    (void)state;
    check_layout(&header);
    for (int i = 0; i < 2000; i++) {
        header.counts.kinds = (uint32_t)(fixture_random(&random) % 65);
        header.counts.fixed = (uint32_t)(fixture_random(&random) % 50000);
        header.counts.posts_side = 2 + (uint32_t)(fixture_random(&random) % 1600);
        header.counts.reach = (uint32_t)(fixture_random(&random) % 100000);
        header.counts.names = (uint32_t)(fixture_random(&random) % 5000);
        header.capacity = 1 + (uint32_t)(fixture_random(&random) % CAPACITY_MAX);
        header.event_slots = 1u << fixture_random(&random) % 21;
        header.command_slots = 1u << fixture_random(&random) % 12;
        header.crater_slots = (uint32_t)(fixture_random(&random) % 70000);
        check_layout(&header);
    }
}

static void test_regions_hold_what_they_are_for(void **state)
{
    struct segment_header header = small();
    struct layout l;
    (void)state;
    header.counts.reach = 7;
    header.counts.areas = 2;
    assert_int_equal(layout_compute(&l, &header), 0);
    assert_int_equal(l.offset[REGION_HEADER], 0);
    assert_int_equal(l.bytes[REGION_HEADER], sizeof(struct segment_header));
    assert_int_equal(l.bytes[REGION_KINDS], 3 * sizeof(struct kind));
    assert_int_equal(l.bytes[REGION_POSTS], 2 * 2 * sizeof(float));
    assert_int_equal(l.bytes[REGION_COVER], 2 * 2);
    assert_int_equal(l.bytes[REGION_FIXED], 5 * sizeof(struct fixed_object));
    assert_int_equal(l.bytes[REGION_REACH], 7 * sizeof(uint32_t));
    assert_int_equal(l.bytes[REGION_AREAS], 2 * sizeof(struct area));
    size_t state_bytes = LAYOUT_HEAD_BYTES + entities_bytes(16) + 5;
    assert_int_equal(l.bytes[REGION_WORLD_A], state_bytes);
    assert_int_equal(l.bytes[REGION_WORLD_B], state_bytes);
    assert_int_equal(l.bytes[REGION_CRATERS], 10 * sizeof(struct crater));
    assert_int_equal(l.bytes[REGION_EVENTS], 64 * sizeof(struct event));
    assert_int_equal(l.bytes[REGION_MOVED],
                     LAYOUT_HEAD_BYTES + entities_bytes(16) + 8 * sizeof(struct event));
    for (int i = REGION_COMMANDS; i <= REGION_COMMANDS_LAST; i++)
        assert_int_equal(l.bytes[i],
                         sizeof(struct command_ring_words) + 4 * sizeof(struct command));
    for (int i = REGION_SLOTS; i <= REGION_SLOTS_LAST; i++)
        assert_true(l.bytes[i] >= sizeof(struct role_slot));
}

static void test_every_region_has_one_writer_but_doors(void **state)
{
    (void)state;
    for (int region = 0; region < REGION_COUNT; region++) {
        int writers = 0;
        for (int role = 0; role < ROLE_COUNT; role++)
            writers += layout_writable((enum role)role, (enum region)region);
        if (region != REGION_DOORS && writers > 1)
            fail_msg("%s has %d writers", region_name((enum region)region), writers);
    }
}

static void test_the_frame_protocols_writers(void **state)
{
    (void)state;
    assert_true(layout_writable(ROLE_COLLIDER, REGION_COMMIT));
    assert_true(layout_writable(ROLE_COLLIDER, REGION_WORLD_A));
    assert_true(layout_writable(ROLE_COLLIDER, REGION_WORLD_B));
    assert_true(layout_writable(ROLE_COLLIDER, REGION_CRATERS));
    assert_true(layout_writable(ROLE_COLLIDER, REGION_EVENTS));
    assert_true(layout_writable(ROLE_MOVER, REGION_MOVED_WORD));
    assert_true(layout_writable(ROLE_MOVER, REGION_MOVED));
    assert_true(layout_writable(ROLE_REPORTER, REGION_COMMANDS + RING_REPORTER));
    assert_true(layout_writable(ROLE_RECORDER, REGION_COMMANDS + RING_RECORDER));
    assert_false(layout_writable(ROLE_COLLIDER, REGION_MOVED));
    assert_false(layout_writable(ROLE_COLLIDER, REGION_MOVED_WORD));
    assert_false(layout_writable(ROLE_MOVER, REGION_COMMIT));
    for (int role = 0; role < ROLE_COUNT; role++) {
        for (int other = 0; other < ROLE_COUNT; other++)
            assert_int_equal(layout_writable((enum role)role, (enum region)(REGION_SLOTS + other)),
                             role == other);
    }
}

static void test_static_regions_have_no_writer(void **state)
{
    (void)state;
    for (int region = REGION_HEADER; region <= REGION_RECIPE; region++) {
        for (int role = 0; role <= ROLE_NONE; role++)
            assert_false(layout_writable((enum role)role, (enum region)region));
    }
}

static void test_readers_write_nothing(void **state)
{
    (void)state;
    for (int region = 0; region < REGION_COUNT; region++) {
        assert_false(layout_writable(ROLE_NONE, (enum region)region));
        assert_false(layout_writable((enum role)1000, (enum region)region));
    }
}

static void refused(const struct segment_header *header)
{
    struct layout layout;
    errno = 0;
    assert_int_equal(layout_compute(&layout, header), -1);
    assert_int_equal(errno, EOVERFLOW);
}

#define REFUSES(field, value)                                                                      \
    do {                                                                                           \
        struct segment_header wrong = small();                                                     \
        wrong.field = (value);                                                                     \
        refused(&wrong);                                                                           \
    } while (0)

static void test_counts_out_of_range_are_refused(void **state)
{
    (void)state;
    REFUSES(capacity, 0);
    REFUSES(capacity, CAPACITY_MAX + 1);
    REFUSES(capacity, UINT32_MAX);
    REFUSES(event_slots, 0);
    REFUSES(event_slots, 63); /* no power of two */
    REFUSES(event_slots, 1u << 31);
    REFUSES(intents_per_frame, UINT32_MAX);
    REFUSES(command_slots, 0);
    REFUSES(command_slots, 6);
    REFUSES(command_slots, 1u << 31);
    REFUSES(crater_slots, UINT32_MAX);
    REFUSES(counts.kinds, UINT32_MAX);
    REFUSES(counts.models, UINT32_MAX);
    REFUSES(counts.model_vertices, UINT32_MAX);
    REFUSES(counts.model_triangles, UINT32_MAX);
    REFUSES(counts.posts_side, 0);
    REFUSES(counts.posts_side, 1);     /* the ground needs two to lie between */
    REFUSES(counts.posts_side, 65537); /* its square is 1 in 32 bits */
    REFUSES(counts.fixed, UINT32_MAX);
    REFUSES(counts.reach, UINT32_MAX);
    REFUSES(counts.areas, UINT32_MAX);
    REFUSES(counts.routes, UINT32_MAX);
    REFUSES(counts.route_points, UINT32_MAX);
    REFUSES(counts.fires, UINT32_MAX);
    REFUSES(counts.road_points, UINT32_MAX);
    REFUSES(counts.names, UINT32_MAX);
    REFUSES(counts.recipe, UINT32_MAX);
}

/* A row of a million works: 1,048,576 entities and their slots. */
static void test_the_largest_world_fits(void **state)
{
    struct segment_header header = small();
    struct layout layout;
    (void)state;
    header.capacity = CAPACITY_MAX;
    header.event_slots = 1048576;
    header.intents_per_frame = 65536;
    header.crater_slots = 65536;
    header.counts.posts_side = 1601;
    header.counts.fixed = 40303;
    header.counts.names = CAPACITY_MAX;
    assert_int_equal(layout_compute(&layout, &header), 0);
    assert_true(layout.total > 3 * entities_bytes(CAPACITY_MAX));
}

static void test_every_region_has_a_name_of_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < REGION_COUNT; i++) {
        assert_string_not_equal(region_name((enum region)i), "?");
        for (int j = 0; j < i; j++)
            assert_string_not_equal(region_name((enum region)i), region_name((enum region)j));
    }
    assert_string_equal(region_name(REGION_COUNT), "?");
}

static void test_layout_hash_is_the_same_each_time(void **state)
{
    (void)state;
    assert_int_equal(layout_hash(), layout_hash());
    assert_int_not_equal(layout_hash(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regions_are_on_pages_and_do_not_overlap),
        cmocka_unit_test(test_regions_hold_what_they_are_for),
        cmocka_unit_test(test_every_region_has_one_writer_but_doors),
        cmocka_unit_test(test_the_frame_protocols_writers),
        cmocka_unit_test(test_static_regions_have_no_writer),
        cmocka_unit_test(test_readers_write_nothing),
        cmocka_unit_test(test_counts_out_of_range_are_refused),
        cmocka_unit_test(test_the_largest_world_fits),
        cmocka_unit_test(test_every_region_has_a_name_of_its_own),
        cmocka_unit_test(test_layout_hash_is_the_same_each_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
