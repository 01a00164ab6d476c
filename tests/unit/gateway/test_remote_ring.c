/* The ring as the memory of owners: whatever goes round, each entity's owner is found in it. */
#include "gateway/remote_ring.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#define ENTITIES 8u

static struct fixture f;
static struct remote_table table;
static uint64_t slots;

static int open_ring(void **state)
{
    (void)state;
    fixture_open(&f, "world = { capacity = 64; remotes_max = 8; }; vehicles = ();");
    slots = layout_ring_slots(f.view.header, RING_GATEWAY);
    return remote_table_open(&table, ENTITIES);
}

static int close_ring(void **state)
{
    remote_table_close(&table);
    return fixture_teardown(state);
}

static uint64_t head(void)
{
    return segment_load(&f.view.commands[RING_GATEWAY]->head);
}

static uint64_t owner_of(uint64_t remote)
{
    return remote * 1000 + 7;
}

/* Tells a track of an entity of number 1 .. ENTITIES. Returns what remote_ring_append() returns. */
static int tell(uint64_t remote, uint64_t taken)
{
    struct remote_entry *entry = remote_table_find(&table, remote);
    if (!entry)
        entry = remote_table_add(&table, remote, 1);
    entry->owner = owner_of(remote);
    entry->track =
        (struct remote_record){.remote = remote, .type = REMOTE_TRACK, .event = entry->owner};
    if (remote_ring_append(&table, &f.view, &entry->track, taken) != 0)
        return -1;
    entry->told_at = head() - 1;
    return 0;
}

/* Returns true if a gateway that starts anew finds the owner of an entity. */
static bool finds(uint64_t remote)
{
    for (uint64_t i = head() > slots ? head() - slots : 0; i < head(); i++) {
        struct remote_record record =
            remote_record_of(&f.view.commands[RING_GATEWAY]->slot[i & (slots - 1)]);
        if (record.remote == remote && record.event == owner_of(remote) &&
            (record.type == REMOTE_TRACK || record.type == REMOTE_OWNER))
            return true;
    }
    return false;
}

static void test_owners_survive_what_goes_round(void **state)
{
    (void)state;
    for (uint64_t remote = 1; remote <= ENTITIES; remote++)
        assert_int_equal(tell(remote, head()), 0);
    for (uint64_t i = 0; i < 5 * slots; i++) {
        assert_int_equal(tell(ENTITIES, head()), 0);
        for (uint64_t remote = 1; remote <= ENTITIES; remote++)
            assert_true(finds(remote));
    }
    /* Each of the others costs one record each time that the ring goes round. */
    assert_in_range(head(), 5 * slots + ENTITIES + 5 * (ENTITIES - 1),
                    5 * slots + ENTITIES + 6 * (ENTITIES - 1));
}

/* Tracks, shots and losses in any order. */
static void test_random_records(void **state)
{
    uint64_t seed = getenv("SEED") ? strtoull(getenv("SEED"), NULL, 10) : (uint64_t)time(NULL);
    bool there[ENTITIES + 1] = {false};
    (void)state;
    print_message("SEED=%llu\n", (unsigned long long)seed);
    for (uint64_t i = 0; i < 4 * slots; i++) {
        uint64_t draw = random_mix(seed + i), remote = 1 + draw % ENTITIES;
        struct remote_record shot = {
            .remote = remote, .event = draw, .type = draw >> 20 & 1 ? REMOTE_FIRE : REMOTE_STRUCK};
        if (draw >> 8 & 255) {
            assert_int_equal(remote_ring_append(&table, &f.view, &shot, head()), 0);
        } else if (draw >> 16 & 3) {
            assert_int_equal(tell(remote, head()), 0);
            there[remote] = true;
        } else if (there[remote]) {
            struct remote_record lost = {.remote = remote, .type = REMOTE_LOST};
            assert_int_equal(remote_ring_append(&table, &f.view, &lost, head()), 0);
            remote_table_remove(&table, remote_table_find(&table, remote));
            there[remote] = false;
        }
        for (remote = 1; remote <= ENTITIES; remote++) {
            if (there[remote] && !finds(remote))
                fail_msg("seed %llu: record %llu wrote the owner of %llu out of the ring",
                         (unsigned long long)seed, (unsigned long long)i,
                         (unsigned long long)remote);
        }
    }
}

/* A ring that is full has what it had, and takes an owner before what would overwrite it. */
static void test_a_full_ring_keeps_owners(void **state)
{
    uint64_t taken;
    (void)state;
    assert_int_equal(tell(1, 0), 0);
    while (head() < slots)
        assert_int_equal(tell(2, 0), 0);
    assert_int_equal(tell(3, 0), -1);
    assert_int_equal(errno, ENOBUFS);
    assert_true(finds(1));
    taken = 1; /* the mover has taken the first: there is room for its owner alone */
    assert_int_equal(tell(3, taken), -1);
    assert_int_equal(head(), slots + 1);
    assert_true(finds(1));
    assert_int_equal(tell(3, slots), 0);
    assert_true(finds(1) && finds(2) && finds(3));
}

/* No record is written of an entity whose owner the gateway does not know. */
static void test_an_unknown_owner_is_not_written(void **state)
{
    (void)state;
    assert_int_equal(tell(1, head()), 0);
    remote_table_find(&table, 1)->owner = 0;
    for (uint64_t i = 0; i < 2 * slots; i++)
        assert_int_equal(tell(2, head()), 0);
    assert_int_equal(head(), 2 * slots + 1);
}

int main(void)
{
#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_ring, close_ring, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_owners_survive_what_goes_round),
        TEST(test_random_records),
        TEST(test_a_full_ring_keeps_owners),
        TEST(test_an_unknown_owner_is_not_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
