/* The judge finds no jump and no growing overlap in a crowd that is locked and becomes wider as a
 * whole, nor in one on a slope. SEED=n draws others, SEEDS=n judges so many. */
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

#define SLOPE         0.3
#define SLOPE_REACH_M 6.0

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;

static void put(double reach_m, uint64_t *random)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = 25000.0 + fixture_uniform(random, -reach_m, reach_m);
        double z = 25000.0 + fixture_uniform(random, -reach_m, reach_m);
        fixture_put(&f,
                    (struct fixture_entity){.kind = kinds[i % 4],
                                            .behaviour = BEHAVIOUR_HOLD,
                                            .at = {x, steps_ground_at(&f, x, z), z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
    }
}

/* slope: 0 for hills. */
static void judge(uint64_t seed, double reach_m, double slope)
{
    struct physics_check check;
    uint64_t random = seed;
    fixture_open(&f, "world = { capacity = 256; }; collision = { shape = \"model\"; };");
    if (slope > 0.0)
        steps_plane(&f, 0.8 * slope, 0.6 * slope);
    else
        steps_ground(&f, steps_waves, NULL);
    put(reach_m, &random);
    fixture_continue(&f, slope > 0.0 ? 1 : 0); /* the ground turns them */
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
        judge(seed + n, REACH_M, 0.0);
}

/* Those who had made way stayed where the guard had sent them, 45 mm from anybody (the first
 * crowd), a crowd that opened went down a slope faster than it may, and the guard compared the
 * pieces of bodies whose way out got longer by 0.13 mm (the second). */
static void test_a_crowd_on_a_slope_is_within_the_bounds(void **state)
{
    static const uint64_t found[] = {2, 5};
    uint64_t seed = fixture_seed(0);
    (void)state;
    if (seed != 0)
        judge(seed, SLOPE_REACH_M, SLOPE);
    for (uint32_t i = 0; seed == 0 && i < sizeof found / sizeof *found; i++)
        judge(found[i], SLOPE_REACH_M, SLOPE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_crowd_that_opens_is_within_the_bounds),
        cmocka_unit_test(test_a_crowd_on_a_slope_is_within_the_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
