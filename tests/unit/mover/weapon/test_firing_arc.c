/* Arcs: the published figures of the M107 shell, high and low, and points that are met in wind. */
#include "mover/weapon/firing_arc.h"

#include "mover/motion/projectile.h"
#include "world/entity/kind.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static const struct vec3 calm = {0.0, 0.0, 0.0};

/* 43.1 kg, 155 mm, form factor 1, 564 m/s. */
static const struct kind m107 = {.max_speed_mps = 564.0,
                                 .drag = DRAG_G7,
                                 .ballistic_kgpm2 = 43.1 / (0.155 * 0.155),
                                 .delivery = DELIVERY_ARC};
static struct firing_arc arc;

static int make(void **state)
{
    (void)state;
    firing_arc_make(&arc, &m107);
    return 0;
}

static void expect(const char *what, double real, double ours, double tolerance)
{
    print_message("%-34s %10.4g %10.4g   %.3g\n", what, real, ours, tolerance);
    if (!(fabs(ours - real) <= tolerance))
        fail_msg("%s: %g instead of %g", what, ours, real);
}

static struct firing_arc_solution solve(double range_m, double height_m, bool high,
                                        struct vec3 wind)
{
    struct firing_arc_solution solution;
    const struct firing_arc_aim aim = {.muzzle = {10000.0, 0.0, 30000.0},
                                       .point = {10000.0 + range_m, height_m, 30000.0},
                                       .wind = wind,
                                       .high = high};
    assert_true(firing_arc_solve(&arc, &aim, &solution));
    return solution;
}

static void test_the_m107_flies_as_published(void **state)
{
    struct firing_arc_solution low = solve(10000.0, 0.0, false, calm);
    struct firing_arc_solution high = solve(10000.0, 0.0, true, calm);
    (void)state;
    print_message("%-34s %10s %10s   tolerance\n", "M107, 564 m/s", "real", "ours");
    expect("greatest range [m]", 14600.0, arc.range_m[arc.furthest], 292.0);
    expect("to 10 km, low: elevation [deg]", 18.5, low.elevation_rad * DEG_PER_RAD, 0.37);
    expect("  time of flight [s]", 28.9, low.flight_s, 0.58);
    expect("  falls with [m/s]", 301.0, vec3_length(low.fall), 6.0);
    expect("  at [deg]", 27.0, atan2(-low.fall.y, low.fall.x) * DEG_PER_RAD, 0.6);
    expect("to 10 km, high: elevation [deg]", 69.5, high.elevation_rad * DEG_PER_RAD, 1.4);
    expect("  time of flight [s]", 79.0, high.flight_s, 1.6);
}

/* Flies a solution in frames and returns how near it passes the point. */
static double miss_m(const struct firing_arc_aim *aim, double hz)
{
    struct firing_arc_solution solution;
    if (!firing_arc_solve(&arc, aim, &solution))
        fail_msg("no solution to %g, %g, %g, %s", aim->point.x - aim->muzzle.x,
                 aim->point.y - aim->muzzle.y, aim->point.z - aim->muzzle.z,
                 aim->high ? "high" : "low");
    struct vec3 at = aim->muzzle, before = at;
    struct vec3 velocity = vec3_scale(firing_arc_unit(solution.azimuth_rad, solution.elevation_rad),
                                      m107.max_speed_mps);
    double least = INFINITY;
    while (velocity.y >= 0.0 || at.y > aim->point.y - 50.0) {
        before = at;
        projectile_fall(&m107, aim->wind, 1.0 / hz, &at, &velocity);
        struct vec3 way = vec3_sub(at, before), to = vec3_sub(aim->point, before);
        double share = maths_clamp(vec3_dot(to, way) / vec3_dot(way, way), 0.0, 1.0);
        least = maths_min(least, vec3_length(vec3_sub(to, vec3_scale(way, share))));
    }
    return least;
}

static void test_shells_meet_their_points_in_wind_and_on_hills(void **state)
{
    double worst = 0.0;
    (void)state;
    for (double range = 2000.0; range <= 13500.0; range += 500.0) {
        for (int n = 0; n < 12; n++) {
            double heading = range + 0.5 * n;
            const struct firing_arc_aim aim = {.muzzle = {25000.0, 100.0, 25000.0},
                                               .point = {25000.0 + range * maths_sin(heading),
                                                         n % 3 * 200.0 - 100.0,
                                                         25000.0 - range * maths_cos(heading)},
                                               .wind = {n % 4 * 5.0, 0.0, -4.0 * (n % 3)},
                                               .high = n % 2 == 1};
            if (range < 5000.0 && aim.high)
                continue; /* above 80 degrees */
            worst = maths_max(worst, miss_m(&aim, 60.0));
        }
    }
    print_message("worst miss: %.2f m\n", worst);
    assert_true(worst < 5.0);
}

static void test_a_point_out_of_range_has_no_solution(void **state)
{
    struct firing_arc_solution solution;
    const struct firing_arc_aim aim = {.point = {15000.0, 0.0, 0.0}};
    (void)state;
    assert_false(firing_arc_solve(&arc, &aim, &solution));
}

static void test_the_table_is_near_the_solution(void **state)
{
    double worst = 0.0;
    (void)state;
    for (double range = 500.0; range < 14000.0; range += 250.0) {
        struct firing_arc_solution solution = solve(range, 50.0, false, calm);
        struct vec3 exact = firing_arc_unit(solution.azimuth_rad, solution.elevation_rad);
        struct vec3 about = firing_arc_direction(&arc, (struct vec3){10000.0, 0.0, 30000.0},
                                                 (struct vec3){10000.0 + range, 50.0, 30000.0});
        double off = vec3_length(vec3_sub(exact, about));
        worst = maths_max(worst, off);
    }
    print_message("the table is within %.4f rad of the solution\n", worst);
    assert_true(worst < 0.01);
    print_message("the table is within %.4f rad of the solution\n", worst);
    assert_true(worst < 0.01);
}

/* A wind of 10 m/s from the left carries a shell that does not allow for it to the right. */
static void test_wind_carries_a_shell_along(void **state)
{
    struct firing_arc_solution low = solve(10000.0, 0.0, false, calm);
    struct vec3 at = {0.0, 0.0, 0.0}, wind = {0.0, 0.0, 10.0};
    struct vec3 velocity = vec3_scale(firing_arc_unit(low.azimuth_rad, low.elevation_rad), 564.0);
    (void)state;
    firing_arc_fall(&m107, wind, 0.0, &at, &velocity);
    print_message("drift by 10 m/s across, to 10 km: %.0f m\n", at.z);
    assert_true(at.z > 60.0 && at.z < 200.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_m107_flies_as_published),
        cmocka_unit_test(test_shells_meet_their_points_in_wind_and_on_hills),
        cmocka_unit_test(test_a_point_out_of_range_has_no_solution),
        cmocka_unit_test(test_the_table_is_near_the_solution),
        cmocka_unit_test(test_wind_carries_a_shell_along),
    };
    return cmocka_run_group_tests(tests, make, NULL);
}
