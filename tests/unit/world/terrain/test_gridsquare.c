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
    assert_int_equal(GRIDSQUARES_DEFAULT.count, 160000);
    assert_true(GRIDSQUARE_LEAST_M * GRIDSQUARES_DEFAULT.per_side == WORLD_SIDE_DEFAULT_M);
    assert_true(WORLD_SIDE_DEFAULT_M == 50000.0);
}

static void test_worlds_of_any_side_are_divided(void **state)
{
    static const struct {
        double world_m, side_m;
        int32_t per_side;
    } rows[] = {{1000.0, 125.0, 8},      {1125.0, 125.0, 9},     {50000.0, 125.0, 400},
                {128000.0, 125.0, 1024}, {128125.0, 250.0, 513}, {256000.0, 250.0, 1024},
                {256125.0, 500.0, 513},  {500000.0, 500.0, 1000}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct gridsquares squares = gridsquares_of(rows[i].world_m);
        assert_true(squares.world_m == rows[i].world_m && squares.side_m == rows[i].side_m);
        assert_int_equal(squares.per_side, rows[i].per_side);
        assert_int_equal(squares.count, rows[i].per_side * rows[i].per_side);
        assert_int_equal(gridsquare_axis(&squares, rows[i].world_m), squares.per_side - 1);
        assert_int_equal(gridsquare_axis(&squares, nextafter(rows[i].world_m, 0.0)),
                         squares.per_side - 1);
        assert_int_equal(gridsquare_axis(&squares, squares.side_m), 1);
        uint32_t last = gridsquare_of(&squares, rows[i].world_m, rows[i].world_m);
        assert_int_equal(last, squares.count - 1);
        assert_int_equal(gridsquare_column(&squares, last), squares.per_side - 1);
        assert_int_equal(gridsquare_row(&squares, last), squares.per_side - 1);
    }
    struct gridsquares usual = gridsquares_of(WORLD_SIDE_DEFAULT_M);
    assert_memory_equal(&usual, &GRIDSQUARES_DEFAULT, sizeof usual);
}

/* row 1: a border belongs to the square east or south of it, one ulp before it does not */
static void test_borders_belong_to_the_square_after_them(void **state)
{
    (void)state;
    for (int32_t k = 1; k < GRIDSQUARES_DEFAULT.per_side; k++) {
        double border = k * GRIDSQUARE_LEAST_M;
        assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, border), k);
        assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, nextafter(border, 0.0)), k - 1);
        assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, nextafter(border, 1e9)), k);
    }
}

/* row 1: the far edges included */
static void test_far_edges_and_beyond_are_the_last_square(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, nextafter(WORLD_SIDE_DEFAULT_M, 0.0)),
                     399);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, WORLD_SIDE_DEFAULT_M), 399);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, nextafter(WORLD_SIDE_DEFAULT_M, 1e9)),
                     399);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, 1e300), 399);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, INFINITY), 399);
}

static void test_near_edges_and_before_are_the_first_square(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, 0.0), 0);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, -0.0), 0);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, 5e-324), 0);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, -5e-324), 0);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, -1e300), 0);
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, -INFINITY), 0);
}

static void test_nan_is_in_the_first_square(void **state)
{
    volatile double nan = NAN; /* volatile: computed by the program, not by the compiler */
    (void)state;
    assert_int_equal(gridsquare_axis(&GRIDSQUARES_DEFAULT, nan), 0);
    assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, nan, nan), 0);
    assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, nan, 130.0), 400);
}

static void test_corners(void **state)
{
    (void)state;
    assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, 0.0, 0.0), 0);
    assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, WORLD_SIDE_DEFAULT_M, 0.0), 399);
    assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, 0.0, WORLD_SIDE_DEFAULT_M), 399 * 400);
    assert_int_equal(
        gridsquare_of(&GRIDSQUARES_DEFAULT, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M),
        GRIDSQUARES_DEFAULT.count - 1);
}

static void test_index_is_row_times_400_plus_column(void **state)
{
    (void)state;
    for (int32_t row = 0; row < GRIDSQUARES_DEFAULT.per_side; row++) {
        for (int32_t column = 0; column < GRIDSQUARES_DEFAULT.per_side; column++) {
            double x = (column + 0.5) * GRIDSQUARE_LEAST_M, z = (row + 0.5) * GRIDSQUARE_LEAST_M;
            assert_int_equal(gridsquare_of(&GRIDSQUARES_DEFAULT, x, z), row * 400 + column);
        }
    }
}

static void test_box_takes_in_the_squares_it_touches(void **state)
{
    (void)state;
    struct gridsquare_box box = gridsquare_box_of(&GRIDSQUARES_DEFAULT, 124.0, 250.0, 250.0, 300.0);
    assert_int_equal(box.x0, 0);
    assert_int_equal(box.x1, 2); /* its border at 250 belongs to column 2 */
    assert_int_equal(box.z0, 2);
    assert_int_equal(box.z1, 2);
    box = gridsquare_box_of(&GRIDSQUARES_DEFAULT, -1e9, -1.0, 1e9, 0.0);
    assert_int_equal(box.x0, 0);
    assert_int_equal(box.x1, 399);
    assert_int_equal(box.z0, 0);
    assert_int_equal(box.z1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_square_is_50_km_of_125_m),
        cmocka_unit_test(test_worlds_of_any_side_are_divided),
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
