/* Gridsquares: every point is in exactly one, at borders, edges and beyond (row 1). */
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* row 1: 50 km in 400 x 400 squares of 125 m */
static void test_the_square_is_50_km_of_125_m(void **state)
{
    (void)state;
    assert_int_equal(GRIDSQUARE_COUNT, 160000);
    assert_true(GRIDSQUARE_SIDE_M * GRIDSQUARE_PER_SIDE == WORLD_SIDE_M);
    assert_true(WORLD_SIDE_M == 50000.0);
}

/* row 1: a border belongs to the square east or south of it, one ulp before it does not */
static void test_borders_belong_to_the_square_after_them(void **state)
{
    (void)state;
    for (int32_t k = 1; k < GRIDSQUARE_PER_SIDE; k++) {
        double border = k * GRIDSQUARE_SIDE_M;
        assert_int_equal(gridsquare_axis(border), k);
        assert_int_equal(gridsquare_axis(nextafter(border, 0.0)), k - 1);
        assert_int_equal(gridsquare_axis(nextafter(border, 1e9)), k);
    }
}

/* row 1: the far edges included */
static void test_far_edges_and_beyond_are_the_last_square(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_axis(nextafter(WORLD_SIDE_M, 0.0)), 399);
    assert_int_equal(gridsquare_axis(WORLD_SIDE_M), 399);
    assert_int_equal(gridsquare_axis(nextafter(WORLD_SIDE_M, 1e9)), 399);
    assert_int_equal(gridsquare_axis(1e300), 399);
    assert_int_equal(gridsquare_axis(INFINITY), 399);
}

static void test_near_edges_and_before_are_the_first_square(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_axis(0.0), 0);
    assert_int_equal(gridsquare_axis(-0.0), 0);
    assert_int_equal(gridsquare_axis(5e-324), 0);
    assert_int_equal(gridsquare_axis(-5e-324), 0);
    assert_int_equal(gridsquare_axis(-1e300), 0);
    assert_int_equal(gridsquare_axis(-INFINITY), 0);
}

static void test_nan_is_in_the_first_square(void **state)
{
    volatile double nan = NAN; /* volatile: computed by the program, not by the compiler */
    (void)state;
    assert_int_equal(gridsquare_axis(nan), 0);
    assert_int_equal(gridsquare_of(nan, nan), 0);
    assert_int_equal(gridsquare_of(nan, 130.0), 400);
}

static void test_corners(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_of(0.0, 0.0), 0);
    assert_int_equal(gridsquare_of(WORLD_SIDE_M, 0.0), 399);
    assert_int_equal(gridsquare_of(0.0, WORLD_SIDE_M), 399 * 400);
    assert_int_equal(gridsquare_of(WORLD_SIDE_M, WORLD_SIDE_M), GRIDSQUARE_COUNT - 1);
}

static void test_index_is_row_times_400_plus_column(void **state)
{
    (void)state;
    for (int32_t row = 0; row < GRIDSQUARE_PER_SIDE; row++) {
        for (int32_t column = 0; column < GRIDSQUARE_PER_SIDE; column++) {
            double x = (column + 0.5) * GRIDSQUARE_SIDE_M, z = (row + 0.5) * GRIDSQUARE_SIDE_M;
            assert_int_equal(gridsquare_of(x, z), row * 400 + column);
        }
    }
}

static void test_box_takes_in_the_squares_it_touches(void **state)
{
    (void)state;
    struct gridsquare_box box = gridsquare_box_of(124.0, 250.0, 250.0, 300.0);
    assert_int_equal(box.x0, 0);
    assert_int_equal(box.x1, 2); /* its border at 250 belongs to column 2 */
    assert_int_equal(box.z0, 2);
    assert_int_equal(box.z1, 2);
    box = gridsquare_box_of(-1e9, -1.0, 1e9, 0.0);
    assert_int_equal(box.x0, 0);
    assert_int_equal(box.x1, 399);
    assert_int_equal(box.z0, 0);
    assert_int_equal(box.z1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_square_is_50_km_of_125_m),
        cmocka_unit_test(test_borders_belong_to_the_square_after_them),
        cmocka_unit_test(test_far_edges_and_beyond_are_the_last_square),
        cmocka_unit_test(test_near_edges_and_before_are_the_first_square),
        cmocka_unit_test(test_nan_is_in_the_first_square),
        cmocka_unit_test(test_corners),
        cmocka_unit_test(test_index_is_row_times_400_plus_column),
        cmocka_unit_test(test_box_takes_in_the_squares_it_touches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
