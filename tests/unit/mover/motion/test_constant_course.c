/* Constant course: vehicles hold it in all events. */
#include "tests/support/steps.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double y, struct vec3 velocity)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, z}, .velocity = velocity});
}

static void test_hold_keeps_heading_and_speed_to_the_bit(void **state)
{
    uint32_t tank = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){11.0, 0.0, -7.0});
    uint32_t jet = put("jet", 20000.0, 25000.0, 900.0, (struct vec3){200.0, 3.0, 40.0});
    uint32_t ship = put("ship", 25000.0, 30000.0, 100.0, (struct vec3){-5.0, 0.0, 0.0});
    uint32_t rows[3] = {tank, jet, ship};
    double heading[3];
    (void)state;
    for (int n = 0; n < 3; n++)
        heading[n] = steps_rows(&f).heading[rows[n]];
    fixture_run(&f, 600);
    struct entities e = steps_rows(&f);
    for (int n = 0; n < 3; n++)
        assert_true(e.heading[rows[n]] == heading[n]);
    assert_true(e.vx[tank] == 11.0 && e.vz[tank] == -7.0 && e.vy[tank] == 0.0);
    assert_true(e.vx[jet] == 200.0 && e.vy[jet] == 3.0 && e.vz[jet] == 40.0);
    assert_true(e.vx[ship] == -5.0 && e.vz[ship] == 0.0);
    assert_true(fabs(e.x[tank] - 25110.0) < 1e-8 && fabs(e.z[tank] - 24930.0) < 1e-8);
    assert_true(fabs(e.x[jet] - 22000.0) < 1e-8 && fabs(e.y[jet] - 930.0) < 1e-8);
}

static void test_hold_reacts_to_nothing(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){10.0, 0.0, 0.0});
    uint32_t enemy = put("tank", 25100.0, 25300.0, 100.0, (struct vec3){0.0, 0.0, 0.0});
    struct entities e = steps_rows(&f);
    (void)state;
    e.force[row] = FORCE_BLUE;
    e.force[enemy] = FORCE_RED;
    e.flags[row] = ENTITY_FLAG_FIRE_AT_WILL;
    e.threat_slot[row] = enemy;
    e.threat_id[row] = e.id[enemy];
    e.bumped[row] = 1;
    e.fuel_l[row] = 0.0;
    fixture_run(&f, 240);
    e = steps_rows(&f);
    assert_int_equal(e.behaviour[row], BEHAVIOUR_HOLD);
    assert_true(e.vx[row] == 10.0 && fabs(e.x[row] - 25040.0) < 1e-8);
    assert_true(e.threat_id[row] == 0 && e.bumped[row] == 0);
    assert_int_equal(fixture_event_count(&f, EVENT_NONE), 0);
}

static void test_hold_follows_the_ground_and_asks_nothing_of_it(void **state)
{
    (void)state;
    steps_plane(&f, 1.0, 0.0);                                   /* far too steep for a tank */
    steps_cover(&f, COVER_LAKE, 25060.0, 0.0, 50000.0, 50000.0); /* and then a lake */
    uint32_t row = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){10.0, 0.0, 0.0});
    for (int frame = 1; frame <= 600; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        assert_true(e.vx[row] == 10.0);
        assert_true(e.y[row] == steps_ground_at(&f, e.x[row], e.z[row]));
        assert_true(fabs(e.vy[row] - 10.0) < 1e-6 && fabs(e.pitch[row] - PI / 4.0) < 1e-6);
    }
}

static void test_hold_ends_at_the_worlds_edge(void **state)
{
    uint32_t row = put("jet", 300.0, 25000.0, 900.0, (struct vec3){-250.0, 0.0, 0.0});
    (void)state;
    fixture_run(&f, 120);
    assert_true(steps_rows(&f).x[row] == 0.0 && steps_rows(&f).vx[row] == 0.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_hold_keeps_heading_and_speed_to_the_bit),
        TEST(test_hold_reacts_to_nothing),
        TEST(test_hold_follows_the_ground_and_asks_nothing_of_it),
        TEST(test_hold_ends_at_the_worlds_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
