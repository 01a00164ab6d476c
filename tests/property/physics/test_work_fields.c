/* Vehicles by scripts in fields of works that lie over each other, before the judge: scenes that
 * were not clean, and random fields at 60 and at 10 Hz. SEED=n SEEDS=m looks at other fields. */
#include "supervisor/physics/physics_check.h"
#include "tests/support/scenario_text.h"
#include "tests/support/steps.h"
#include "world/maths/random.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define SECONDS 12
#define FIELDS  4u
#define CROWDS  4u
/* 21 and 22 are not clean if nothing keeps vehicles out of walls of the ground. */
#define CROWD 21u

/* A square with works, and vehicles in its middle. */
struct field_plan {
    double half_m;
    double apart_m; /* of vehicles, from column to column; rows are twice as far apart */
    int works, vehicles, columns;
};

static const struct field_plan sparse = {60.0, 24.0, 14, 10, 5}; /* few meet */
static const struct field_plan crowded = {22.0, 8.0, 10, 16, 4}; /* all do */

static struct fixture f;
static struct physics_check check;
static struct scenario_text text;
static uint64_t state;

#define FLAT                                                                                       \
    "terrain = { source = \"flat\"; height_m = 100.0; };\ncollision = { shape = \"model\"; };\n"

/* Looks at the frames of the scenario, and fails if a measure is beyond its bound. */
static void judge(const char *name, const char *scenario, uint32_t frames)
{
    fixture_open(&f, scenario);
    struct state now = fixture_state(&f);
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    for (uint32_t frame = 0; frame < frames; frame++) {
        const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
        fixture_run(&f, 1);
        now = fixture_state(&f);
        assert_int_equal(physics_check_frame(&check, &now, &events), 0);
    }
    for (int kind = 0; kind < MEASURE_KINDS; kind++) {
        const struct measure *measure = &check.measures.of[kind];
        if (!measure_good(&check.measures, (enum measure_kind)kind))
            fail_msg("%s: %s is %.4g of %.4g %s: vehicle %u in frame %llu", name,
                     measure_word((enum measure_kind)kind), measure->worst,
                     measure_bound(&check.measures, (enum measure_kind)kind),
                     measure_unit((enum measure_kind)kind), measure->body[0].id,
                     (unsigned long long)measure->frame);
    }
    assert_true(check.measures.of[MEASURE_OF_SHELL_UNDERGROUND].taken > frames / 2);
    physics_check_free(&check);
    fixture_close(&f);
}

/* A jeep that lies on its side in a ford too deep for it was put back where it was, and its shell
 * was pressed 3.3 cm into a ramp. */
static void test_deep_water_presses_no_jeep_into_a_ramp(void **unused)
{
    (void)unused;
    judge("ford",
          "world = { capacity = 64; };\n" FLAT
          "earthworks = ( { shape = \"ramp\"; at = [25408.77, 25383.05]; heading_deg = 314.4;"
          " length_m = 3.25; width_m = 7.11; height_m = 1.067; edge_m = 0.25; },"
          " { shape = \"ramp\"; at = [25412.39, 25383.37]; heading_deg = 79.5; length_m = 4.0;"
          " width_m = 11.08; height_m = 1.201; edge_m = 0.5625; },"
          " { shape = \"ford\"; at = [25412.40, 25387.53]; heading_deg = 270.6; length_m = 45.0;"
          " width_m = 12.00; depth_m = 1.527; },"
          " { shape = \"skid_pan\"; at = [25377.04, 25398.42]; heading_deg = 247.8;"
          " length_m = 8.25; width_m = 8.17; grip = 0.11; } );\n"
          "scripts = ( { name = \"s\"; steps = ( { at_s = 0.1; throttle = 1.0; for_s = 3.0; },"
          " { at_s = 3.20; throttle = 0.0; steer = 1.0; for_s = 2.91; },"
          " { at_s = 6.11; throttle = -1.0; steer = -1.0; for_s = 0.55; },"
          " { at_s = 6.66; throttle = -1.0; steer = 0.4; for_s = 2.40; } ); } );\n"
          "vehicles = ( { kind = \"jeep\"; script = \"s\"; at = [25413.58, 25468.67];"
          " heading_deg = 349; speed_mps = 13.2; } );\n",
          600);
}

/* Springs of wheels that lie nearly flat on the wall of a trench bear nothing. */
static void test_wheels_of_what_tips_give_no_energy(void **unused)
{
    (void)unused;
    judge("trench",
          "world = { capacity = 64; };\n" FLAT
          "earthworks = ( { shape = \"trench\"; at = [22405.92, 20000.30]; heading_deg = 179.5;"
          " length_m = 12.25; width_m = 4.51; depth_m = 2.039; edge_m = 0.33; } );\n"
          "scripts = ( { name = \"s\"; steps = ( { at_s = 0.1; throttle = 1.0; for_s = 3.0; },"
          " { at_s = 3.20; throttle = 1.0; steer = -1.0; for_s = 0.59; },"
          " { at_s = 3.79; throttle = 0.0; climb = 1.0; for_s = 2.58; } ); } );\n"
          "vehicles = ( { kind = \"attack-tomato\"; script = \"s\"; at = [22393.41, 19930.31];"
          " heading_deg = 175; speed_mps = 13.2; } );\n",
          600);
}

static double draw(double low, double high)
{
    return low + (high - low) * (double)(fixture_random(&state) >> 11) * 0x1p-53;
}

static void add_work(const struct field_plan *plan, bool last)
{
    static const char *const shapes[] = {"table", "trench", "ramp", "washboard", "ford"};
    int shape = (int)draw(0.0, 4.999);
    double size = draw(0.1, 2.2), edge = maths_max(draw(0.2, 1.0) * size, 0.05);
    double across = draw(3.0, 16.0) + 2.2 * edge, along = draw(3.0, 20.0) + 2.2 * edge;
    scenario_text_add(
        &text,
        "{ shape = \"%s\"; at = [%.2f, %.2f]; heading_deg = %.1f; length_m = %.2f; width_m = "
        "%.2f; ",
        shapes[shape], 25000.0 + draw(-plan->half_m, plan->half_m),
        25000.0 + draw(-plan->half_m, plan->half_m), draw(0.0, 360.0), shape == 4 ? 45.0 : along,
        shape == 4 ? across + 8.0 : across);
    if (shape == 4)
        scenario_text_add(&text, "depth_m = %.2f; ", draw(0.1, 1.6));
    else if (shape == 3)
        scenario_text_add(&text, "height_m = %.2f; wave_m = %.2f; ", draw(0.03, 0.4),
                          draw(1.5, 8.0));
    else
        scenario_text_add(&text, "%s = %.3f; edge_m = %.3f; ", shape == 1 ? "depth_m" : "height_m",
                          size, edge);
    scenario_text_add(&text, "}%s\n", last ? " );" : ",");
}

static void add_script(int number, bool last)
{
    scenario_text_add(&text, "{ name = \"s%d\"; steps = ( ", number);
    for (double at_s = 0.1; at_s < SECONDS;) {
        double for_s = draw(0.3, 2.5);
        scenario_text_add(&text, "%s{ at_s = %.2f; throttle = %.1f; steer = %.2f; for_s = %.2f; }",
                          at_s > 0.1 ? ", " : "", at_s, draw(-0.6, 1.0),
                          draw(0.0, 1.0) < 0.5 ? 0.0 : draw(-1.0, 1.0), for_s);
        at_s += for_s;
    }
    scenario_text_add(&text, " ); }%s\n", last ? " );" : ",");
}

static const char *field(const struct field_plan *plan, uint64_t seed, double hz)
{
    static const char *const kinds[] = {"tank",      "carrier",       "jeep", "truck",
                                        "hamburger", "attack-tomato", "flak", "howitzer"};
    state = seed;
    text.used = 0;
    scenario_text_add(&text,
                      "world = { capacity = 64; seed = %u; hz = %.1f; };\n" FLAT "earthworks = (\n",
                      (unsigned)seed, hz);
    for (int n = 0; n < plan->works; n++)
        add_work(plan, n + 1 == plan->works);
    scenario_text_add(&text, "scripts = (\n");
    for (int n = 0; n < plan->vehicles; n++)
        add_script(n, n + 1 == plan->vehicles);
    scenario_text_add(&text, "vehicles = (\n");
    const double side = plan->apart_m / 4.0;
    const double west = 25000.0 - 0.5 * plan->apart_m * (plan->columns - 1);
    const double north = 25000.0 - plan->apart_m * ((double)plan->vehicles / plan->columns - 1.0);
    for (int n = 0; n < plan->vehicles; n++)
        scenario_text_add(
            &text,
            "{ kind = \"%s\"; script = \"s%d\"; at = [%.2f, %.2f]; heading_deg = %.0f; }%s\n",
            kinds[(int)draw(0.0, 7.999)], n,
            west + plan->apart_m * (n % plan->columns) + draw(-side, side),
            north + 2.0 * plan->apart_m * (n / plan->columns) + draw(-side, side), draw(0.0, 359.0),
            n + 1 == plan->vehicles ? " );" : ",");
    return text.at;
}

static void judge_fields(const struct field_plan *plan, const char *word, uint64_t first_usual,
                         uint64_t usual, double hz)
{
    const char *seeds = getenv("SEEDS");
    uint64_t first = fixture_seed(first_usual);
    uint64_t count = seeds ? strtoull(seeds, NULL, 10) : usual;
    for (uint64_t seed = first; seed < first + count; seed++) {
        char name[64];
        snprintf(name, sizeof name, "%s field %llu at %.0f Hz", word, (unsigned long long)seed, hz);
        judge(name, field(plan, seed, hz), (uint32_t)hz * SECONDS);
    }
}

static void test_random_fields_are_clean(void **unused)
{
    (void)unused;
    judge_fields(&sparse, "sparse", 1, FIELDS, 60.0);
    judge_fields(&sparse, "sparse", 1, FIELDS, 10.0);
}

/* Vehicles that meet among works push each other against walls, and over each other. */
static void test_crowded_fields_are_clean(void **unused)
{
    (void)unused;
    judge_fields(&crowded, "crowded", CROWD, CROWDS, 60.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_deep_water_presses_no_jeep_into_a_ramp),
        cmocka_unit_test(test_wheels_of_what_tips_give_no_energy),
        cmocka_unit_test(test_random_fields_are_clean),
        cmocka_unit_test(test_crowded_fields_are_clean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
