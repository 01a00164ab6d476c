/* Files of waypoints: their values, refusals with line, value and what is right, and scripts that a
 * world cannot carry out. */
#include "config/waypoints.h"

#include "tests/support/fixture.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;
static struct scenario_step steps[16];

/* Reads a file in a world of this side about the middle of the scenario mount-washington. */
static int read_in(const char *text, double side_m)
{
    struct location_frame frame;
    struct source source = {.path = "convoy.csv", .bytes = strlen(text)};
    char copy[1024];
    snprintf(copy, sizeof copy, "%s", text);
    source.text = copy;
    memset(steps, 0xa5, sizeof steps); /* the reader's caller has memory that was used before */
    assert_true(waypoints_lines(text) <= 16);
    location_frame_make(&frame, 44.28, -71.28, side_m);
    return waypoints_read(&source, &frame, steps, &error);
}

static int read_text(const char *text)
{
    return read_in(text, 50000.0);
}

static void test_lines_become_arrivals(void **state)
{
    (void)state;
    assert_int_equal(read_text("time_s,x,z\n0,100,200\n\n 12.5, 300 ,400.25\r\n"), 2);
    assert_int_equal(steps[0].step.type, STEP_ARRIVE);
    assert_true(steps[0].step.at_s == 0.0 && steps[0].step.x == 100.0 && steps[0].step.z == 200.0);
    assert_true(steps[0].step.altitude_m == STEP_SAME_ALTITUDE);
    assert_int_equal(steps[0].line, 2);
    assert_string_equal(steps[0].target, "");
    assert_true(steps[1].step.at_s == 12.5 && steps[1].step.z == 400.25);
    assert_int_equal(steps[1].line, 4);
    assert_int_equal(read_text("time_s,x,z,altitude_m\n1,2,3,4"), 1);
    assert_true(steps[0].step.altitude_m == 4.0);
}

static void test_places_have_any_form(void **state)
{
    static const char *const texts[] = {
        "time_s,latitude,longitude\n1,44.2705N,71.3033W\n2,44.2705, -71.3033\n",
        "time_s,mgrs,altitude_m\n1,19TCK1617404497,7\n2,19T CK 16174 04497,7\n"};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        if (read_text(texts[i]) != 2)
            fail_msg("%s", error.text);
        for (int k = 0; k < 2; k++) {
            /* The summit of Mount Washington, 1.86 km west and 1.05 km south of the middle. */
            assert_true(fabs(steps[k].step.x - 23140.0) < 10.0);
            assert_true(fabs(steps[k].step.z - 26056.0) < 10.0);
        }
        assert_true(steps[0].step.altitude_m == (i == 0 ? STEP_SAME_ALTITUDE : 7.0));
    }
}

static void test_metres_go_to_the_side_of_the_world(void **state)
{
    (void)state;
    assert_int_equal(read_in("time_s,x,z\n1,499999,3\n", 500000.0), 1);
    assert_int_equal(read_in("time_s,x,z\n1,10001,3\n", 10000.0), -1);
    assert_string_equal(error.text, "convoy.csv:2: x = 10001: out of range; allowed: 0..10000 m");
}

static void test_wrong_lines_are_refused(void **state)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"", "convoy.csv: is not the header; right would be: time_s,x,z[,altitude_m], with "
             "latitude,longitude or mgrs instead of x,z if it has these"},
        {"time,x,z\n",
         "convoy.csv:1: time,x,z: is not the header; right would be: time_s,x,z[,altitude_m], with "
         "latitude,longitude or mgrs instead of x,z if it has these"},
        {"time_s,x,z\n",
         "convoy.csv:1: has no waypoint; right would be: a line of values behind the header"},
        {"time_s,x,z\n1,2\n", "convoy.csv:2: 1,2: has 2 values; right would be: 3, as in the "
                              "header"},
        {"time_s,x,z\n1,2,3,4\n", "convoy.csv:2: 1,2,3,4: has more than 3 values; right would be: "
                                  "as many as in the header"},
        {"time_s,x,z\n1,two,3\n", "convoy.csv:2: x = two: is not a number; allowed: 0..50000 m"},
        {"time_s,x,z\n1,2,50001\n", "convoy.csv:2: z = 50001: out of range; allowed: 0..50000 m"},
        {"time_s,x,z\n1,0x10,3\n", "convoy.csv:2: x = 0x10: is not a number; allowed: 0..50000 m"},
        {"time_s,x,z\n1,nan,3\n", "convoy.csv:2: x = nan: is not a number; allowed: 0..50000 m"},
        {"time_s,mgrs\n1,2,3\n",
         "convoy.csv:2: 1,2,3: has more than 2 values; right would be: as many as in the header"},
        {"time_s,mgrs\n1,44.27N\n", "convoy.csv:2: mgrs: '44.27N': not a place; right would be: "
                                    "25000,24000 (metres east, metres south), 44.2705N,71.3033W or "
                                    "19TCK1617404497 (MGRS)"},
        {"time_s,latitude,longitude\n1,25000,24000\n",
         "convoy.csv:2: latitude,longitude: '25000,24000': not a place as the header says; right "
         "would be: 44.2705,-71.3033"},
        {"time_s,latitude,longitude\n1,48,11\n",
         "convoy.csv:2: latitude,longitude: that place is 6041 km from the middle of the world, "
         "which is at 44.2800N,71.2800W, and outside of its square of 50 km"},
        {"time_s,x,z\n5,2,3\n5,2,3\n",
         "convoy.csv:3: time_s = 5: is not after the line before; allowed: above 5"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        assert_int_equal(read_text(rows[i].text), -1);
        assert_string_equal(error.text, rows[i].says);
    }
}

static void check_build(const char *text, const char *says)
{
    struct scenario scenario;
    struct world_build built;
    fixture_scenario(&scenario, text);
    if (world_build_make(&built, &scenario, &error) == 0)
        fail_msg("taken: %s", text);
    if (!strstr(error.text, says))
        fail_msg("\"%s\" is not in: %s", says, error.text);
    scenario_free(&scenario);
}

static void test_what_a_kind_cannot_do_is_refused(void **state)
{
    (void)state;
    check_build("scripts = ( { name = \"a\"; steps = ( { at_s = 0; arrive = [1000, 1000]; }, { "
                "at_s = 10; arrive = [2000, 1000]; } ); } );\n"
                "vehicles = ( { kind = \"tank\"; script = \"a\"; } );",
                "script \"a\": 1000 m in 10 s is more than the 16.67 m/s of a tank; right would "
                "be: there at 60.0 s or later");
    check_build("terrain = { source = \"generated\"; }; objects = { source = \"none\"; };\n"
                "scripts = ( { name = \"a\"; steps = ( { go = [25000, 25000]; } ); } );\n"
                "vehicles = ( { kind = \"ship\"; at = [1500, 29000]; script = \"a\"; } );",
                "script \"a\": [25000, 25000] is land, where no ship goes; right would be: a point "
                "on water");
    check_build("scripts = ( { name = \"a\"; steps = ( { fire = \"X\"; } ); } );\n"
                "vehicles = ( { kind = \"tank\"; script = \"a\"; } );",
                "script \"a\": fire = \"X\": no vehicle has that name");
    check_build("scripts = ( { name = \"a\"; steps = ( { behaviour = \"route\"; } ); } );\n"
                "vehicles = ( { kind = \"tank\"; script = \"a\"; } );",
                "script \"a\": behaviour = \"route\" has no route; right would be: route = ( [x, "
                "z], [x, z] ) with the vehicle");
    check_build("scripts = ( { name = \"a\"; steps = ( { fire_at = [25000, 25100]; } ); } );\n"
                "vehicles = ( { kind = \"truck\"; script = \"a\"; } );",
                "script \"a\": a truck fires, which has no munition; right would be: an armed "
                "vehicle");
    check_build(
        "scripts = ( { name = \"a\"; steps = ( { fire = \"T\"; } ); } );\n"
        "vehicles = ( { kind = \"tank\"; name = \"T\"; script = \"a\"; } );",
        "script \"a\": fire = \"T\": is the vehicle itself; right would be: another vehicle");
    check_build("scripts = ( { name = \"a\"; steps = ( { stop = true; } ); } );\n"
                "vehicles = ( { kind = \"jet\"; script = \"a\"; } );",
                "script \"a\": stop = true: a jet cannot stand; right would be: wait_s");
    check_build(
        "collision = { shape = \"model\"; };\n"
        "scripts = ( { name = \"a\"; steps = ( { go = [25000, 25000]; altitude_m = 3.0; } ); "
        "} );\n"
        "vehicles = ( { kind = \"helicopter\"; at = [24000, 25000]; script = \"a\"; } );",
        "script \"a\": altitude_m = 3.0: the nose of a helicopter that leans would touch the "
        "ground; right would be: 3.7 or more, or 0 to set down");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lines_become_arrivals),
        cmocka_unit_test(test_places_have_any_form),
        cmocka_unit_test(test_metres_go_to_the_side_of_the_world),
        cmocka_unit_test(test_wrong_lines_are_refused),
        cmocka_unit_test(test_what_a_kind_cannot_do_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
