/* Maths against the C library in long double, and that its bits are the same everywhere. */
#include "world/maths/maths.h"

#include "tests/support/fixture.h"
#include "world/maths/simd.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <xxhash.h>

#include <cmocka.h>

#define POINTS 100000

static double sine_error(double angle)
{
    double sine, cosine;
    maths_sincos(angle, &sine, &cosine);
    long double by_sine = fabsl((long double)sine - sinl((long double)angle));
    long double by_cosine = fabsl((long double)cosine - cosl((long double)angle));
    return (double)fmaxl(by_sine, by_cosine);
}

static void test_sine_and_cosine_within_2e_16_near_zero(void **state)
{
    (void)state;
    for (int i = -POINTS; i <= POINTS; i++)
        assert_true(sine_error(i * (PI / 4.0 / POINTS)) < 2e-16);
}

static void test_sine_and_cosine_within_1e_10_up_to_a_million(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        assert_true(sine_error(fixture_uniform(&random, -1e6, 1e6)) < 1e-10);
        assert_true(sine_error(fixture_uniform(&random, -100.0, 100.0)) < 1e-14);
    }
    assert_true(sine_error(1e6) < 1e-10);
    assert_true(sine_error(-1e6) < 1e-10);
}

static void test_sine_and_cosine_at_quarter_turns(void **state)
{
    static const double sines[] = {0.0, 1.0, 0.0, -1.0};
    (void)state;
    for (int i = -8; i <= 8; i++) {
        double angle = i * HALF_PI;
        assert_true(fabs(maths_sin(angle) - sines[i & 3]) < 1e-15);
        assert_true(fabs(maths_cos(angle) - sines[(i + 1) & 3]) < 2e-15);
    }
    assert_true(maths_sin(0.0) == 0.0);
    assert_true(maths_cos(0.0) == 1.0);
}

static void test_sine_is_odd_and_cosine_even(void **state)
{
    uint64_t random = fixture_seed(2);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double angle = fixture_uniform(&random, 0.0, 1000.0);
        assert_true(fabs(maths_sin(-angle) + maths_sin(angle)) < 1e-13);
        assert_true(fabs(maths_cos(-angle) - maths_cos(angle)) < 1e-13);
    }
}

static double atan2_error(double y, double x)
{
    return (double)fabsl((long double)maths_atan2(y, x) - atan2l((long double)y, (long double)x));
}

static void test_arc_tangent_within_its_error_all_round(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double turn = fixture_uniform(&random, -PI, PI);
        double length = exp(fixture_uniform(&random, -200.0, 200.0));
        assert_true(atan2_error(length * sin(turn), length * cos(turn)) < 5e-16);
        /* near the axes and the diagonals, where the octants meet */
        double slight = exp(fixture_uniform(&random, -40.0, 0.0));
        assert_true(atan2_error(slight, 1.0) < 5e-16);
        assert_true(atan2_error(-1.0, slight) < 5e-16);
        assert_true(atan2_error(1.0 + slight, -1.0) < 5e-16);
        assert_true(atan2_error(-1.0 - slight, -1.0) < 5e-16);
    }
}

static void test_arc_tangent_at_axes_and_origin(void **state)
{
    (void)state;
    assert_true(maths_atan2(0.0, 0.0) == 0.0);
    assert_true(maths_atan2(0.0, 1.0) == 0.0);
    assert_true(maths_atan2(1.0, 0.0) == HALF_PI);
    assert_true(maths_atan2(-1.0, 0.0) == -HALF_PI);
    assert_true(maths_atan2(0.0, -1.0) == PI);
    assert_true(maths_atan2(DBL_MIN, DBL_MAX) == 0.0);
    assert_true(maths_atan2(DBL_MAX, DBL_MIN) == HALF_PI);
}

static void test_cube_root_within_1e_15(void **state)
{
    uint64_t random = fixture_seed(4);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double value = exp(fixture_uniform(&random, -700.0, 700.0));
        long double right = cbrtl((long double)value);
        assert_true(fabsl((long double)maths_cbrt(value) - right) < 1e-15L * right);
    }
    assert_true(fabs(maths_cbrt(27.0) - 3.0) < 3e-15);
    assert_true(fabs(maths_cbrt(1e-9) - 1e-3) < 1e-18);
    assert_true(maths_cbrt(0.0) == 0.0);
    assert_true(maths_cbrt(-1.0) == 0.0);
}

static void test_wrapping_stays_in_its_range_for_any_angle(void **state)
{
    const double angles[] = {0.0,
                             -0.0,
                             1e-300,
                             -1e-300,
                             -1e-20,
                             -DBL_MIN,
                             PI,
                             -PI,
                             TWO_PI,
                             -TWO_PI,
                             3 * PI,
                             -3 * PI,
                             1e6,
                             -1e6,
                             1e15,
                             -1e15,
                             1e22,
                             -1e22,
                             1e300,
                             -1e300,
                             DBL_MAX,
                             -DBL_MAX,
                             nextafter(TWO_PI, 0.0),
                             nextafter(TWO_PI, 10.0),
                             nextafter(PI, 0.0),
                             nextafter(PI, 10.0),
                             nextafter(-PI, 0.0),
                             nextafter(-PI, -10.0),
                             nextafter(0.0, -1.0)};
    uint64_t random = fixture_seed(5);
    (void)state;
    for (size_t i = 0; i < sizeof angles / sizeof angles[0] + POINTS; i++) {
        double angle =
            i < sizeof angles / sizeof angles[0] ? angles[i] : fixture_uniform(&random, -1e9, 1e9);
        double turn = maths_wrap_turn(angle);
        double half = maths_wrap_half(angle);
        assert_true(turn >= 0.0 && turn < TWO_PI);
        assert_true(half >= -PI && half < PI);
    }
}

static void test_wrapped_angle_is_the_same_angle(void **state)
{
    uint64_t random = fixture_seed(6);
    (void)state;
    for (int i = 0; i < POINTS; i++) {
        double angle = fixture_uniform(&random, -1e4, 1e4);
        double turn = maths_wrap_turn(angle), half = maths_wrap_half(angle);
        assert_true(fabs(maths_sin(turn) - maths_sin(angle)) < 1e-11);
        assert_true(fabs(maths_cos(half) - maths_cos(angle)) < 1e-11);
        assert_true(maths_wrap_turn(turn) == turn); /* what is wrapped stays */
        assert_true(maths_wrap_half(half) == half || half < 0.0);
    }
    assert_true(maths_wrap_half(PI) == -PI);
    assert_true(maths_wrap_turn(-HALF_PI) == TWO_PI - HALF_PI);
}

static void test_headings_are_clockwise_from_north(void **state)
{
    (void)state;
    assert_true(maths_heading(0.0, -1.0) == 0.0);                   /* north */
    assert_true(fabs(maths_heading(1.0, 0.0) - HALF_PI) < 1e-15);   /* east */
    assert_true(fabs(maths_heading(0.0, 1.0) - PI) < 1e-15);        /* south */
    assert_true(fabs(maths_heading(-1.0, 0.0) - 1.5 * PI) < 1e-15); /* west */
    for (int i = 0; i < 360; i++) {
        double heading = i * RAD_PER_DEG;
        double back = maths_heading(maths_sin(heading), -maths_cos(heading));
        assert_true(fabs(maths_wrap_half(back - heading)) < 1e-14);
    }
}

static void test_clamp_and_vectors(void **state)
{
    const struct vec3 a = {1.0, 2.0, 3.0}, b = {5.0, -2.0, 7.0};
    (void)state;
    assert_true(maths_clamp(-1.0, 0.0, 2.0) == 0.0);
    assert_true(maths_clamp(1.0, 0.0, 2.0) == 1.0);
    assert_true(maths_clamp(3.0, 0.0, 2.0) == 2.0);
    assert_true(maths_min(1.0, 2.0) == 1.0 && maths_max(1.0, 2.0) == 2.0);
    assert_true(vec3_dot(a, b) == 22.0);
    assert_true(vec3_length((struct vec3){2.0, 3.0, 6.0}) == 7.0);
    assert_true(vec3_limited(a, 4.0).y == 2.0);
    assert_true(fabs(vec3_length(vec3_limited((struct vec3){2e300, 0.0, 0.0}, 4.0))) == 0.0);
    assert_true(vec3_limited((struct vec3){NAN, 0.0, 1.0}, 4.0).z == 0.0);
    assert_true(vec3_limited((struct vec3){0.0, 0.0, -64.0}, 4.0).z == -4.0);
    struct vec3 middle = vec3_lerp(a, b, 0.5);
    assert_true(middle.x == 3.0 && middle.y == 0.0 && middle.z == 5.0);
    struct vec3 start = vec3_lerp(a, b, 0.0);
    assert_true(start.x == a.x && start.y == a.y && start.z == a.z);
}

/* Digests of runs must be equal on every machine: these bits were made by gcc 12 on x86-64 without
 * vector flags, and every compiler, flag and processor must make the same. */
static void test_bits_are_the_same_everywhere(void **state)
{
    uint64_t hash = 0;
    (void)state;
    for (int i = -20000; i <= 20000; i++) {
        double v[6];
        double angle = i * 0.037;
        maths_sincos(angle, &v[0], &v[1]);
        v[2] = maths_atan2(v[0], v[1] * 0.7);
        v[3] = maths_cbrt((i + 20001) * 0.731);
        v[4] = maths_wrap_turn(angle);
        v[5] = maths_wrap_half(angle);
        hash = XXH3_64bits_withSeed(v, sizeof v, hash);
    }
    assert_int_equal(hash, 0x53c226a114a7d65f);
}

/* Eight at once are eight times one, to the bit. */
static void test_lanes_are_sines_and_cosines(void **state)
{
    uint64_t random = fixture_seed(9);
    (void)state;
    for (int i = 0; i < 50000; i++) {
        union simd_lanes angle, sine, cosine;
        double most = i % 3 ? TWO_PI : 1e6;
        for (int l = 0; l < LANE_COUNT; l++)
            angle.lane[l] = fixture_uniform(&random, i % 2 ? -most : 0.0, most);
        if (i % 5 == 0)
            angle.lane[i % LANE_COUNT] = HALF_PI * (i % 9);
        maths_sincos_lanes(&angle, &sine, &cosine);
        for (int l = 0; l < LANE_COUNT; l++) {
            double s, c;
            maths_sincos(angle.lane[l], &s, &c);
            assert_true(sine.lane[l] == s && cosine.lane[l] == c);
        }
    }
}

static void test_lanes_of_slopes_are_arc_tangents(void **state)
{
    const double most[] = {1e-300, 1e-6, 0.3, 0.9, 30.0};
    uint64_t random = fixture_seed(10);
    (void)state;
    for (int i = 0; i < 50000; i++) {
        union simd_lanes rise, run, angle;
        for (int l = 0; l < LANE_COUNT; l++) {
            double steep = most[(i + (i % 7 == 0) * l) % 5];
            run.lane[l] = fixture_uniform(&random, 0.5, 20.0);
            rise.lane[l] = run.lane[l] * fixture_uniform(&random, -steep, steep);
        }
        if (i % 11 == 0)
            rise.lane[i % LANE_COUNT] = 0.0;
        maths_slopes_lanes(&rise, &run, &angle);
        for (int l = 0; l < LANE_COUNT; l++)
            assert_true(angle.lane[l] == maths_atan2(rise.lane[l], run.lane[l]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lanes_are_sines_and_cosines),
        cmocka_unit_test(test_lanes_of_slopes_are_arc_tangents),
        cmocka_unit_test(test_sine_and_cosine_within_2e_16_near_zero),
        cmocka_unit_test(test_sine_and_cosine_within_1e_10_up_to_a_million),
        cmocka_unit_test(test_sine_and_cosine_at_quarter_turns),
        cmocka_unit_test(test_sine_is_odd_and_cosine_even),
        cmocka_unit_test(test_arc_tangent_within_its_error_all_round),
        cmocka_unit_test(test_arc_tangent_at_axes_and_origin),
        cmocka_unit_test(test_cube_root_within_1e_15),
        cmocka_unit_test(test_wrapping_stays_in_its_range_for_any_angle),
        cmocka_unit_test(test_wrapped_angle_is_the_same_angle),
        cmocka_unit_test(test_headings_are_clockwise_from_north),
        cmocka_unit_test(test_clamp_and_vectors),
        cmocka_unit_test(test_bits_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
