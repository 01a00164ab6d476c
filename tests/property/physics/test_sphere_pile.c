/* Bodies that collide as spheres and begin deep in each other part within a second, and the judge
 * finds no leap and no deeper overlap; those that drive part, too (thesis row 46). SEED=n draws
 * others. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"

#include <stdint.h>
#include <stdio.h>

#define BODIES  30u
#define REACH_M 6.0
#define STEEP   0.3
#define APART_M 1e-4
#define DRIVE_S 12.0

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;
static struct physics_check check;

/* Returns how deep the deepest two are in each other [m]. */
static double deepest(void)
{
    const struct entities e = steps_rows(&f);
    const struct kind *known = f.view.world.kinds;
    double most = 0.0;
    for (uint32_t a = 0; a < BODIES; a++) {
        for (uint32_t b = a + 1; b < BODIES; b++) {
            const struct vec3 off = vec3_sub(entities_position(&e, b), entities_position(&e, a));
            double reach = known[e.row[a].kind].radius_m + known[e.row[b].kind].radius_m;
            most = maths_max(most, reach - vec3_length(off));
        }
    }
    return most;
}

static void begin(uint64_t *random, double hz, const char *method, double speed_mps, double slope)
{
    char text[160];
    snprintf(text, sizeof text,
             "world = { hz = %.1f; }; collision = { shape = \"sphere\"; method = \"%s\"; };", hz,
             method);
    fixture_open(&f, text);
    steps_plane(&f, slope, 0.5 * slope);
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = 25000.0 + fixture_uniform(random, -REACH_M, REACH_M);
        double z = 25000.0 + fixture_uniform(random, -REACH_M, REACH_M);
        (void)steps_put_driving(&f, kinds[i % 4], x, z, fixture_uniform(random, 0.0, 360.0),
                                speed_mps);
    }
    assert_true(deepest() > 2.0);
}

static void stand(uint64_t *random, double hz, double slope)
{
    begin(random, hz, "swept", 0.0, slope);
    judged_continue(&f, &check, (uint32_t)hz);
    print_message("%g Hz, slope %.1f: %.2g m deep after a second\n", hz, slope, deepest());
    assert_true(deepest() < APART_M);
    for (int i = 0; i < MEASURE_KINDS; i++) {
        if (!measure_good(&check.measures, (enum measure_kind)i))
            fail_msg("%s %g", measure_word((enum measure_kind)i), check.measures.of[i].worst);
    }
    physics_check_free(&check);
    fixture_close(&f);
}

static void test_row_46_spheres_that_stand_part(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    stand(&random, 60.0, 0.0);
    stand(&random, 10.0, 0.0);
    stand(&random, 240.0, STEEP);
    stand(&random, 60.0, STEEP);
}

static void test_row_46_spheres_that_drive_part(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (uint32_t run = 0; run < 2; run++) {
        begin(&random, 60.0, "swept", 5.0, run * STEEP);
        fixture_continue(&f, (uint32_t)(60.0 * DRIVE_S));
        print_message("%.2g m deep after %g s\n", deepest(), DRIVE_S);
        assert_true(deepest() < APART_M);
        fixture_close(&f);
    }
}

static void begin_by(const char *method)
{
    uint64_t random = 7;
    begin(&random, 60.0, method, 5.0, STEEP);
}

/* The parting depends on neither the order of the pairs nor the number of threads. */
static void test_all_methods_and_threads_give_the_same(void **state)
{
    (void)state;
    steps_methods_agree(&f, begin_by);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_spheres_that_stand_part),
        cmocka_unit_test(test_row_46_spheres_that_drive_part),
        cmocka_unit_test(test_all_methods_and_threads_give_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
