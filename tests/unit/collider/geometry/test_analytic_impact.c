/* Times of impact on cases that can be worked out by hand. The random ones are in
 * tests/property/collider/geometry/test_analytic_impact.c. */
#include "collider/geometry/analytic_impact.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct path path(double x, double y, double z, double along_x, double along_y,
                        double along_z)
{
    return (struct path){.at = {x, y, z}, .along = {along_x, along_y, along_z}};
}

/* The time, or -1 if they do not touch. */
static double spheres(struct path a, struct path b, double reach, double from)
{
    double toi = -2.0;
    return analytic_impact_spheres(&a, &b, reach, from, &toi) ? toi : -1.0;
}

static void test_head_on_touches_when_the_gap_is_closed(void **state)
{
    (void)state;
    /* 10 m apart, radii 6 together, closing 8 m a frame: 4 / 8. */
    assert_true(spheres(path(0, 0, 0, 5, 0, 0), path(10, 0, 0, -3, 0, 0), 6.0, 0.0) == 0.5);
}

static void test_a_contact_at_the_very_end_counts(void **state)
{
    (void)state;
    assert_true(spheres(path(0, 0, 0, 4, 0, 0), path(10, 0, 0, 0, 0, 0), 6.0, 0.0) == 1.0);
    assert_true(spheres(path(0, 0, 0, 3.999, 0, 0), path(10, 0, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
}

static void test_off_centre_touches_later(void **state)
{
    (void)state;
    /* 6-8-10: beside each other by 6 of a reach of 10, they touch 8 before the nearest point. */
    assert_true(fabs(spheres(path(0, 0, 0, 40, 0, 0), path(20, 0, 6, 0, 0, 0), 10.0, 0.0) - 0.3) <
                1e-15);
}

static void test_grazing_counts_and_just_beside_does_not(void **state)
{
    (void)state;
    assert_true(spheres(path(0, 0, 0, 40, 0, 0), path(20, 6, 0, 0, 0, 0), 6.0, 0.0) == 0.5);
    assert_true(spheres(path(0, 0, 0, 40, 0, 0), path(20, 6.000001, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
}

static void test_an_overlap_touches_at_once_only_during_approach(void **state)
{
    (void)state;
    assert_true(spheres(path(0, 0, 0, 1, 0, 0), path(2, 0, 0, 0, 0, 0), 6.0, 0.25) == 0.25);
    assert_true(spheres(path(0, 0, 0, -1, 0, 0), path(2, 0, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
}

static void test_touching_bodies_that_part_do_not_collide(void **state)
{
    (void)state;
    assert_true(spheres(path(0, 0, 0, -1, 0, 0), path(6, 0, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
    assert_true(spheres(path(0, 0, 0, 0, 0, 1), path(6, 0, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
    assert_true(spheres(path(0, 0, 0, 1, 0, 0), path(6, 0, 0, 0, 0, 0), 6.0, 0.0) == 0.0);
}

static void test_no_relative_motion_never_touches(void **state)
{
    (void)state;
    assert_true(spheres(path(0, 0, 0, 7, 8, 9), path(3, 0, 0, 7, 8, 9), 6.0, 0.0) == -1.0);
    assert_true(spheres(path(0, 0, 0, 0, 0, 0), path(3, 0, 0, 0, 0, 0), 6.0, 0.0) == -1.0);
}

static void test_since_shifts_a_path_in_time(void **state)
{
    (void)state;
    /* The second stands at 10 until 0.5 and then comes on at 8 a frame: touches at 1. */
    struct path late = path(10, 0, 0, -8, 0, 0);
    late.since = 0.5;
    assert_true(spheres(path(0, 0, 0, 0, 0, 0), late, 6.0, 0.5) == 1.0);
}

/* --- the ground --------------------------------------------------------------------------------*/

static int open_world(void **state)
{
    static struct fixture fixture;
    fixture_open(&fixture, "");
    *state = &fixture;
    return 0;
}

static double ground(const struct fixture *fixture, struct path from)
{
    double toi = -2.0;
    return analytic_impact_ground(&fixture->view.world.terrain, &fixture->stepper.mover.craters,
                                  &from, &toi)
               ? toi
               : -1.0;
}

static void test_straight_down_reaches_level_ground(void **state)
{
    assert_true(fabs(ground(*state, path(25010, 180, 25020, 0, -100, 0)) - 0.8) < 1e-15);
    assert_true(ground(*state, path(25010, 180, 25020, 0, -79.9, 0)) == -1.0);
}

static void test_a_slope_is_met_where_it_is(void **state)
{
    struct fixture *f = *state;
    steps_plane(f, 0.25, 0.0);
    /* Level flight 25 m up over the plane's 100 m line, 400 m a frame: 100 m on, at a quarter. */
    assert_true(fabs(ground(f, path(25000, 125, 25033, 400, 0, 0)) - 0.25) < 1e-12);
    assert_true(ground(f, path(25000, 125, 25033, -400, 0, 0)) == -1.0);
    steps_plane(f, 0.0, 0.0);
}

static void test_below_the_ground_is_at_once(void **state)
{
    struct path path_below = path(25000, 99.5, 25000, 50, 0, 0);
    path_below.since = 0.375;
    assert_true(ground(*state, path_below) == 0.375);
    assert_true(ground(*state, path(25000, 100.0, 25000, 50, 0, 0)) == -1.0); /* on it is not */
}

static void test_beyond_the_world_the_edge_goes_on(void **state)
{
    assert_true(fabs(ground(*state, path(-500, 110, -700, -50, -20, 3)) - 0.5) < 1e-15);
    assert_true(fabs(ground(*state, path(50900, 110, 60000, 50, -20, 3)) - 0.5) < 1e-15);
}

static void test_one_ridge_between_two_valleys_is_found(void **state)
{
    struct fixture *f = *state;
    float *posts = (float *)(uintptr_t)f->view.world.terrain.posts;
    uint32_t side = f->view.world.terrain.side;
    posts[200 * side + 200] = 160.0f; /* one post: a pyramid of 125 m around (25000, 25000) */
    /* 300 m a frame: both ends are clear of it, and so is the middle of neither side. */
    assert_true(ground(f, path(24850, 150, 25000, 300, 0, 0)) > 0.0);
    assert_true(ground(f, path(24850, 161, 25000, 300, 0, 0)) == -1.0);
    posts[200 * side + 200] = 100.0f;
}

static void test_a_crater_lets_a_path_go_deeper(void **state)
{
    struct fixture *f = *state;
    struct crater *list = f->view.w[0].craters;
    list[0] = (struct crater){25050.0, 25060.0, 4.0f, 2.0f, 1};
    crater_index_update(&f->stepper.mover.craters, 1);
    assert_true(fabs(ground(f, path(25050, 105, 25060, 0, -10, 0)) - 0.7) < 1e-6);
    assert_true(fabs(ground(f, path(25060, 105, 25060, 0, -10, 0)) - 0.5) < 1e-6);
    crater_index_update(&f->stepper.mover.craters, 0);
}

int main(void)
{
    const struct CMUnitTest sphere_tests[] = {
        cmocka_unit_test(test_head_on_touches_when_the_gap_is_closed),
        cmocka_unit_test(test_a_contact_at_the_very_end_counts),
        cmocka_unit_test(test_off_centre_touches_later),
        cmocka_unit_test(test_grazing_counts_and_just_beside_does_not),
        cmocka_unit_test(test_an_overlap_touches_at_once_only_during_approach),
        cmocka_unit_test(test_touching_bodies_that_part_do_not_collide),
        cmocka_unit_test(test_no_relative_motion_never_touches),
        cmocka_unit_test(test_since_shifts_a_path_in_time),
    };
    const struct CMUnitTest ground_tests[] = {
        cmocka_unit_test(test_straight_down_reaches_level_ground),
        cmocka_unit_test(test_a_slope_is_met_where_it_is),
        cmocka_unit_test(test_below_the_ground_is_at_once),
        cmocka_unit_test(test_beyond_the_world_the_edge_goes_on),
        cmocka_unit_test(test_one_ridge_between_two_valleys_is_found),
        cmocka_unit_test(test_a_crater_lets_a_path_go_deeper),
    };
    int failed = cmocka_run_group_tests(sphere_tests, NULL, NULL);
    return failed + cmocka_run_group_tests(ground_tests, open_world, fixture_teardown);
}
