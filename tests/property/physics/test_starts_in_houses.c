/* Vehicles that a scenario puts into houses and trees on the edges of made hills. They get out at
 * 10 m/s at most, as on level ground, and the judge finds nothing else. */
#include "tests/support/judged.h"
#include "tests/support/scenario_text.h"
#include "tests/support/steps.h"

#include <stdint.h>

#define FRAMES     120u
#define PARTS_MPS  10.0
#define ROUNDING_M 1e-3

static struct fixture f;
static struct physics_check check;
static struct scenario_text text;

/* A hill, two objects of one kind, and where a tank begins. */
struct start {
    const char *hill, *object;
    double at[2][2];
    const char *tank;
};

static const struct start starts[] = {
    /* 0.9 m in one frame, when the tank was let down on the hill level. */
    {"[24630, 24770]; heading_deg = 16.3; height_m = 9.8",
     "tree",
     {{24630.0, 24770.0}, {24630.0, 24762.8}},
     "[24630.102, 24763.272]; heading_deg = 249.27"},
    /* 2.15 m. */
    {"[24840, 24000]; heading_deg = 309.8; height_m = 9.0",
     "building",
     {{24840.0, 24000.0}, {24840.0, 23982.1}},
     "[24845.314, 23987.283]; heading_deg = 193.34"},
};

static void open_start(const struct start *start)
{
    text.used = 0;
    scenario_text_add(&text,
                      "world = { capacity = 64; seed = 1; };\n"
                      "terrain = { source = \"flat\"; height_m = 50.0; };\n"
                      "collision = { shape = \"model\"; };\n"
                      "earthworks = ( { shape = \"ramp\"; at = %s; length_m = 40; width_m = 50;"
                      " edge_m = 12; } );\n"
                      "objects = ( { kind = \"%s\"; at = [%.1f, %.1f]; heading_deg = 0; },\n"
                      "{ kind = \"%s\"; at = [%.1f, %.1f]; heading_deg = 0; } );\n"
                      "vehicles = ( { kind = \"tank\"; at = %s; behaviour = \"patrol\"; } );\n",
                      start->hill, start->object, start->at[0][0], start->at[0][1], start->object,
                      start->at[1][0], start->at[1][1], start->tank);
    fixture_open(&f, text.at);
}

/* Computes a frame. Returns how much farther the tank has come on the map than by its speed [m]. */
static double leap(void)
{
    const struct vec3 before = steps_position(&f, 0);
    double speed_mps = steps_speed(&f, 0);
    fixture_run(&f, 1);
    const struct vec3 after = steps_position(&f, 0);
    double x = after.x - before.x, z = after.z - before.z;
    speed_mps = maths_max(speed_mps, steps_speed(&f, 0));
    return sqrt(x * x + z * z) - speed_mps * world_dt_s(&f.view.world);
}

static void test_they_leave_no_faster_than_on_level_ground(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        double most = 0.0, way;
        open_start(&starts[i]);
        struct state now = fixture_state(&f);
        assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
        const struct vec3 from = steps_position(&f, 0);
        for (uint32_t n = 0; n < FRAMES; n++) {
            const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
            most = maths_max(most, leap());
            now = fixture_state(&f);
            assert_int_equal(physics_check_frame(&check, &now, &events), 0);
        }
        way = vec3_length(vec3_sub(steps_position(&f, 0), from));
        print_message("%.2f m, at most %.3f m in a frame\n", way, most);
        assert_true(way > 0.2 && most < PARTS_MPS * world_dt_s(&f.view.world) + ROUNDING_M);
        judged_no_other_bad(&check, MEASURE_KINDS);
        physics_check_free(&check);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_they_leave_no_faster_than_on_level_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
