/* Shapes in a picture of a ground: how much they cover, where, and what lies outside. */
#include "supervisor/ground/canvas.h"

#include "tests/support/fixture.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define SIZE  100u
#define BYTES (3u * SIZE * SIZE)
#define GUARD 4096u

static uint8_t memory[GUARD + BYTES + GUARD];
static const struct canvas_colour white = {255, 255, 255};

/* 100 x 100 pixels of 2 m; the first pixel's middle is at [1000, 2000]. */
static struct canvas fresh(void)
{
    memset(memory, 0, sizeof memory);
    return (struct canvas){memory + GUARD, SIZE, 1000.0, 2000.0, 2.0};
}

/* Returns the area that is white [m2]. */
static double area(const struct canvas *canvas)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < BYTES; i += 3)
        sum += canvas->pixels[i] / 255.0;
    return sum * canvas->step_m * canvas->step_m;
}

static uint8_t at(const struct canvas *canvas, uint32_t column, uint32_t row)
{
    return canvas->pixels[3 * (row * SIZE + column)];
}

static void test_a_polygon_covers_its_area(void **state)
{
    (void)state;
    struct canvas canvas = fresh();
    const double box[4][2] = {{1019, 2039}, {1061, 2039}, {1061, 2081}, {1019, 2081}};
    canvas_polygon(&canvas, box, 4, white);
    assert_true(fabs(area(&canvas) - 42.0 * 42.0) < 1.0);
    assert_int_equal(at(&canvas, 10, 20), 255); /* 1020, 2040 */
    assert_int_equal(at(&canvas, 9, 20), 0);
    assert_int_equal(at(&canvas, 30, 40), 255);
    assert_int_equal(at(&canvas, 31, 40), 0);
    canvas = fresh();
    const double horseshoe[8][2] = {{1010, 2010}, {1040, 2010}, {1040, 2050}, {1030, 2050},
                                    {1030, 2020}, {1020, 2020}, {1020, 2050}, {1010, 2050}};
    canvas_polygon(&canvas, horseshoe, 8, white);
    assert_true(fabs(area(&canvas) - 900.0) < 20.0);
    assert_int_equal(at(&canvas, 12, 20), 0); /* within its gap: 1024, 2040 */
}

static void test_small_polygons_are_shades(void **state)
{
    uint64_t random = fixture_seed(1);
    double sum = 0.0, right = 0.0;
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        struct canvas canvas = fresh();
        double x = 1050.0 + 4.0 * random_unit(random, i, 0, 0);
        double z = 2050.0 + 4.0 * random_unit(random, i, 1, 0);
        double angle = TWO_PI * random_unit(random, i, 2, 0), corner[4][2];
        for (int k = 0; k < 4; k++) {
            corner[k][0] = x + 0.7 * cos(angle + k * 0.25 * TWO_PI);
            corner[k][1] = z + 0.7 * sin(angle + k * 0.25 * TWO_PI);
        }
        canvas_polygon(&canvas, (const double(*)[2])corner, 4, white);
        sum += area(&canvas);
        right += 2.0 * 0.7 * 0.7;
    }
    assert_true(fabs(sum - right) < 0.05 * right);
}

static void test_lines_and_discs_have_their_size_or_the_least(void **state)
{
    (void)state;
    struct canvas canvas = fresh();
    canvas_line(&canvas, (double[2]){1020, 2100}, (double[2]){1180, 2100}, 8.0, 1.0, white);
    assert_true(fabs(area(&canvas) - (160.0 * 8.0 + 16.0 * PI)) < 16.0);
    canvas = fresh();
    canvas_line(&canvas, (double[2]){1020, 2100}, (double[2]){1180, 2140}, 0.1, 1.0, white);
    assert_true(area(&canvas) > 300.0 && area(&canvas) < 360.0); /* a pixel wide */
    canvas = fresh();
    canvas_disc(&canvas, (double[2]){1100, 2100}, 20.0, 1.0, white);
    assert_true(fabs(area(&canvas) - 400.0 * PI) < 20.0);
    canvas = fresh();
    canvas_disc(&canvas, (double[2]){1100, 2100}, 0.0, 0.0, white);
    assert_true(at(&canvas, 50, 50) > 0);
}

static void test_what_lies_outside_touches_nothing(void **state)
{
    uint64_t random = fixture_seed(2);
    (void)state;
    struct canvas canvas = fresh();
    for (uint64_t i = 0; i < 3000; i++) {
        double p[4][2];
        for (int k = 0; k < 4; k++) {
            p[k][0] = 1000.0 + 800.0 * (random_unit(random, i, (uint64_t)k, 0) - 0.5);
            p[k][1] = 2000.0 + 800.0 * (random_unit(random, i, (uint64_t)k, 1) - 0.5);
        }
        canvas_polygon(&canvas, (const double(*)[2])p, 4, white);
        canvas_line(&canvas, p[0], p[1], 9.0, 1.0, white);
        canvas_disc(&canvas, p[2], 30.0, 1.0, white);
    }
    canvas_disc(&canvas, (double[2]){-1e12, 1e12}, 1.0, 1.0, white);
    for (uint32_t i = 0; i < GUARD; i++)
        assert_true(memory[i] == 0 && memory[GUARD + BYTES + i] == 0);
    canvas = fresh();
    canvas_disc(&canvas, (double[2]){1300, 2100}, 20.0, 1.0, white);
    canvas_line(&canvas, (double[2]){900, 1900}, (double[2]){1300, 1900}, 4.0, 1.0, white);
    assert_true(area(&canvas) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_polygon_covers_its_area),
        cmocka_unit_test(test_small_polygons_are_shades),
        cmocka_unit_test(test_lines_and_discs_have_their_size_or_the_least),
        cmocka_unit_test(test_what_lies_outside_touches_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
