/* Places of scenarios that are written as degrees or as references of the grid. */
#include "config/places.h"

#include "tests/support/quick_config.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/world.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define PLACE "gateway = { latitude_deg = 44.2705; longitude_deg = -71.3033; };\n"

static struct error_text error;

static void near(double x, double z, double right_x, double right_z)
{
    if (fabs(x - right_x) > 1.0 || fabs(z - right_z) > 1.0)
        fail_msg("%.2f,%.2f is not %.2f,%.2f", x, z, right_x, right_z);
}

static void test_points_areas_and_routes(void **state)
{
    struct scenario s;
    (void)state;
    if (quick_config_load(
            &s,
            PLACE "bases = ( { force = \"blue\"; at = \"44.2705N,71.3033W\"; } );\n"
                  "objectives = ( { name = \"hill\"; area = ( \"44.26N,71.29W\", \"26000,24000\" "
                  "); } );\n"
                  "scripts = ( { name = \"s\"; steps = ( { at_s = 0.0; go = \"19TCK1617404497\"; } "
                  "); } );\n"
                  "vehicles = ( { kind = \"tank\"; name = \"a\"; at = \"19T CK 16174 04497\"; },\n"
                  "  { kind = \"tank\"; at = [100, 200];\n"
                  "    route = ( [25000, 25100.5], \"44.2705N,71.3033W\", \"24000,24001\" ); },\n"
                  "  { kind = \"tank\"; route = [ \"25000,25000\", \"25000,26000\" ]; } );\n"
                  "fires = ( { at_s = 1.0; shooter = \"a\"; point = \"44.2705N,71.3033W\"; } );\n",
            NULL, &error) != 0)
        fail_msg("refused: %s", error.text);
    near(s.settings->params.base[1].x, s.settings->params.base[1].z, 25000, 25000);
    near(s.groups[0].x, s.groups[0].z, 25000, 25000);
    near(s.steps[0].step.x, s.steps[0].step.z, 25000, 25000);
    near(s.fires[0].x, s.fires[0].z, 25000, 25000);
    assert_int_equal(s.routes[0].count, 3);
    assert_true(s.route_points[0].x == 25000.0 && s.route_points[0].z == 25100.5);
    near(s.route_points[1].x, s.route_points[1].z, 25000, 25000);
    assert_true(s.route_points[2].x == 24000.0 && s.route_points[2].z == 24001.0);
    assert_int_equal(s.routes[1].count, 2);
    assert_true(s.route_points[4].z == 26000.0);
    const struct objective *hill = &s.objectives[0];
    assert_true(hill->x0 < hill->x1 && hill->z0 < hill->z1);
    near(hill->x0, hill->z0, 26000, 24000);
    near(hill->x1, hill->z1, 26062, 26167);
}

static void test_wrong_places_are_refused_with_line_key_and_value(void **state)
{
    static const struct {
        const char *text, *because;
    } wrong[] = {
        {PLACE "vehicles = ( { kind = \"tank\";\n at = \"44.27N\"; } );",
         ":3: vehicles[0].at: '44.27N': not a place; right would be: 25000,24000"},
        {PLACE "vehicles = ( { kind = \"tank\";\n at = \"45.27N,71.3W\"; } );",
         ":3: vehicles[0].at: that place is 111 km from the middle of the world"},
        {PLACE "vehicles = ( { kind = \"tank\"; route = ( [1, 2],\n \"19TXK\" ); } );",
         ":3: vehicles[0].route[1]: '19TXK': its zone has no square"},
        {PLACE "vehicles = ( { kind = \"tank\"; route = ( \"1,2\",\n 7 ); } );",
         "vehicles[0].route[1]: is neither [x, z] nor a place in quotes"},
        {PLACE "objectives = ( { name = \"a\"; area = ( \"1,2\", \"1,60000\" ); } );",
         ":2: objectives[0].area: 1,60000: outside of the world; allowed: 0..50000 m each"},
        {PLACE "objectives = ( { name = \"a\"; area = ( \"1,2\", \"1,3\" ); } );",
         ":2: objectives[0].area = [1, 2, 1, 3]: is empty"},
        {PLACE "scripts = ( { name = \"s\"; steps = ( { at_s = 0.0; go = \"x\"; } ); } );",
         ":2: scripts[0].steps[0].go: 'x': not a place"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct scenario s;
        assert_int_equal(quick_config_load(&s, wrong[i].text, NULL, &error), -1);
        if (!strstr(error.text, wrong[i].because))
            fail_msg("\"%s\" does not say \"%s\"", error.text, wrong[i].because);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_areas_and_routes),
        cmocka_unit_test(test_wrong_places_are_refused_with_line_key_and_value),
    };
    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
