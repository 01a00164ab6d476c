/* The table of persistent contacts is carried from frame to frame. */
#include "collider/step.h"

#include "tests/support/steps.h"
#include "world/checksum.h"
#include "world/entity/persistent_contact.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const struct persistent_contact contacts[] = {
    {1, 2, 0, 1, 3, 4, 0, 0},
    {1, 3, 0, 2, 3, 5, 0, 0},
};

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 3; } );");
    struct state now = fixture_state(&f);
    memcpy(now.contacts, contacts, sizeof contacts);
    now.head->contact_count = 2;
    state_seal(&now, f.view.world.counts.fixed);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static void check_carried(int frames)
{
    for (int frame = 0; frame < frames; frame++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        assert_int_equal(now.head->contact_count, 2);
        assert_memory_equal(now.contacts, contacts, sizeof contacts);
        assert_true(state_whole(&now, f.view.world.counts.fixed));
    }
}

static void test_contacts_are_carried_from_frame_to_frame(void **state)
{
    (void)state;
    check_carried(5);
}

static void test_contacts_are_carried_while_paused(void **state)
{
    (void)state;
    struct state now = fixture_state(&f);
    now.head->paused = 1;
    state_seal(&now, f.view.world.counts.fixed);
    check_carried(5);
    assert_int_equal(fixture_state(&f).head->tick, 0);
}

/* The lists are not shared: each frame's digest is that of its own list. */
static void test_a_changed_contact_changes_the_run(void **state)
{
    (void)state;
    fixture_run(&f, 1);
    uint64_t before = fixture_digest(&f);
    fixture_state(&f).contacts[1].pressed_tick++;
    assert_int_not_equal(fixture_digest(&f), before);
    fixture_state(&f).contacts[1].pressed_tick--;
    f.view.w[0].contacts[1].pressed_tick++; /* frame 0's */
    assert_int_equal(fixture_digest(&f), before);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_contacts_are_carried_from_frame_to_frame),
        TEST(test_contacts_are_carried_while_paused),
        TEST(test_a_changed_contact_changes_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
