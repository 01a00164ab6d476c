/* The standard atmosphere, and the drag functions at points of their published tables. */
#include "mover/motion/drag.h"

#include "world/entity/kind.h"
#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static void test_the_density_is_that_of_the_standard_atmosphere(void **state)
{
    /* ISO 2533, table 1. */
    static const double height_m[] = {0.0, 1000.0, 3000.0, 5000.0, 8000.0, 11000.0};
    static const double ratio[] = {1.0, 0.90748, 0.74215, 0.60117, 0.42899, 0.29708};
    (void)state;
    for (size_t n = 0; n < sizeof ratio / sizeof ratio[0]; n++)
        assert_true(fabs(drag_density_ratio(height_m[n]) / ratio[n] - 1.0) < 0.003);
    assert_true(drag_density_ratio(-50.0) == 1.0);
    assert_true(drag_density_ratio(30000.0) == drag_density_ratio(11000.0));
}

/* The coefficient that the rate at sea level stands for. */
static double coefficient(enum drag_function function, double mach)
{
    const struct kind kind = {.drag = (uint8_t)function, .ballistic_kgpm2 = 500.0};
    double speed = mach * 340.294;
    return drag_rate(&kind, speed, 0.0) * 500.0 / (0.125 * PI * 1.225 * speed);
}

static void test_the_coefficients_are_those_of_the_standard_projectiles(void **state)
{
    static const double mach[] = {0.5, 0.9, 1.0, 1.2, 2.0, 3.0, 5.0};
    static const double g1[] = {0.2032, 0.3415, 0.4805, 0.6393, 0.5934, 0.5133, 0.4988};
    static const double g7[] = {0.1194, 0.1464, 0.3803, 0.3884, 0.2980, 0.2424, 0.1618};
    (void)state;
    for (size_t n = 0; n < sizeof mach / sizeof mach[0]; n++) {
        assert_true(fabs(coefficient(DRAG_G1, mach[n]) - g1[n]) < 1e-9);
        assert_true(fabs(coefficient(DRAG_G7, mach[n]) - g7[n]) < 1e-9);
    }
    assert_true(fabs(coefficient(DRAG_G7, 9.0) - 0.1618) < 1e-9); /* the last value goes on */
    assert_true(fabs(coefficient(DRAG_G1, 1.025) - 0.5 * (0.4805 + 0.5427)) < 1e-9);
}

static void test_drag_falls_with_height_and_is_none_without_a_function(void **state)
{
    struct kind kind = {.drag = DRAG_G7, .ballistic_kgpm2 = 237.0};
    (void)state;
    assert_true(drag_rate(&kind, 800.0, 3000.0) < 0.8 * drag_rate(&kind, 800.0, 0.0));
    assert_true(drag_rate(&kind, 0.0, 0.0) == 0.0);
    kind.drag = DRAG_NONE;
    assert_true(drag_rate(&kind, 800.0, 0.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_density_is_that_of_the_standard_atmosphere),
        cmocka_unit_test(test_the_coefficients_are_those_of_the_standard_projectiles),
        cmocka_unit_test(test_drag_falls_with_height_and_is_none_without_a_function),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
