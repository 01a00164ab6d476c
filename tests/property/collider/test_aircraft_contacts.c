/* Aircraft that fly together and press on each other, and such that nobody steers and that meet
 * (thesis rows 36, 39, 46): they keep flying, and end no frame in each other. SEED=n puts them
 * elsewhere. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HELICOPTERS  6u
#define RUNS         6u
#define SECONDS      6.0
#define TOGETHER_MPS 20.0 /* of all, eastwards */
#define PRESS_MPS2   2.0  /* towards the middle of them all */
#define INWARDS_MPS  1.5  /* of each, at most */

#define OVERLAP_M 1e-3
#define STOOD     0.05 /* of the frames in which a helicopter may not move */

static struct fixture f;

/* Puts helicopters around a point, towards which they drift while all fly eastwards. */
static void put_all(uint64_t *random)
{
    for (uint32_t i = 0; i < HELICOPTERS; i++) {
        double angle = TWO_PI * i / HELICOPTERS, sine, cosine;
        double inwards = fixture_uniform(random, 0.5, 1.0) * INWARDS_MPS;
        maths_sincos(angle, &sine, &cosine);
        double east = TOGETHER_MPS - inwards * sine;
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                .behaviour = BEHAVIOUR_PATROL,
                                                .at = {25000.0 + 16.0 * sine,
                                                       400.0 + fixture_uniform(random, -0.5, 0.5),
                                                       25000.0 - 16.0 * cosine},
                                                .heading_rad = fixture_uniform(random, 0.0, TWO_PI),
                                                .velocity = {east, 0.0, inwards * cosine}});
    }
}

/* Presses them towards their middle, like pilots who all want to be there. */
static void press(double dt_s)
{
    struct entities e = steps_rows(&f);
    struct vec3 middle = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < HELICOPTERS; i++)
        middle = vec3_add(middle, vec3_scale(entities_position(&e, i), 1.0 / HELICOPTERS));
    for (uint32_t i = 0; i < HELICOPTERS; i++) {
        struct vec3 to = vec3_sub(middle, entities_position(&e, i));
        struct vec3 change = vec3_scale(to, PRESS_MPS2 * dt_s / vec3_length(to));
        entities_set_velocity(&e, i, vec3_add(entities_velocity(&e, i), change));
    }
}

static void run_and_look(double hz, uint64_t *random)
{
    char text[128];
    double deepest = 0.0, stood = 0.0;
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 64; cruise = false; };\ncollision = { shape "
             "= \"model\"; };",
             hz);
    fixture_open(&f, text);
    steps_kind(&f, "helicopter")->resistance_j = 1e12;
    put_all(random);
    for (uint32_t frame = 0; frame < (uint32_t)(SECONDS * hz); frame++) {
        struct vec3 was[HELICOPTERS];
        struct entities e = steps_rows(&f);
        press(1.0 / hz);
        for (uint32_t i = 0; i < HELICOPTERS; i++)
            was[i] = entities_position(&e, i);
        fixture_run(&f, 1);
        e = steps_rows(&f);
        for (uint32_t i = 0; i < HELICOPTERS; i++) {
            double way = vec3_length(vec3_sub(entities_position(&e, i), was[i])) * hz;
            stood += way < 0.1 * vec3_length(entities_velocity(&e, i));
        }
        deepest = maths_max(deepest, steps_deepest(&f, HELICOPTERS));
    }
    stood /= HELICOPTERS * SECONDS * hz;
    print_message("%g Hz: overlap %.3g mm, stood still in %.2g %% of the frames\n", hz,
                  1e3 * deepest, 100.0 * stood);
    fixture_close(&f);
    assert_true(deepest <= OVERLAP_M);
    assert_true(stood <= STOOD);
}

static void test_helicopters_that_press_on_each_other_fly_on(void **state)
{
    static const double rates_hz[] = {60.0, 30.0, 120.0};
    uint64_t random = fixture_seed(61);
    (void)state;
    for (uint32_t n = 0; n < RUNS; n++)
        run_and_look(rates_hz[n % 3], &random);
}

#define MEET         4u
#define MEETINGS     36u
#define MEET_SECONDS 4.0

/* Helicopters that nobody steers meet over a tank. */
static void put_meeting(double hz, uint64_t *random)
{
    char text[128];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 64; };\ncollision = { shape = \"model\"; };",
             hz);
    fixture_open(&f, text);
    for (uint32_t i = 0; i < MEET; i++) {
        double angle = HALF_PI * i + fixture_uniform(random, -0.3, 0.3), sine, cosine;
        double way = fixture_uniform(random, 20.0, 40.0);
        maths_sincos(angle, &sine, &cosine);
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                .behaviour = BEHAVIOUR_HOLD,
                                                .at = {25000.0 + way * sine,
                                                       103.0 + fixture_uniform(random, 0.0, 2.0),
                                                       25000.0 - way * cosine},
                                                .heading_rad = maths_wrap_turn(angle + PI),
                                                .velocity = {-way * sine, 0.0, way * cosine}});
    }
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .behaviour = BEHAVIOUR_IDLE,
                                            .at = {25000.0, FIXTURE_GROUND_M, 25000.0}});
}

static void test_aircraft_that_nobody_steers_end_no_frame_in_each_other(void **state)
{
    static const double rates_hz[] = {60.0, 10.0, 240.0};
    uint64_t random = fixture_seed(62);
    double worst = 0.0;
    uint32_t met = 0;
    (void)state;
    for (uint32_t n = 0; n < MEETINGS; n++) {
        double hz = rates_hz[n % 3];
        put_meeting(hz, &random);
        for (uint32_t frame = 0; frame < (uint32_t)(MEET_SECONDS * hz); frame++) {
            fixture_run(&f, 1);
            worst = maths_max(worst, steps_deepest(&f, MEET + 1));
        }
        met += fixture_event_count(&f, EVENT_COLLISION);
        fixture_close(&f);
    }
    print_message("# figures: %u meetings, %u impacts told, overlap %.3g mm\n", MEETINGS, met,
                  1e3 * worst);
    assert_true(met > MEETINGS);
    assert_true(worst <= OVERLAP_M);
}

#define GRAZES       100u
#define GRAZE_FRAMES 90u

/* Aircraft that nobody steers drift past each other slowly and turn: what gets into the other need
 * not close by its velocity. */
static void test_aircraft_that_turn_past_each_other_end_no_frame_in_each_other(void **state)
{
    static const char *const kinds[] = {"jet", "helicopter", "helo-cow", "wishbone"};
    uint64_t random = fixture_seed(63);
    double worst = 0.0;
    uint32_t met = 0;
    (void)state;
    fixture_open(&f, "world = { seed = 1; hz = 60.0; capacity = 64; };\n"
                     "collision = { shape = \"model\"; };");
    for (uint32_t n = 0; n < GRAZES; n++) {
        steps_empty(&f);
        for (uint32_t i = 0; i < 2; i++) {
            struct vec3 off = vec3_scale(fixture_direction(&random), i == 0 ? 0.0 : 11.0);
            struct vec3 drift = vec3_scale(fixture_direction(&random), 1.0);
            uint32_t row = fixture_put(
                &f,
                (struct fixture_entity){.kind = kinds[fixture_random(&random) % 4],
                                        .behaviour = BEHAVIOUR_HOLD,
                                        .at = vec3_add((struct vec3){25000.0, 400.0, 25000.0}, off),
                                        .heading_rad = fixture_uniform(&random, 0.0, TWO_PI),
                                        .velocity = vec3_add(drift, vec3_scale(off, -0.9))});
            struct entities e = steps_rows(&f);
            struct vec3 spin = vec3_scale(fixture_direction(&random), 1.5);
            e.row[row].spin_x = spin.x, e.row[row].spin_y = spin.y, e.row[row].spin_z = spin.z;
        }
        for (uint32_t frame = 0; frame < GRAZE_FRAMES; frame++) {
            fixture_run(&f, 1);
            worst = maths_max(worst, steps_deepest(&f, 2));
        }
        met += fixture_event_count(&f, EVENT_COLLISION) > 0;
    }
    fixture_close(&f);
    print_message("# figures: %u of %u pairs met, overlap %.3g mm\n", met, GRAZES, 1e3 * worst);
    assert_true(met > GRAZES / 2);
    assert_true(worst <= OVERLAP_M);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_helicopters_that_press_on_each_other_fly_on),
        cmocka_unit_test(test_aircraft_that_turn_past_each_other_end_no_frame_in_each_other),
        cmocka_unit_test(test_aircraft_that_nobody_steers_end_no_frame_in_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
