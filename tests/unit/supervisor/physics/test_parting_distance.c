/* Ways out of cubes by known lengths. */
#include "supervisor/physics/parting_distance.h"

#include "tests/support/fixture.h"
#include "world/entity/hull.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 corners[] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const struct hull cube = {.vertex_count = 8, .radius_m = 1.7320508075688774};
static const struct world world = {.hull_vertices = corners};

static struct hull_shape shape[2];

static int find_cubes(void **state)
{
    (void)state;
    return hull_shape_find(&shape[0], &world, &cube) | hull_shape_find(&shape[1], &world, &cube);
}

static int free_cubes(void **state)
{
    (void)state;
    hull_shape_free(&shape[0]);
    hull_shape_free(&shape[1]);
    return 0;
}

static struct rigid_pose pose_at(double x, double y, double z)
{
    return rigid_pose_of((struct vec3){25000.0 + x, 100.0 + y, 30000.0 + z}, 0.0, 0.0, 0.0);
}

/* Returns the way of a cube of 2 m at the origin out of cubes at two places. */
static double way(struct vec3 first, struct vec3 second)
{
    const struct rigid_pose own = pose_at(0.0, 0.0, 0.0);
    const struct rigid_pose others[2] = {pose_at(first.x, first.y, first.z),
                                         pose_at(second.x, second.y, second.z)};
    const struct parting_pieces a = {shape, &own, 1, 1.0}, b = {shape, others, 2, 1.0};
    return parting_distance_find(&a, &b);
}

static const struct vec3 far = {100.0, 0.0, 0.0};

static void is(double value, double wanted)
{
    if (fabs(value - wanted) > 1e-9)
        fail_msg("%.12g instead of %.12g", value, wanted);
}

static void test_out_of_one_piece_to_the_nearer_side(void **state)
{
    (void)state;
    is(way((struct vec3){1.5, 0.0, 0.2}, far), 0.5);
    is(way((struct vec3){0.2, 0.0, -1.9}, far), 0.1);
    is(way((struct vec3){2.1, 0.0, 0.0}, far), 0.0);
}

static void test_nothing_is_left_upwards(void **state)
{
    (void)state;
    is(way((struct vec3){0.5, 1.9, 0.0}, far), 1.5);
    is(way((struct vec3){0.5, 2.1, 0.0}, far), 0.0);
}

/* The first piece alone would be left to the west, by 0.5 m, into the second. */
static void test_the_way_does_not_lead_into_another_piece(void **state)
{
    (void)state;
    is(way((struct vec3){1.5, 0.0, 0.0}, (struct vec3){-2.2, 0.0, 0.0}), 2.0);
    is(way((struct vec3){1.5, 0.0, 0.0}, (struct vec3){-2.6, 0.0, 0.0}), 0.5);
}

/* The depth in both is the height of the cubes while it is left to the side. */
static void test_the_way_out_of_two_pieces_gets_shorter(void **state)
{
    const struct vec3 wide = {0.0, 0.0, 1.2}, side = {0.0, 0.0, -1.9};
    (void)state;
    double before = way(wide, side);
    double after = way(vec3_sub(wide, (struct vec3){0.3, 0.0, 0.0}),
                       vec3_sub(side, (struct vec3){0.3, 0.0, 0.0}));
    is(before, 2.0);
    is(after, 1.7);
}

/* Along a normal both pieces are left after 2.5 m; the place beside both is nearer. */
static void test_a_corner_between_two_pieces_is_nearer(void **state)
{
    (void)state;
    is(way((struct vec3){1.5, 0.0, -0.5}, (struct vec3){-0.5, 0.0, 1.5}), 0.70710678118654752);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_out_of_one_piece_to_the_nearer_side),
        cmocka_unit_test(test_nothing_is_left_upwards),
        cmocka_unit_test(test_the_way_does_not_lead_into_another_piece),
        cmocka_unit_test(test_the_way_out_of_two_pieces_gets_shorter),
        cmocka_unit_test(test_a_corner_between_two_pieces_is_nearer),
    };
    return cmocka_run_group_tests(tests, find_cubes, free_cubes);
}
