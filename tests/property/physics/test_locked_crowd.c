/* The judge finds no jump and no growing overlap in a crowd that is locked and becomes wider as a
 * whole. SEED=n draws others, SEEDS=n judges so many. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define BODIES  40u
#define FRAMES  110u
#define REACH_M 5.0

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;

static void put(uint64_t *random)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = 25000.0 + fixture_uniform(random, -REACH_M, REACH_M);
        double z = 25000.0 + fixture_uniform(random, -REACH_M, REACH_M);
        fixture_put(&f,
                    (struct fixture_entity){.kind = kinds[i % 4],
                                            .behaviour = BEHAVIOUR_HOLD,
                                            .at = {x, steps_ground_at(&f, x, z), z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
    }
}

static void judge(uint64_t seed)
{
    struct physics_check check;
    uint64_t random = seed;
    fixture_open(&f, "world = { capacity = 256; }; collision = { shape = \"model\"; };");
    steps_ground(&f, steps_waves, NULL);
    put(&random);
    judged_continue(&f, &check, FRAMES);
    print_message("seed %u: jump %g m, growth %g m\n", (unsigned)seed,
                  check.measures.of[MEASURE_OF_JUMP].worst,
                  check.measures.of[MEASURE_OF_OVERLAP_GROWTH].worst);
    assert_true(measure_good(&check.measures, MEASURE_OF_JUMP));
    assert_true(measure_good(&check.measures, MEASURE_OF_OVERLAP));
    assert_true(measure_good(&check.measures, MEASURE_OF_OVERLAP_GROWTH));
    physics_check_free(&check);
    fixture_close(&f);
}

static void test_a_crowd_that_opens_is_within_the_bounds(void **state)
{
    const char *seeds = getenv("SEEDS");
    uint64_t seed = fixture_seed(1), count = seeds ? strtoull(seeds, NULL, 10) : 2;
    (void)state;
    for (uint64_t n = 0; n < count; n++)
        judge(seed + n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_crowd_that_opens_is_within_the_bounds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
