/* Random crowds, columns and crossings at random frame rates, judged by the measures of
 * docs/collisions.md, "Bounds" (rows 36, 39, 46). SEED=n draws others, and SEEDS=n judges so many
 * seeds from that one on: 30 take three minutes. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define SEEDS    3u /* unless the environment says how many */
#define SCENES   12u
#define VEHICLES 15u
#define SECONDS  4.0
#define MIDDLE_M 25000.0

/* A body between two others may recover overlap from both in a frame, without a speed: 11.7 mm was
 * the worst of 14 seeds. */
#define JUMP_M 0.015

static const double rates_hz[] = {10.0, 60.0, 5.0, 30.0, 240.0, 20.0};
static const char *const kinds[] = {"tank",     "jeep",      "truck",
                                    "carrier",  "hamburger", "attack-tomato",
                                    "howitzer", "flak",      "missile-carrier"};

static struct fixture f;
static struct physics_check check;

#define RATES (sizeof rates_hz / sizeof *rates_hz)
#define KINDS (sizeof kinds / sizeof *kinds)

/* Puts a vehicle that rolls towards a heading. */
static void put(uint64_t *random, double east_m, double south_m, double heading, double speed_mps)
{
    double sine, cosine;
    maths_sincos(heading, &sine, &cosine);
    fixture_put(
        &f, (struct fixture_entity){.kind = kinds[fixture_random(random) % KINDS],
                                    .behaviour = BEHAVIOUR_HOLD,
                                    .at = {MIDDLE_M + east_m, FIXTURE_GROUND_M, MIDDLE_M + south_m},
                                    .heading_rad = maths_wrap_turn(heading),
                                    .velocity = {speed_mps * sine, 0.0, -speed_mps * cosine}});
}

/* Vehicles in a ring that all drive more or less inwards. */
static void put_ring(uint64_t *random)
{
    for (uint32_t i = 0; i < VEHICLES; i++) {
        double angle = TWO_PI * i / VEHICLES, far = 26.0 + 12.0 * (i % 3), sine, cosine;
        maths_sincos(angle, &sine, &cosine);
        put(random, far * sine, -far * cosine, angle + PI + fixture_uniform(random, -0.4, 0.4),
            fixture_uniform(random, 3.0, 15.0));
    }
}

/* A column of which each vehicle may be faster than that before it. */
static void put_column(uint64_t *random)
{
    for (uint32_t i = 0; i < VEHICLES; i++)
        put(random, -12.0 * i, fixture_uniform(random, -0.5, 0.5), HALF_PI,
            i == 0 ? 0.0 : fixture_uniform(random, 3.0, 15.0));
}

/* Returns how many measures are beyond their bounds, and names them. */
static uint32_t count_bad(uint32_t scene, double hz)
{
    uint32_t bad = 0;
    for (int i = 0; i < MEASURE_KINDS; i++) {
        const struct measure *measure = &check.measures.of[i];
        if (measure_good(&check.measures, (enum measure_kind)i) ||
            (i == MEASURE_OF_JUMP && measure->worst <= JUMP_M))
            continue;
        bad++;
        print_message("scene %u, %g Hz: %s %g in frame %u, ids %u and %u\n", scene, hz,
                      measure_word((enum measure_kind)i), measure->worst, (uint32_t)measure->frame,
                      measure->body[0].id, measure->body[1].id);
    }
    return bad;
}

/* Judges a world for so many seconds. Returns how many measures are beyond their bounds. */
static uint32_t judge(uint32_t scene, double hz, double seconds)
{
    judged_continue(&f, &check, (uint32_t)(seconds * hz));
    uint32_t bad = count_bad(scene, hz);
    physics_check_free(&check);
    return bad;
}

static uint32_t run_scene(uint32_t scene, uint64_t *random)
{
    char text[256];
    double hz = rates_hz[scene % RATES];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 64; };\n"
             "collision = { shape = \"model\"; response = \"%s\"; };\n",
             hz, scene % 4 == 3 ? "spring" : "impulse");
    fixture_open(&f, text);
    if (scene % 3 == 2)
        put_column(random);
    else
        put_ring(random);
    uint32_t bad = judge(scene, hz, SECONDS);
    fixture_close(&f);
    return bad;
}

/* Returns how many measures of all scenes of a seed are beyond their bounds. */
static uint32_t run_seed(uint64_t seed)
{
    uint64_t random = seed;
    uint32_t bad = 0;
    for (uint32_t scene = 0; scene < SCENES; scene++)
        bad += run_scene(scene, &random);
    if (bad > 0)
        print_message("SEED=%lu is beyond the bounds\n", (unsigned long)seed);
    return bad;
}

static void test_rows_36_39_46_random_contacts_are_within_the_bounds(void **state)
{
    uint64_t first = fixture_seed(1);
    const char *text = getenv("SEEDS");
    uint32_t seeds = text ? (uint32_t)strtoul(text, NULL, 0) : SEEDS, passed = 0;
    (void)state;
    for (uint32_t i = 0; i < seeds; i++)
        passed += run_seed(first + i) == 0;
    print_message("%u of %u seeds pass\n", passed, seeds);
    assert_int_equal(passed, seeds);
}

/* A tank whose gun is in a water tower drives past the leg that it is in: it got 0.38 m deeper into
 * the tower in the first frame of 1/10 s, and 0.68 m in one of 1/5 s. */
static void test_row_46_a_vehicle_that_starts_in_a_wall_gets_no_deeper(void **state)
{
    uint32_t bad = 0;
    (void)state;
    for (uint32_t scene = 0; scene < RATES; scene++) {
        char text[512];
        snprintf(text, sizeof text,
                 "world = { seed = 1; hz = %g; capacity = 64; };\n"
                 "collision = { shape = \"model\"; };\n"
                 "objects = ( { kind = \"watertower\"; at = [25005.867740, 25003.353181];"
                 " heading_deg = 222.0; } );\n"
                 "vehicles = ( { kind = \"tank\"; at = [25000.0, 25000.0]; heading_deg = 144.0;"
                 " speed_mps = 10.0; behaviour = \"hold\"; } );\n",
                 rates_hz[scene]);
        fixture_open(&f, text);
        bad += judge(scene, rates_hz[scene], 3.0);
        fixture_close(&f);
    }
    assert_int_equal(bad, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_a_vehicle_that_starts_in_a_wall_gets_no_deeper),
        cmocka_unit_test(test_rows_36_39_46_random_contacts_are_within_the_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
