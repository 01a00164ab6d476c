/* Losses: a group is lost when half of it is destroyed. */
#include "mover/agent/losses.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; };"
                     "vehicles = ("
                     "{ kind = \"tank\"; count = 6; force = \"blue\";"
                     "  area = [24000.0, 24000.0, 24600.0, 24800.0]; },"
                     "{ kind = \"tank\"; count = 6; force = \"blue\";"
                     "  area = [26000.0, 24000.0, 26600.0, 24800.0]; },"
                     "{ kind = \"carrier\"; count = 4; force = \"red\"; formation = \"wedge\";"
                     "  at = [28000.0, 28000.0]; },"
                     "{ kind = \"tank\"; force = \"red\"; at = [28500.0, 28000.0]; });");
    return 0;
}

static bool lost(uint32_t row)
{
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    return losses_half(&step, row);
}

static void destroy(uint32_t first, uint32_t count)
{
    for (uint32_t row = first; row < first + count; row++)
        steps_rows(&f).row[row].state = ENTITY_WRECK;
}

static void test_half_of_an_areas_group_is_three_of_six(void **state)
{
    (void)state;
    assert_false(lost(0));
    destroy(1, 2);
    assert_false(lost(0));
    destroy(3, 1);
    assert_true(lost(0) && lost(4) && lost(5));
    assert_false(lost(6)); /* another area */
}

static void test_a_formation_counts_its_leader(void **state)
{
    (void)state;
    destroy(13, 1);
    assert_false(lost(12) || lost(14));
    destroy(12, 1);
    assert_true(lost(14) && lost(15));
}

static void test_a_member_whose_row_holds_another_entity_is_lost(void **state)
{
    (void)state;
    steps_rows(&f).row[12].id = steps_rows(&f).row[13].id = 1000;
    assert_true(lost(14) && lost(15));
}

static void test_a_single_vehicle_has_no_group(void **state)
{
    (void)state;
    assert_false(lost(16));
}

/* They withdraw when they are fired upon, not those that stand. */
static void test_a_group_with_half_losses_withdraws_when_fired_upon(void **state)
{
    (void)state;
    destroy(0, 3);
    struct entities e = steps_rows(&f);
    e.row[4].flags |= ENTITY_FLAG_STAND;
    for (uint32_t row = 3; row < 5; row++) {
        e.row[row].threat_slot = 16;
        e.row[row].threat_id = e.row[16].id;
    }
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).row[3].behaviour, BEHAVIOUR_WITHDRAW);
    assert_int_not_equal(steps_rows(&f).row[4].behaviour, BEHAVIOUR_WITHDRAW);
    assert_int_equal(steps_rows(&f).row[5].behaviour, BEHAVIOUR_PATROL);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_half_of_an_areas_group_is_three_of_six),
        TEST(test_a_formation_counts_its_leader),
        TEST(test_a_member_whose_row_holds_another_entity_is_lost),
        TEST(test_a_single_vehicle_has_no_group),
        TEST(test_a_group_with_half_losses_withdraws_when_fired_upon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
