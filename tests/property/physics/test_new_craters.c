/* Bombs and shells dig craters under, beside and before vehicles that hold their course on hills.
 * The judge looks at every frame: the ground lifts them as far as a crater is under them, in the
 * frame that digs it, and no crater lifts a vehicle beside it. A response without a guard at the
 * frame's end leaves vehicles on the ground, too. SEED=n draws others. */
#include "tests/support/judged.h"
#include "tests/support/scenario_text.h"
#include "tests/support/steps.h"
#include "world/terrain/crater.h"

#include <stdint.h>
#include <stdio.h>

#define RUNS     3u
#define VEHICLES 15u
#define FIRES    12u
#define APART_M  25.0
#define SECONDS  8.0

static const char *const kinds[] = {"tank", "carrier", "jeep", "truck", "flak"};
static const double rates_hz[RUNS] = {60.0, 10.0, 240.0};

static struct fixture f;
static struct physics_check check;
static struct scenario_text text;

/* The vehicles stand in a row from west to east. */
static double east_of(uint32_t vehicle)
{
    return 25000.0 + APART_M * vehicle;
}

static void write_fires(uint64_t *random)
{
    scenario_text_add(&text, "fires = (\n");
    for (uint32_t i = 0; i < FIRES; i++)
        scenario_text_add(&text, "{ at_s = %.2f; munition = \"%s\"; point = [%.2f, %.2f]; }%s\n",
                          fixture_uniform(random, 0.2, 4.0), i % 3 == 0 ? "bomb" : "artillery",
                          east_of((uint32_t)fixture_uniform(random, 0.0, VEHICLES)) +
                              fixture_uniform(random, -4.0, 4.0),
                          25000.0 + fixture_uniform(random, -12.0, 8.0), i + 1 < FIRES ? "," : "");
    scenario_text_add(&text, ");\n");
}

static void put_vehicles(uint64_t *random)
{
    for (uint32_t i = 0; i < VEHICLES; i++) {
        double x = east_of(i), z = 25000.0;
        uint32_t row =
            steps_put_driving(&f, kinds[i % 5], x, z, fixture_uniform(random, -30.0, 30.0),
                              fixture_uniform(random, 0.0, 3.0));
        assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_HOLD);
    }
}

static uint32_t count_bad(void)
{
    uint32_t bad = 0;
    for (int i = 0; i < MEASURE_KINDS; i++) {
        const struct measure *measure = &check.measures.of[i];
        if (measure_good(&check.measures, (enum measure_kind)i))
            continue;
        bad++;
        print_message("%s %g in frame %u, id %u\n", measure_word((enum measure_kind)i),
                      measure->worst, (uint32_t)measure->frame, measure->body[0].id);
    }
    return bad;
}

static void test_new_craters_lift_what_is_over_them(void **state)
{
    uint64_t random = fixture_seed(1);
    uint32_t bad = 0, craters = 0;
    (void)state;
    for (uint32_t run = 0; run < RUNS; run++) {
        text.used = 0;
        scenario_text_add(&text,
                          "world = { hz = %.1f; capacity = 256; };\n"
                          "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 31.25; };\n"
                          "collision = { shape = \"model\"; };\n",
                          rates_hz[run]);
        write_fires(&random);
        fixture_open(&f, text.at);
        steps_ground(&f, steps_waves, NULL);
        put_vehicles(&random);
        judged_continue(&f, &check, (uint32_t)(SECONDS * rates_hz[run]));
        bad += count_bad();
        craters += fixture_state(&f).head->crater_count;
        physics_check_free(&check);
        fixture_close(&f);
    }
    print_message("%u craters\n", craters);
    assert_true(craters > RUNS * FIRES / 2);
    assert_int_equal(bad, 0);
}

/* A carrier that holds its course shoves a jeep through one trench into a crater in another one. It
 * came down on the jeep's wreck, and was thrown out at 40 m/s. */
static void test_a_carrier_wedged_in_a_crater_gains_no_energy(void **state)
{
    (void)state;
    fixture_open(&f,
                 "world = { capacity = 64; seed = 35; };\n"
                 "terrain = { source = \"flat\"; height_m = 50.0; };\n"
                 "collision = { shape = \"model\"; };\n"
                 "objects = { source = \"none\"; };\n"
                 "earthworks = ( { shape = \"trench\"; at = [24065, 25010]; heading_deg = 0;"
                 " length_m = 30; edge_m = 1; width_m = 6; depth_m = 1.5; },\n"
                 "{ shape = \"trench\"; at = [24067, 24810]; heading_deg = 30; length_m = 30;"
                 " edge_m = 1; width_m = 6; depth_m = 1.5; } );\n"
                 "fires = ( { at_s = 0.2; munition = \"artillery\"; point = [24070.9, 25000]; },\n"
                 "{ at_s = 0.6; munition = \"bomb\"; point = [24072.6, 24800]; } );\n"
                 "vehicles = ( { kind = \"carrier\"; at = [24070, 25060]; heading_deg = 0;"
                 " speed_mps = 16; behaviour = \"hold\"; },\n"
                 "{ kind = \"jeep\"; at = [24070, 24860]; heading_deg = 357; speed_mps = 1;"
                 " behaviour = \"hold\"; } );\n");
    judged_continue(&f, &check, 1200);
    assert_int_equal(count_bad(), 0);
    physics_check_free(&check);
    fixture_close(&f);
}

/* Pairs of vehicles drive into each other in craters, each pair in one of its own. */
static void test_figure_8_leaves_vehicles_on_the_ground(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; response = \"figure8\"; };");
    struct state now = fixture_state(&f);
    for (uint32_t i = 0; i < VEHICLES; i++) {
        double x = 2.0 * APART_M * i + 25000.0, z = 25000.0;
        now.craters[i] = (struct crater){x + fixture_uniform(&random, 0.0, 12.0), z, 4.0f, 1.2f, 0};
        (void)steps_put_driving(&f, kinds[i % 5], x, z, fixture_uniform(&random, 60.0, 120.0), 5.0);
        (void)steps_put_driving(&f, kinds[i % 3], x + 16.0, z,
                                fixture_uniform(&random, 240.0, 300.0), 5.0);
    }
    for (int buffer = 0; buffer < 2; buffer++)
        f.view.w[buffer].head->crater_count = VEHICLES;
    fixture_run(&f, 1); /* the ground lifts them */
    judged_continue(&f, &check, 240);
    const struct measure *height = &check.measures.of[MEASURE_OF_HEIGHT];
    print_message("%lu collisions, at most %.2g m off the ground\n",
                  (unsigned long)fixture_event_count(&f, EVENT_COLLISION), height->worst);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > VEHICLES / 2);
    assert_true(measure_good(&check.measures, MEASURE_OF_HEIGHT));
    physics_check_free(&check);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_new_craters_lift_what_is_over_them),
        cmocka_unit_test(test_a_carrier_wedged_in_a_crater_gains_no_energy),
        cmocka_unit_test(test_figure_8_leaves_vehicles_on_the_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
