/* What breaks costs energy and takes momentum. Random cases are in
 * tests/property/collider/test_breaking.c. */
#include "collider/response/breaking.h"

#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static bool near(double value, double right)
{
    return fabs(value - right) <= 1e-12 * fabs(right);
}

static void test_the_strength_and_then_the_mass_slow_it(void **state)
{
    /* 2 t at 20 m/s have 400 kJ. 144 kJ break the object; 16 m/s are left for 2 t and 0.5 t. */
    const struct breaking_input input = {2000.0, 20.0, 144e3, 500.0};
    const struct breaking b = breaking_of(&input);
    (void)state;
    assert_true(b.breaks && near(b.speed_mps, 12.8));
    assert_true(near(b.impulse_ns, 2000.0 * 7.2));
    assert_true(near(b.lost_j, 400e3 - 0.5 * 2500.0 * 12.8 * 12.8));
}

static void test_too_slow_a_vehicle_breaks_nothing(void **state)
{
    struct breaking_input input = {2000.0, 12.0, 144e3, 500.0};
    (void)state;
    assert_true(breaking_of(&input).breaks && breaking_of(&input).speed_mps == 0.0);
    input.closing_mps *= 1.0 - 1e-9;
    assert_false(breaking_of(&input).breaks);
}

static void test_a_bush_only_shares_the_momentum(void **state)
{
    const struct breaking_input input = {1100.0, 10.0, 0.0, 30.0};
    (void)state;
    assert_true(near(breaking_of(&input).speed_mps, 10.0 * 1100.0 / 1130.0));
    const struct breaking_input rest = {1100.0, 0.0, 0.0, 30.0};
    assert_true(breaking_of(&rest).impulse_ns == 0.0 && breaking_of(&rest).lost_j == 0.0);
}

static void test_the_part_that_moves(void **state)
{
    static const struct kind tank = {.width_m = 4.0, .height_m = 2.5};
    struct kind tree = {.object_class = OBJECT_TREE, .mass_kg = 3000.0, .height_m = 9.0};
    struct kind house = {.object_class = OBJECT_BUILDING,
                         .mass_kg = 180e3,
                         .length_m = 18.0,
                         .width_m = 12.0,
                         .height_m = 8.0};
    (void)state;
    assert_true(near(breaking_debris_kg(&tree, &tank, 0.0), 750.0)); /* struck at its foot */
    assert_true(near(breaking_debris_kg(&tree, &tank, 4.5), 3000.0));
    assert_true(near(breaking_debris_kg(&tree, &tank, -1.0), 750.0));
    assert_true(near(breaking_debris_kg(&tree, &tank, 99.0), 750.0));
    tree.object_class = OBJECT_BUSH;
    assert_true(breaking_debris_kg(&tree, &tank, 0.0) == 3000.0);
    assert_true(near(breaking_debris_kg(&house, &tank, 0.0), 180e3 * 10.0 / 480.0));
    house.height_m = 0.5;
    house.length_m = house.width_m = 0.5; /* the tank is before all of it */
    assert_true(breaking_debris_kg(&house, &tank, 0.0) == 180e3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_strength_and_then_the_mass_slow_it),
        cmocka_unit_test(test_too_slow_a_vehicle_breaks_nothing),
        cmocka_unit_test(test_a_bush_only_shares_the_momentum),
        cmocka_unit_test(test_the_part_that_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
