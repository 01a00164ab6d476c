/* Gridsquares of 10^6 random points against whole-number arithmetic (row 1). */
#include "world/terrain/gridsquare.h"

#include "tests/support/fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define POINTS 1000000

/* floor() of a double is exact, and so is dividing whole numbers. */
static int64_t oracle_axis(double metres)
{
    int64_t whole = (int64_t)floor(metres);
    return whole < 0 ? 0 : whole >= 50000 ? 399 : whole / 125;
}

/* Anywhere, a few ulps around a border, around the edges, very near the origin. */
static double random_coordinate(uint64_t *random)
{
    double metres = 0.0;
    switch (fixture_random(random) % 4) {
    case 0:
        return fixture_uniform(random, 0.0, 50000.0);
    case 1:
        metres = 125.0 * (double)(fixture_random(random) % 401);
        for (uint64_t ulps = fixture_random(random) % 4; ulps > 0; ulps--)
            metres = nextafter(metres, fixture_random(random) % 2 ? 1e9 : -1e9);
        return metres;
    case 2:
        return fixture_uniform(random, -1000.0, 51000.0);
    default:
        return exp(fixture_uniform(random, -700.0, 11.0));
    }
}

/* row 1 */
static void test_every_point_is_in_the_square_of_exact_arithmetic(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double x = random_coordinate(&random), z = random_coordinate(&random);
        if (gridsquare_of(&GRIDSQUARES_DEFAULT, x, z) !=
            (uint64_t)(oracle_axis(z) * 400 + oracle_axis(x)))
            fail_msg("(%a, %a) is in square %u", x, z, gridsquare_of(&GRIDSQUARES_DEFAULT, x, z));
    }
}

/* row 1: exactly one: a point inside the world is within the bounds of its square and no other */
static void test_every_point_lies_within_its_square(void **state)
{
    uint64_t random = fixture_seed(2);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double x = fixture_uniform(&random, 0.0, 50000.0);
        int32_t column = gridsquare_axis(&GRIDSQUARES_DEFAULT, x);
        if (!(x >= column * 125.0 && x < (column + 1) * 125.0))
            fail_msg("%a is in column %d", x, column);
    }
}

/* rows 1, 3: a box's squares are those of the points in it */
static void test_box_holds_the_squares_of_its_points(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    for (int i = 0; i < POINTS / 10; i++) {
        double x0 = random_coordinate(&random), x1 = random_coordinate(&random);
        double z0 = random_coordinate(&random), z1 = random_coordinate(&random);
        struct gridsquare_box box = gridsquare_box_of(&GRIDSQUARES_DEFAULT, fmin(x0, x1),
                                                      fmin(z0, z1), fmax(x0, x1), fmax(z0, z1));
        double x = x0 + (x1 - x0) * fixture_uniform(&random, 0.0, 1.0);
        int32_t column =
            gridsquare_axis(&GRIDSQUARES_DEFAULT, fmin(fmax(x, fmin(x0, x1)), fmax(x0, x1)));
        assert_true(box.x0 <= column && column <= box.x1);
        assert_true(box.z0 <= gridsquare_axis(&GRIDSQUARES_DEFAULT, z0) &&
                    gridsquare_axis(&GRIDSQUARES_DEFAULT, z0) <= box.z1);
        assert_int_equal(box.x0, oracle_axis(fmin(x0, x1)));
        assert_int_equal(box.x1, oracle_axis(fmax(x0, x1)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_point_is_in_the_square_of_exact_arithmetic),
        cmocka_unit_test(test_every_point_lies_within_its_square),
        cmocka_unit_test(test_box_holds_the_squares_of_its_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
