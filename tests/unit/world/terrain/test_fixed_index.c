/* The reach of squares against looking at every object for every square (rows 3, 37). */
#include "world/terrain/fixed_index.h"

#include "tests/support/fixture.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define OBJECTS 3000

enum { BARE, OAK };

/* The oak's crown reaches out of its sphere; nothing of the bare one does. */
static const struct kind kinds[] = {
    [BARE] = {.radius_m = 2.0, .level_m = 1.0}, [OAK] = {.radius_m = 2.0, .level_m = 5.0}};

static uint32_t *start, *items;

static void build(const struct fixed_object *objects, uint32_t count)
{
    assert_int_equal(fixed_index_build(&GRIDSQUARES_DEFAULT, objects, count, kinds, &start, &items),
                     0);
}

static void release(void)
{
    free(start);
    free(items);
}

static bool holds(uint32_t square, uint32_t object)
{
    for (uint32_t i = start[square]; i < start[square + 1]; i++) {
        if (items[i] == object)
            return true;
    }
    return false;
}

static void test_object_within_a_square_is_in_that_square_alone(void **state)
{
    const struct fixed_object tree = {.x = 1062.0, .z = 2062.0, .radius_m = 5.0f};
    (void)state;
    build(&tree, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 1);
    assert_true(holds(16 * 400 + 8, 0));
    release();
}

/* row 37: an object near a border is found from both sides, at a corner from all four squares */
static void test_object_at_a_corner_is_in_all_four_squares(void **state)
{
    const struct fixed_object tower = {.x = 1250.0, .z = 2500.0, .radius_m = 3.0f};
    (void)state;
    build(&tower, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 4);
    assert_true(holds(19 * 400 + 9, 0) && holds(19 * 400 + 10, 0));
    assert_true(holds(20 * 400 + 9, 0) && holds(20 * 400 + 10, 0));
    release();
}

/* rows 37, 38: a crown that hangs over a border is found from beyond it, as large as its tree is */
static void test_object_is_found_as_far_as_its_hulls_reach(void **state)
{
    struct fixed_object tree = {.x = 1254.5, .z = 2562.0, .radius_m = 2.0f, .kind = BARE};
    (void)state;
    build(&tree, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 1);
    release();
    tree.kind = OAK; /* 5 m: half a metre over the border */
    build(&tree, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 2);
    assert_true(holds(20 * 400 + 9, 0) && holds(20 * 400 + 10, 0));
    release();
    tree.radius_m = 1.6f; /* a young one: 4 m */
    build(&tree, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 1);
    release();
}

/* rows 3, 37: each square's list is every object whose box overlaps it, in ascending order */
static void test_every_square_has_the_objects_that_overlap_it(void **state)
{
    static struct fixed_object objects[OBJECTS];
    uint64_t random = fixture_seed(1);
    (void)state;
    for (int i = 0; i < OBJECTS; i++)
        objects[i] = (struct fixed_object){.x = fixture_uniform(&random, 0.0, 2500.0),
                                           .z = fixture_uniform(&random, 0.0, 2500.0),
                                           .radius_m = (float)fixture_uniform(&random, 0.1, 80.0),
                                           .kind = (uint16_t)(fixture_random(&random) % 2)};
    build(objects, OBJECTS);
    uint32_t expected = 0;
    for (uint32_t row = 0; row < 24; row++) {
        for (uint32_t column = 0; column < 24; column++) {
            uint32_t square = row * 400 + column, at = start[square];
            double x0 = column * 125.0, z0 = row * 125.0;
            for (uint32_t i = 0; i < OBJECTS; i++) {
                double r = (double)objects[i].radius_m * (objects[i].kind == OAK ? 2.5 : 1.0);
                if (objects[i].x + r < x0 || objects[i].x - r >= x0 + 125.0 ||
                    objects[i].z + r < z0 || objects[i].z - r >= z0 + 125.0)
                    continue;
                assert_true(at < start[square + 1]);
                assert_int_equal(items[at++], i);
                expected++;
            }
            assert_int_equal(at, start[square + 1]);
        }
    }
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], expected);
    release();
}

static void test_no_objects_no_reach(void **state)
{
    (void)state;
    build(NULL, 0);
    for (uint32_t i = 0; i <= GRIDSQUARES_DEFAULT.count; i++)
        assert_int_equal(start[i], 0);
    release();
}

static void test_objects_on_the_worlds_edge_stay_in_it(void **state)
{
    const struct fixed_object corner = {
        .x = WORLD_SIDE_DEFAULT_M, .z = WORLD_SIDE_DEFAULT_M, .radius_m = 4.0f};
    (void)state;
    build(&corner, 1);
    assert_int_equal(start[GRIDSQUARES_DEFAULT.count], 1);
    assert_true(holds(GRIDSQUARES_DEFAULT.count - 1, 0));
    release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_object_within_a_square_is_in_that_square_alone),
        cmocka_unit_test(test_object_at_a_corner_is_in_all_four_squares),
        cmocka_unit_test(test_object_is_found_as_far_as_its_hulls_reach),
        cmocka_unit_test(test_every_square_has_the_objects_that_overlap_it),
        cmocka_unit_test(test_no_objects_no_reach),
        cmocka_unit_test(test_objects_on_the_worlds_edge_stay_in_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
