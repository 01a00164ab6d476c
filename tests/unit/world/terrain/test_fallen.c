/* The coding of fixed_damage, and where the debris of fallen objects lies. */
#include "world/terrain/fallen.h"

#include "world/entity/debris.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind tree = {.object_class = OBJECT_TREE, .radius_m = 2.0, .width_m = 6.0};
static const struct kind house = {.object_class = OBJECT_BUILDING, .radius_m = 9.0};

static void test_every_direction_is_kept_to_less_than_a_degree(void **state)
{
    (void)state;
    for (int n = 0; n < 1000; n++) {
        double heading = n * TWO_PI / 1000.0;
        uint8_t stored = fallen_towards(&tree, maths_sin(heading), -maths_cos(heading));
        assert_true(stored >= FALLEN_FIRST && fallen_damage(stored) == DAMAGE_HIGH);
        double off = maths_wrap_half(fallen_heading(stored) - heading);
        assert_true(fabs(off) <= 0.76 * RAD_PER_DEG);
    }
    assert_int_equal(fallen_towards(&house, 1.0, 0.0), DAMAGE_HIGH);
    for (uint8_t damage = 0; damage < DAMAGE_COUNT; damage++)
        assert_int_equal(fallen_damage(damage), damage);
}

static void test_a_trunk_lies_along_its_fall_and_all_else_around_its_place(void **state)
{
    const struct fixed_object object = {
        .x = 100.0, .z = 200.0, .radius_m = 4.0f, .height_m = 10.0f};
    const struct debris_area east = fallen_area(&object, &tree, fallen_towards(&tree, 1.0, 0.0));
    const struct debris_area disc = fallen_area(&object, &tree, DAMAGE_HIGH);
    (void)state;
    assert_true(debris_area_holds(&east, 100.1, 200.0) && debris_area_holds(&east, 112.9, 200.0));
    assert_true(debris_area_holds(&east, 105.0, 202.9) && debris_area_holds(&east, 105.0, 197.1));
    assert_false(debris_area_holds(&east, 113.1, 200.0));
    assert_false(debris_area_holds(&east, 96.9, 200.0));
    assert_false(debris_area_holds(&east, 105.0, 203.1));
    assert_true(debris_area_holds(&disc, 96.1, 200.0) && debris_area_holds(&disc, 100.0, 203.9));
    assert_false(debris_area_holds(&disc, 104.1, 200.0));
}

static void test_pushed_debris_lies_where_it_is(void **state)
{
    const struct debris list[] = {{.object = 4, .x = 10.0, .radius_m = 1.0f},
                                  {.object = 9,
                                   .x = 50.0,
                                   .z = 60.0,
                                   .heading_rad = (float)HALF_PI,
                                   .half_length_m = 5.0f,
                                   .radius_m = 1.0f}};
    const struct debris_area area = debris_area(debris_find(list, 2, 9));
    (void)state;
    assert_true(debris_area_holds(&area, 45.0, 60.0) && debris_area_holds(&area, 55.5, 60.0));
    assert_false(debris_area_holds(&area, 50.0, 61.5));
    const struct vec3 near = debris_area_nearest(&area, 70.0, 70.0);
    assert_true(fabs(near.x - 55.0) < 1e-5 && fabs(near.z - 60.0) < 1e-5);
    assert_null(debris_find(list, 2, 5));
    assert_null(debris_find(list, 0, 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_direction_is_kept_to_less_than_a_degree),
        cmocka_unit_test(test_a_trunk_lies_along_its_fall_and_all_else_around_its_place),
        cmocka_unit_test(test_pushed_debris_lies_where_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
