/* Jets' wrecks that fly into one another at 100 m/s hook into a pile and gain no energy. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define WRECKS 8u
#define FRAMES 60u
#define MPS    100.0

static struct fixture f;

/* Wrecks on a ring, a few metres over the ground, that fly towards its middle and tumble. */
static void put(uint64_t *random)
{
    for (uint32_t i = 0; i < WRECKS; i++) {
        double angle = TWO_PI * i / WRECKS + fixture_uniform(random, -0.3, 0.3), sine, cosine;
        double far = fixture_uniform(random, 20.0, 60.0);
        double high = fixture_uniform(random, 102.0, 112.0);
        maths_sincos(angle, &sine, &cosine);
        double down = fixture_uniform(random, -5.0, 0.0);
        double off = fixture_uniform(random, -0.5, 0.5);
        uint32_t row = fixture_put(
            &f, (struct fixture_entity){.kind = "jet",
                                        .behaviour = BEHAVIOUR_HOLD,
                                        .at = {25000.0 + far * sine, high, 25000.0 - far * cosine},
                                        .velocity = {-MPS * sine, down, MPS * cosine},
                                        .heading_rad = maths_wrap_turn(angle + PI + off)});
        struct entities e = steps_rows(&f);
        e.row[row].state = ENTITY_WRECK;
        e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
        e.row[row].spin_x = fixture_uniform(random, -1.0, 1.0);
        e.row[row].spin_z = fixture_uniform(random, -1.0, 1.0);
    }
}

/* A wreck that had its eight impacts stays until the frame ends. It kept the speed of a whole fall,
 * and gained up to 3.4 J/kg in a frame. */
static void test_who_stays_has_not_fallen(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        struct physics_check check;
        uint64_t random = seed;
        fixture_open(&f, "world = { hz = 10.0; capacity = 256; }; "
                         "collision = { shape = \"model\"; };");
        put(&random);
        fixture_run(&f, 1);
        judged_continue(&f, &check, FRAMES);
        print_message("seed %u: %g J/kg\n", (unsigned)seed,
                      check.measures.of[MEASURE_OF_ENERGY].worst);
        assert_true(measure_good(&check.measures, MEASURE_OF_ENERGY));
        physics_check_free(&check);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_who_stays_has_not_fallen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
