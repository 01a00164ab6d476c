/* Agents go around earthworks that their kind cannot cross, and straight over those that it can. */
#include "mover/agent/driving/earthwork_obstacles.h"
#include "tests/support/steps.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 20

static struct fixture f;

static void open_work(const char *work)
{
    char text[400];
    snprintf(text, sizeof text,
             "world = { seed = 1; capacity = 64; hz = 20.0; };\n"
             "earthworks = ( { %s } );",
             work);
    fixture_open(&f, text);
}

/* Sends a vehicle to the east over a work 60 m before it. Returns how far it went aside [m], or -1
 * if it did not come across or came below the level ground by more than half a metre. */
static double goes_aside(const char *work, const char *kind)
{
    open_work(work);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                .heading_rad = HALF_PI,
                                                .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = e.row[row].order = BEHAVIOUR_PATROL;
    e.row[row].goal_x = 25200.0;
    e.row[row].goal_z = 25000.0;
    double aside = 0.0, low = 0.0;
    for (int n = 0; n < 60 * HZ && steps_rows(&f).row[row].x < 25150.0; n++) {
        fixture_run(&f, 1);
        e = steps_rows(&f);
        aside = maths_max(aside, fabs(e.row[row].z - 25000.0));
        low = maths_max(low, FIXTURE_GROUND_M - e.row[row].y);
        assert_true(e.row[row].y - FIXTURE_GROUND_M < 3.0); /* no edge throws it */
    }
    bool across = e.row[row].x >= 25150.0 && e.row[row].state == ENTITY_ACTIVE && low < 0.5;
    fixture_close(&f);
    return across ? aside : -1.0;
}

/* A trench across the way, 50 m from end to end. */
static double at_trench(const char *kind, double wide_m, double depth_m)
{
    char work[300];
    snprintf(work, sizeof work,
             "shape = \"trench\"; at = [25060.0, 25000.0]; heading_deg = 90.0; length_m = %.2f;"
             " width_m = 50.0; depth_m = %.2f; edge_m = %.3f;",
             wide_m, depth_m, 0.135 * depth_m);
    return goes_aside(work, kind);
}

static void test_they_go_around_trenches_that_are_too_wide(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        double around = at_trench(kinds[k], 5.0, 2.0);
        printf("%s: %.1f m aside of a trench of 5 m\n", kinds[k], around);
        assert_true(around > 25.0);
    }
    assert_true(at_trench("tank", 2.4, 2.0) >= 0.0 && at_trench("tank", 2.4, 2.0) < 5.0);
    assert_true(at_trench("jeep", 2.4, 2.0) > 25.0);
    assert_true(at_trench("jeep", 2.4, 0.25) >= 0.0 && at_trench("jeep", 2.4, 0.25) < 5.0);
}

static void test_they_go_around_walls_and_over_steps(void **state)
{
    static const char wall[] = "shape = \"table\"; at = [25060.0, 25000.0]; heading_deg = 90.0;"
                               " length_m = 12.0; width_m = 50.0; height_m = 2.5; edge_m = 0.4;";
    static const char bank[] = "shape = \"table\"; at = [25060.0, 25000.0]; heading_deg = 90.0;"
                               " length_m = 30.0; width_m = 50.0; height_m = 2.5; edge_m = 8.0;";
    (void)state;
    assert_true(goes_aside(wall, "tank") > 25.0 && goes_aside(wall, "jeep") > 25.0);
    assert_true(goes_aside(bank, "tank") >= 0.0 && goes_aside(bank, "tank") < 5.0);
}

static void test_the_way_is_free_up_to_the_edge(void **state)
{
    (void)state;
    open_work("shape = \"trench\"; at = [25060.0, 25000.0]; heading_deg = 90.0; length_m = 6.0;"
              " width_m = 50.0; depth_m = 2.0; edge_m = 0.3;");
    const struct earthworks *works = &f.view.world.terrain.earthworks;
    struct earthwork_way way = {25000.0, 25000.0, 1.0, 0.0, 100.0, 2.0, 4.0};
    const struct kind *tank = steps_kind(&f, "tank");
    assert_true(fabs(earthwork_obstacles_free(works, tank, &way) - 53.0) < 1e-9);
    way.length_m = 30.0;
    assert_true(earthwork_obstacles_free(works, tank, &way) == 30.0);
    way = (struct earthwork_way){25000.0, 25000.0, -1.0, 0.0, 100.0, 2.0, 4.0};
    assert_true(earthwork_obstacles_free(works, tank, &way) == 100.0);
    way = (struct earthwork_way){25060.0, 25000.0, 1.0, 0.0, 100.0, 2.0, 4.0}; /* it is in it */
    assert_true(earthwork_obstacles_free(works, tank, &way) == 100.0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_they_go_around_trenches_that_are_too_wide),
        cmocka_unit_test(test_they_go_around_walls_and_over_steps),
        cmocka_unit_test(test_the_way_is_free_up_to_the_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
