/* Files of waypoints: their values, refusals with line, value and what is right, and scripts that a
 * world cannot carry out. */
#include "config/waypoints.h"

#include "tests/support/fixture.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;
static struct scenario_step steps[16];

static int read_text(const char *text)
{
    struct source source = {.path = "convoy.csv", .bytes = strlen(text)};
    char copy[1024];
    snprintf(copy, sizeof copy, "%s", text);
    source.text = copy;
    assert_true(waypoints_lines(text) <= 16);
    return waypoints_read(&source, steps, &error);
}

static void test_lines_become_arrivals(void **state)
{
    (void)state;
    assert_int_equal(read_text("time_s,x,z\n0,100,200\n\n 12.5, 300 ,400.25\r\n"), 2);
    assert_int_equal(steps[0].step.type, STEP_ARRIVE);
    assert_true(steps[0].step.at_s == 0.0 && steps[0].step.x == 100.0 && steps[0].step.z == 200.0);
    assert_true(steps[0].step.altitude_m == STEP_SAME_ALTITUDE);
    assert_int_equal(steps[0].line, 2);
    assert_true(steps[1].step.at_s == 12.5 && steps[1].step.z == 400.25);
    assert_int_equal(steps[1].line, 4);
    assert_int_equal(read_text("time_s,x,z,altitude_m\n1,2,3,4"), 1);
    assert_true(steps[0].step.altitude_m == 4.0);
}

static void test_wrong_lines_are_refused(void **state)
{
    static const struct {
        const char *text, *says;
    } rows[] = {
        {"", "convoy.csv: is not the header; right would be: time_s,x,z[,altitude_m]"},
        {"time,x,z\n",
         "convoy.csv:1: time,x,z: is not the header; right would be: time_s,x,z[,altitude_m]"},
        {"time_s,x,z\n",
         "convoy.csv:1: has no waypoint; right would be: a line of time_s,x,z[,altitude_m] behind "
         "the header"},
        {"time_s,x,z\n1,2\n", "convoy.csv:2: 1,2: has 2 numbers; right would be: 3, as in the "
                              "header"},
        {"time_s,x,z\n1,2,3,4\n", "convoy.csv:2: 1,2,3,4: has more than 3 numbers; right would be: "
                                  "as many as in the header"},
        {"time_s,x,z\n1,two,3\n", "convoy.csv:2: x = two: is not a number; allowed: 0..50000 m"},
        {"time_s,x,z\n1,2,50001\n", "convoy.csv:2: z = 50001: out of range; allowed: 0..50000 m"},
        {"time_s,x,z\n1,nan,3\n", "convoy.csv:2: x = nan: is not a number; allowed: 0..50000 m"},
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
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lines_become_arrivals),
        cmocka_unit_test(test_wrong_lines_are_refused),
        cmocka_unit_test(test_what_a_kind_cannot_do_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
