/* Comparison of two frames: every difference is found and named. */
#include "supervisor/worldctl/compare.h"

#include "tests/support/steps.h"
#include "world/entity/dent.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f, g;

static void begin(struct fixture *fixture)
{
    fixture_open(fixture, "");
    for (int i = 0; i < 5; i++)
        fixture_put(fixture,
                    (struct fixture_entity){.kind = "tank",
                                            .at = {25000.0 + 50.0 * i, FIXTURE_GROUND_M, 25000.0}});
    fixture_run(fixture, 2);
}

static int open_both(void **state)
{
    (void)state;
    begin(&f);
    begin(&g);
    return 0;
}

static int close_both(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_close(&g);
    return 0;
}

static bool differ(struct difference *difference)
{
    const struct compared a = {&f.view.world, fixture_state(&f)};
    const struct compared b = {&g.view.world, fixture_state(&g)};
    return compare_states(&a, &b, difference);
}

static void differs_in(const char *field)
{
    struct difference difference;
    assert_true(differ(&difference));
    assert_string_equal(difference.field, field);
    assert_string_not_equal(difference.a, difference.b);
}

static void test_equal_frames_are_equal(void **state)
{
    struct difference difference;
    (void)state;
    assert_false(differ(&difference));
}

static void test_every_column_is_compared(void **state)
{
    const struct entities e = steps_rows(&g);
    struct difference difference;
    (void)state;
#define X(type, name)                                                                              \
    {                                                                                              \
        unsigned char *byte = (unsigned char *)&e.row[3].name + sizeof(type) - 1;                  \
        *byte ^= 1;                                                                                \
        assert_true(differ(&difference));                                                          \
        assert_string_equal(difference.column, #name);                                             \
        assert_int_equal(difference.row, 3);                                                       \
        assert_int_equal(difference.columns, 1);                                                   \
        *byte ^= 1;                                                                                \
    }
    ENTITY_FIELDS(X)
#undef X
}

static void test_the_smallest_difference_is_named_with_both_values(void **state)
{
    struct difference difference;
    (void)state;
    steps_rows(&f).row[1].x = 0.1;
    steps_rows(&g).row[1].x = 0.1 + 1e-17 + 2e-17;
    steps_rows(&g).row[4].z = 7.0;
    assert_true(differ(&difference));
    assert_string_equal(difference.field, "x of entity 2 (row 1)");
    assert_string_equal(difference.a, "0.10000000000000001");
    assert_string_equal(difference.b, "0.10000000000000003");
    assert_int_equal(difference.columns, 2);
}

static void test_craters_dents_and_the_head_are_compared(void **state)
{
    struct state p = fixture_state(&f), q = fixture_state(&g);
    (void)state;
    q.head->paused = 1;
    differs_in("paused of the head");
    q.head->paused = 0;
    q.head->command_cursor[RING_RECORDER] = 1;
    differs_in("command_cursor[RING_RECORDER] of the head");
    q.head->command_cursor[RING_RECORDER] = 0;
    q.head->battery[2].rounds = 3;
    differs_in("rounds of battery 2");
    q.head->battery[2].rounds = 0;
    q.head->debris[1].vx = 3.0f;
    differs_in("vx of debris 1");
    q.head->debris[1].vx = 0.0f;
    p.head->dent_count = q.head->dent_count = 2;
    q.dents[1].plastic_m = 0.5f;
    differs_in("plastic_m of dent 1 (entity 0)");
    p.head->crater_count = q.head->crater_count = 1;
    q.craters[0].radius_m = 3.0f;
    differs_in("radius_m of crater 0");
}

static void put_contacts(const struct fixture *fixture)
{
    struct state now = fixture_state(fixture);
    now.contacts[0] =
        (struct persistent_contact){1, 2, 0, 1, 5, 9, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now.contacts[1] =
        (struct persistent_contact){2, 4, 1, 3, 6, 9, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now.contacts[2] = (struct persistent_contact){
        2, PERSISTENT_CONTACT_FIXED | 6, 1, SLOT_NONE, 7, 9, 0, 0, 0.0f, {{0}}, {{{0}, {0}}}};
    now.head->contact_count = 3;
}

static void test_contacts_are_compared_by_their_keys(void **state)
{
    struct state p = fixture_state(&f), q = fixture_state(&g);
    struct difference difference;
    (void)state;
    put_contacts(&f);
    put_contacts(&g);
    assert_false(differ(&difference));
    q.contacts[0].begin_tick = 4;
    differs_in("begin_tick of the contact of entity 1 with entity 2");
    q.contacts[0].begin_tick = 5;
    q.contacts[2].pressed_tick = 8;
    differs_in("pressed_tick of the contact of entity 2 with fixed object 7");
    q.contacts[0] = q.contacts[1];
    q.contacts[1] = q.contacts[2];
    q.head->contact_count = 2;
    assert_true(differ(&difference));
    assert_string_equal(difference.field, "contact of entity 1 with entity 2");
    assert_string_equal(difference.a, "present");
    assert_string_equal(difference.b, "none");
    put_contacts(&g);
    p.head->contact_count = 2;
    assert_true(differ(&difference));
    assert_string_equal(difference.field, "contact of entity 2 with fixed object 7");
    assert_string_equal(difference.a, "none");
    assert_string_equal(difference.b, "present");
    p.head->contact_count = 3;
    q.head->battle.objective[2].owner = FORCE_RED;
    differs_in("owner of objective 2");
    q.head->battle.objective[2] = p.head->battle.objective[2];
    q.head->battle.mission[5].phase = 3;
    differs_in("phase of mission 5");
    q.head->battle.mission[5] = p.head->battle.mission[5];
    q.head->tally.contacts_refused = 1;
    differs_in("tally.contacts_refused of the head");
}

static void test_parameters_are_compared(void **state)
{
    struct difference difference;
    (void)state;
    assert_false(compare_worlds(&f.view.world, &g.view.world, &difference));
    steps_params(&g)->seed = 7;
    assert_true(compare_worlds(&f.view.world, &g.view.world, &difference));
    assert_string_equal(difference.field, "seed");
    assert_string_equal(difference.a, "1");
    assert_string_equal(difference.b, "7");
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_both, close_both)
    const struct CMUnitTest tests[] = {
        TEST(test_equal_frames_are_equal),
        TEST(test_every_column_is_compared),
        TEST(test_the_smallest_difference_is_named_with_both_values),
        TEST(test_craters_dents_and_the_head_are_compared),
        TEST(test_contacts_are_compared_by_their_keys),
        TEST(test_parameters_are_compared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
