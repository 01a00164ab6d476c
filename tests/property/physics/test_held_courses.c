/* Vehicles that hold their course over made slopes, which tilt and lift them whatever presses on
 * them, strike others there. The judge looks at every frame: a tilt drives nobody, and no collision
 * gives energy or a jump. */
#include "tests/support/judged.h"
#include "tests/support/scenario_text.h"

#include <stdint.h>

#define FRAMES 240u

static struct fixture f;
static struct physics_check check;
static struct scenario_text text;

/* A work, a vehicle and its behaviour, and one that holds its course. */
struct meeting {
    const char *work, *first, *behaviour, *second;
};

static const struct meeting meetings[] = {
    /* On 55 degrees, an idle one that leans too much to stand. It turned, and so tilted, the other
     * one in each frame by more: 45 rad/s, and 4.3 of its top speeds. */
    {"\"ramp\"; at = [24600, 24000]; heading_deg = 0; length_m = 140; width_m = 220; height_m = 99;"
     " edge_m = 60",
     "\"hamburger\"; at = [24585.98, 24022.63]; heading_deg = 318.6", "idle",
     "\"howitzer\"; at = [24577.07, 24016.33]; heading_deg = 127.3; speed_mps = 9"},
    /* One tilts over an edge onto what has become a wreck: 3.3 and 1.4 J/kg. */
    {"\"table\"; at = [24599.6, 24599.9]; heading_deg = 90; length_m = 31.9; width_m = 5.6;"
     " edge_m = 1; height_m = 2; grade_percent = 80",
     "\"jeep\"; at = [24579.48, 24578.09]; heading_deg = 137.9; speed_mps = 24", "hold",
     "\"flak\"; at = [24590.91, 24625.54]; heading_deg = 13.5; speed_mps = 24"},
    {"\"table\"; at = [24746.8, 24300.3]; heading_deg = 180; length_m = 26.7; width_m = 9.5;"
     " edge_m = 1; height_m = 2; grade_percent = 80",
     "\"carrier\"; at = [24736.17, 24301.43]; heading_deg = 83.1; speed_mps = 16", "hold",
     "\"truck\"; at = [24754.54, 24283.39]; heading_deg = 191.5; speed_mps = 24"},
    /* One that leans by 20 degrees gets a spin by an impact: 1.4 J/kg. */
    {"\"table\"; at = [24298.2, 24300.4]; heading_deg = 180; length_m = 30.4; width_m = 5.5;"
     " edge_m = 1; height_m = 2; grade_percent = 80",
     "\"truck\"; at = [24267, 24292.21]; heading_deg = 109.7; speed_mps = 24", "hold",
     "\"flak\"; at = [24275.11, 24286.23]; heading_deg = 123.9; speed_mps = 24"},
    /* One is destroyed in the frame in which a wall lifts it, or it goes down into a trench: its
     * way up or down is no jump. */
    {"\"table\"; at = [24296.3, 24454.1]; heading_deg = 180; length_m = 31.6; width_m = 5.8;"
     " edge_m = 1; height_m = 2; grade_percent = 80",
     "\"howitzer\"; at = [24283.74, 24458.57]; heading_deg = 57.7; speed_mps = 4", "hold",
     "\"hamburger\"; at = [24335.49, 24477.78]; heading_deg = 301; speed_mps = 24"},
    {"\"trench\"; at = [24454.9, 24600.2]; heading_deg = 45; length_m = 25.5; width_m = 6.8;"
     " edge_m = 1; depth_m = 1.5",
     "\"flak\"; at = [24473.81, 24586.62]; heading_deg = 240.3; speed_mps = 24", "hold",
     "\"truck\"; at = [24437.38, 24621.14]; heading_deg = 35.2; speed_mps = 16"},
};

static void run(const struct meeting *meeting)
{
    text.used = 0;
    scenario_text_add(&text,
                      "world = { capacity = 64; seed = 1; };\n"
                      "terrain = { source = \"flat\"; height_m = 50.0; };\n"
                      "collision = { shape = \"model\"; };\n"
                      "objects = { source = \"none\"; };\n"
                      "earthworks = ( { shape = %s; } );\n"
                      "vehicles = ( { kind = %s; behaviour = \"%s\"; },\n"
                      "{ kind = %s; behaviour = \"hold\"; } );\n",
                      meeting->work, meeting->first, meeting->behaviour, meeting->second);
    fixture_open(&f, text.at);
    judged_continue(&f, &check, FRAMES);
}

static void test_the_ground_drives_nobody(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < sizeof meetings / sizeof *meetings; i++) {
        run(&meetings[i]);
        assert_true(fixture_state(&f).head->tally.collisions > 0);
        judged_no_other_bad(&check, MEASURE_KINDS);
        physics_check_free(&check);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_ground_drives_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
