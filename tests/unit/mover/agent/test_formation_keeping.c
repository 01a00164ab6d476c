/* Formations: vehicles keep their places on a winding route, close gaps, and always have a leader.
 */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ    20
#define COUNT 6u
#define ORDERS                                                                                     \
    "world = { seed = 1; capacity = 64; hz = 20.0; };"                                             \
    "vehicles = ( { kind = \"%s\"; count = 6; formation = \"%s\"; spacing_m = 40.0;"               \
    " at = [25000.0, 25000.0]; heading_deg = 90.0; %s } );"
#define WINDING                                                                                    \
    "route = ( [25000.0, 25000.0], [25600.0, 25000.0], [26000.0, 25300.0], [26500.0, 25100.0],"    \
    " [27200.0, 25200.0], [27400.0, 25900.0], [26000.0, 26400.0] );"

static struct fixture f;

static void open_with(const char *kind, const char *shape, const char *orders)
{
    char text[1024];
    snprintf(text, sizeof text, ORDERS, kind, shape, orders);
    fixture_open(&f, text);
}

/* How far row is from its place [m]. */
static double error_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct vec3 at = steps_position(&f, row);
    double dx = e.row[row].goal_x - at.x, dz = e.row[row].goal_z - at.z;
    return sqrt(dx * dx + dz * dz);
}

static double apart(uint32_t a, uint32_t b)
{
    return vec3_length(vec3_sub(steps_position(&f, a), steps_position(&f, b)));
}

static void test_everybody_keeps_his_place_on_a_winding_route(void **state)
{
    static const char *const shapes[] = {"column", "line", "wedge", "echelon-left",
                                         "echelon-right"};
    (void)state;
    for (int n = 0; n < 5; n++) {
        double sum = 0.0, most = 0.0;
        int samples = 0;
        open_with("tank", shapes[n], WINDING);
        for (int second = 0; second < 180; second++) {
            fixture_run(&f, HZ);
            for (uint32_t row = 1; row < COUNT && second > 20; row++) {
                assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_FOLLOW);
                most = maths_max(most, error_of(row));
                sum += error_of(row);
                samples++;
            }
        }
        print_message("%s: %.1f m off on average, %.1f m at most\n", shapes[n], sum / samples,
                      most);
        assert_true(sum / samples < (n == 0 ? 6.0 : 25.0)); /* wings swing wide in bends */
        assert_true(most < (n == 0 ? 40.0 : 180.0));
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        fixture_close(&f);
    }
    open_with("tank", "column", WINDING);
}

static void test_a_gap_is_closed_and_a_lost_leader_replaced(void **state)
{
    (void)state;
    open_with("tank", "column", WINDING);
    fixture_run(&f, 30 * HZ);
    steps_command(&f, (struct command){.type = COMMAND_REMOVE, .entity = 4});
    fixture_run(&f, 30 * HZ);
    assert_true(apart(2, 4) < 50.0);
    steps_command(&f, (struct command){.type = COMMAND_REMOVE, .entity = 1});
    fixture_run(&f, 2);
    struct entities e = steps_rows(&f);
    assert_int_equal(e.row[1].behaviour, BEHAVIOUR_ROUTE);
    assert_int_equal(e.row[2].behaviour, BEHAVIOUR_FOLLOW);
    uint32_t changes = fixture_event_count(&f, EVENT_AGENT);
    assert_int_equal(fixture_event(&f, EVENT_AGENT, changes - 1)->agent.because,
                     REASON_LEADER_LOST);
    fixture_run(&f, 30 * HZ);
    assert_true(apart(1, 2) < 50.0 && apart(2, 4) < 50.0 && apart(4, 5) < 50.0);
    assert_true(steps_speed(&f, 5) > 5.0); /* on its way */
}

static void test_it_stops_with_its_leader_and_does_not_circle(void **state)
{
    (void)state;
    open_with("truck", "wedge", WINDING);
    fixture_run(&f, 30 * HZ);
    steps_pedals(&f, 0, 0.0, 1.0, GEAR_AUTOMATIC); /* a player takes the leader and brakes */
    fixture_run(&f, 40 * HZ);
    for (uint32_t row = 0; row < COUNT; row++) {
        assert_true(steps_speed(&f, row) < 0.5);
        assert_true(row == 0 || error_of(row) < 30.0);
    }
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    steps_drive(&f, 0, 0.5, 0.0, 0.0); /* and they follow him on */
    fixture_run(&f, 30 * HZ);
    for (uint32_t row = 1; row < COUNT; row++)
        assert_true(steps_speed(&f, row) > 5.0 && error_of(row) < 30.0);
}

static void test_two_columns_meet_on_one_road_and_pass(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };"
                     "vehicles = ( { kind = \"truck\"; count = 5; formation = \"column\";"
                     " spacing_m = 40.0; at = [25000.0, 25000.0]; heading_deg = 90.0;"
                     " route = ( [25000.0, 25000.0], [27000.0, 25000.0] ); },"
                     " { kind = \"truck\"; count = 5; formation = \"column\"; spacing_m = 40.0;"
                     " at = [27000.0, 25000.0]; heading_deg = 270.0;"
                     " route = ( [27000.0, 25000.0], [25000.0, 25000.0] ); } );");
    fixture_run(&f, 95 * HZ);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    struct entities e = steps_rows(&f);
    for (uint32_t row = 0; row < 5; row++)
        assert_true(e.row[row].x > 26000.0 && e.row[row + 5].x < 26000.0);
}

/* Members that have fallen behind drive along their leader's route: between it and them may be
 * houses. */
static void test_who_has_fallen_behind_drives_along_the_route(void **state)
{
    double aside = 0.0;
    (void)state;
    open_with("jeep", "column",
              "route = ( [25000.0, 25000.0], [25400.0, 25000.0], [25400.0, 25400.0],"
              " [25800.0, 25400.0], [25800.0, 26400.0], [24000.0, 26400.0] );");
    fixture_run(&f, 20 * HZ);
    struct entities e = steps_rows(&f);
    e.row[0].x = 25400.0; /* its leader has driven on */
    e.row[0].z = 25300.0;
    e.row[0].leg = 3;
    e.row[0].goal_x = 25400.0;
    e.row[0].goal_z = 25400.0;
    for (uint32_t row = 1; row < COUNT; row++) {
        e.row[row].x = 25150.0 - 30.0 * row;
        e.row[row].z = 25000.0;
    }
    for (int frame = 0; frame < 40 * HZ; frame++) {
        fixture_run(&f, 1);
        e = steps_rows(&f);
        for (uint32_t row = 1; row < COUNT; row++) {
            double dx = maths_max(0.0, 25400.0 - e.row[row].x),
                   dz = maths_max(0.0, e.row[row].z - 25000.0);
            aside = maths_max(aside, maths_min(dx, dz));
        }
    }
    print_message("at most %.0f m off the route\n", aside);
    assert_true(aside < 25.0 && e.row[1].x > 25380.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, NULL, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_everybody_keeps_his_place_on_a_winding_route),
        TEST(test_a_gap_is_closed_and_a_lost_leader_replaced),
        TEST(test_it_stops_with_its_leader_and_does_not_circle),
        TEST(test_who_has_fallen_behind_drives_along_the_route),
        TEST(test_two_columns_meet_on_one_road_and_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
