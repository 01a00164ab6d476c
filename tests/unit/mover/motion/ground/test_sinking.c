/* Wrecks on water: ships settle, aircraft ditch and go under. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 20.0

static struct fixture f;

/* A lake of 6 km by 6 km. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    steps_cover(&f, COVER_LAKE, 22000.0, 22000.0, 28000.0, 28000.0);
    return 0;
}

static uint32_t put_wreck(const char *kind, double height, double speed_mps)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {24000.0, FIXTURE_GROUND_M + height, 25000.0},
                                                .velocity = {speed_mps, 0.0, 0.0},
                                                .heading_rad = HALF_PI});
    steps_rows(&f).row[row].state = ENTITY_WRECK;
    return row;
}

static bool still(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return vec3_length(entities_velocity(&e, row)) == 0.0 && e.row[row].until_tick != 0 &&
           e.row[row].until_tick <= fixture_state(&f).head->tick;
}

static void test_a_ships_wreck_settles_slowly(void **state)
{
    uint32_t row = put_wreck("ship", 0.0, 8.0);
    double before = FIXTURE_GROUND_M;
    (void)state;
    for (int frame = 0; frame < (int)(20.0 * HZ); frame++) {
        fixture_run(&f, 1);
        double y = steps_rows(&f).row[row].y;
        assert_true(y <= before && before - y < 0.2 / HZ);
        before = y;
    }
    assert_true(before < FIXTURE_GROUND_M - 0.1);
    fixture_run(&f, (uint32_t)(200.0 * HZ));
    double deep = FIXTURE_GROUND_M - steps_rows(&f).row[row].y;
    assert_true(still(row) && deep > 0.1 && deep < steps_kind(&f, "ship")->height_m);
    before = steps_rows(&f).row[row].y;
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(steps_rows(&f).row[row].y == before);
}

static void test_an_aircrafts_wreck_ditches_slows_and_goes_under(void **state)
{
    uint32_t row = put_wreck("helicopter", 60.0, 30.0);
    double bound = steps_kind(&f, "helicopter")->bound_m;
    (void)state;
    for (int s = 0; s < 300 && !still(row); s++)
        fixture_run(&f, (uint32_t)HZ);
    assert_true(still(row));
    assert_true(steps_rows(&f).row[row].y + bound < FIXTURE_GROUND_M);
    assert_true(steps_rows(&f).row[row].x > 24020.0 && steps_rows(&f).row[row].x < 24600.0);
    /* What wakes it does not bring it up again. */
    double deep = steps_rows(&f).row[row].y;
    steps_rows(&f).row[row].until_tick = 0;
    fixture_run(&f, (uint32_t)(10.0 * HZ));
    assert_true(still(row) && steps_rows(&f).row[row].y == deep);
}

static void test_on_land_nothing_sinks(void **state)
{
    uint32_t row = put_wreck("helicopter", 5.0, 0.0);
    (void)state;
    steps_rows(&f).row[row].x = 20000.0;
    fixture_run(&f, (uint32_t)(60.0 * HZ));
    assert_true(still(row) && steps_rows(&f).row[row].y > FIXTURE_GROUND_M);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_ships_wreck_settles_slowly),
        TEST(test_an_aircrafts_wreck_ditches_slows_and_goes_under),
        TEST(test_on_land_nothing_sinks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
