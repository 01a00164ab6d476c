/* The world on the earth: worked cases with numbers from other programs, the poles, the singular
 * orientation, and round trips of random places and attitudes (SEED=n draws others). */
#include "gateway/earth/local_frame.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Heading, pitch and roll in degrees; the local place is relative to the point of reference. */
struct worked {
    struct vec3 local;
    double heading, pitch, roll;
    struct vec3 ecef;
    struct euler angles;
};

static const struct worked cases[] = {
    {{0, 0, 0},
     0,
     0,
     0,
     {-2681672.715469, -4419259.862861, 3723701.886410},
     {1.025380936, -0.943350461, 3.141592654}},
    {{1234.5, 310.25, -6789},
     57,
     3.5,
     -2.25,
     {-2678679.956124, -4416707.600443, 3729379.924307},
     {-0.233703445, -0.496009095, -2.298946641}},
    {{-21500, 1850, 14250},
     222.5,
     -12,
     35,
     {-2705170.243811, -4416538.666140, 3713252.185446},
     {2.964545654, 0.783644804, 2.870326142}},
    {{5000, 900, -5000},
     350,
     30,
     -60,
     {-2676253.317704, -4419967.093839, 3728277.905663},
     {2.028323929, -1.391457557, 1.186743902}},
    {{0, 1000, 0},
     0,
     35.95,
     0,
     {-2682092.677791, -4419951.939348, 3724288.965438},
     {-2.116211718, -1.570796327, 0}},
};
#define CASES (sizeof cases / sizeof cases[0])

static struct local_frame frame;

static double apart(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static struct mat3 attitude(double heading_deg, double pitch_deg, double roll_deg)
{
    return rotation_matrix(
        rotation_of(heading_deg * RAD_PER_DEG, pitch_deg * RAD_PER_DEG, roll_deg * RAD_PER_DEG));
}

static void test_worked_places(void **state)
{
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, 0.0, 25000.0, 25000.0);
    for (unsigned i = 0; i < CASES; i++) {
        struct vec3 world = vec3_add(cases[i].local, (struct vec3){25000.0, 0.0, 25000.0});
        assert_true(apart(local_frame_ecef(&frame, world), cases[i].ecef) < 1.5e-6);
        assert_true(apart(local_frame_world(&frame, cases[i].ecef), world) < 1.5e-6);
    }
}

static void test_worked_velocities(void **state)
{
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, 0.0, 0.0, 0.0);
    struct vec3 b = rotation_apply(&frame.axes, (struct vec3){8, 0.5, -6});
    struct vec3 c = rotation_apply(&frame.axes, (struct vec3){-90, -30, 95});
    assert_true(apart(b, (struct vec3){8.456679, -1.484819, 5.150717}) < 2e-6);
    assert_true(apart(c, (struct vec3){-93.276484, 19.771309, -94.517685}) < 2e-6);
    assert_true(apart(rotation_back(&frame.axes, b), (struct vec3){8, 0.5, -6}) < 1e-12);
}

static void test_worked_orientations(void **state)
{
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, 0.0, 0.0, 0.0);
    for (unsigned i = 0; i < CASES; i++) {
        const struct worked *worked = &cases[i];
        struct mat3 turn = attitude(worked->heading, worked->pitch, worked->roll);
        struct mat3 matrix = local_frame_ecef_turn(&frame.axes, &turn);
        struct mat3 right = euler_matrix(worked->angles);
        assert_true(euler_angle_between(&matrix, &right) < 2e-9);
        struct mat3 back = local_frame_world_turn(&frame.axes, &matrix);
        assert_true(euler_angle_between(&turn, &back) < 1e-14);
        struct euler angles = euler_of(&matrix);
        struct mat3 again = euler_matrix(angles);
        assert_true(euler_angle_between(&matrix, &again) < 2e-8);
        assert_true(fabs(angles.theta - worked->angles.theta) < 2e-9);
        if (i > 0) /* phi of A is half a turn, of either sign */
            assert_true(fabs(angles.psi - worked->angles.psi) < 2e-9 &&
                        fabs(angles.phi - worked->angles.phi) < 2e-9);
    }
}

static void test_attitudes_in_degrees(void **state)
{
    double heading, pitch, roll;
    (void)state;
    for (unsigned i = 0; i < CASES; i++) {
        struct mat3 turn = attitude(cases[i].heading, cases[i].pitch, cases[i].roll);
        local_frame_angles(&turn, &heading, &pitch, &roll);
        assert_true(fabs(heading * DEG_PER_RAD - cases[i].heading) < 1e-12);
        assert_true(fabs(pitch * DEG_PER_RAD - cases[i].pitch) < 1e-12);
        assert_true(fabs(roll * DEG_PER_RAD - cases[i].roll) < 1e-12);
    }
    struct mat3 up = attitude(30.0, 90.0, 0.0);
    local_frame_angles(&up, &heading, &pitch, &roll);
    assert_true(fabs(heading * DEG_PER_RAD - 30.0) < 1e-12 && roll == 0.0);
    assert_true(fabs(pitch - HALF_PI) < 1e-12);
}

/* A vehicle that another simulator recorded: level on the ground near 21.30 N 157.86 W, towards the
 * west. */
static void test_a_level_vehicle_elsewhere(void **state)
{
    (void)state;
    local_frame_make(&frame, 21.30, -157.86, 0.0, 0.0, 0.0);
    struct mat3 turn = attitude(270.0, 0.0, 0.0);
    struct mat3 matrix = local_frame_ecef_turn(&frame.axes, &turn);
    struct vec3 nose = {matrix.m[0][0], matrix.m[1][0], matrix.m[2][0]};
    double longitude = -157.86 * RAD_PER_DEG;
    assert_true(apart(nose, (struct vec3){maths_sin(longitude), -maths_cos(longitude), 0.0}) <
                1e-12);
}

static void test_the_sea_is_below_the_ellipsoid(void **state)
{
    struct local_frame sea;
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, 0.0, 0.0, 0.0);
    local_frame_make(&sea, LOCAL_FRAME_LATITUDE_DEG, LOCAL_FRAME_LONGITUDE_DEG,
                     LOCAL_FRAME_UNDULATION_M, 0.0, 0.0);
    struct vec3 ecef = local_frame_ecef(&sea, (struct vec3){0.0, 100.0, 0.0});
    assert_true(fabs(local_frame_world(&frame, ecef).y - 66.3) < 1e-6);
}

/* The plane leaves the ellipsoid with the distance: 7.8 m at 10 km, 48.9 m at 25 km. */
static void test_the_plane_rises_above_the_ellipsoid(void **state)
{
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, 0.0, 0.0, 0.0);
    struct vec3 near = local_frame_ecef(&frame, (struct vec3){10000.0, 0.0, 0.0});
    struct vec3 far = local_frame_ecef(&frame, (struct vec3){25000.0, 0.0, 0.0});
    assert_true(fabs(geodesy_place_of(near).height_m - 7.8) < 0.05);
    assert_true(fabs(geodesy_place_of(far).height_m - 48.9) < 0.05);
}

static void test_places_on_the_earth(void **state)
{
    static const struct geodesy_place places[] = {
        {0, 0, 0},   {HALF_PI, 0, 0},    {-HALF_PI, 0, 1000}, {0, HALF_PI, -1000},
        {0, -PI, 5}, {1.5707, 3.0, 1e6}, {-1e-9, 1e-9, 1e5},  {0.6, -2.1, -33.7},
    };
    uint64_t random = fixture_seed(84);
    (void)state;
    for (unsigned i = 0; i < 20000; i++) {
        struct geodesy_place place =
            i < sizeof places / sizeof places[0]
                ? places[i]
                : (struct geodesy_place){fixture_uniform(&random, -HALF_PI, HALF_PI),
                                         fixture_uniform(&random, -PI, PI),
                                         fixture_uniform(&random, -1e6, 1e6)};
        struct vec3 ecef = geodesy_ecef(place);
        struct geodesy_place back = geodesy_place_of(ecef);
        assert_true(apart(geodesy_ecef(back), ecef) < 1e-8);
        assert_true(fabs(back.height_m - place.height_m) < 1e-7);
    }
    struct vec3 equator = geodesy_ecef((struct geodesy_place){0, 0, 0});
    struct vec3 pole = geodesy_ecef((struct geodesy_place){HALF_PI, 0, 0});
    assert_true(equator.x == 6378137.0 && fabs(pole.z - 6356752.314245179) < 1e-8);
    struct geodesy_place centre = geodesy_place_of((struct vec3){0});
    assert_true(isfinite(centre.height_m) && isfinite(centre.latitude_rad));
}

static void test_random_orientations(void **state)
{
    uint64_t random = fixture_seed(3);
    (void)state;
    local_frame_make(&frame, 35.95, -121.25, -33.7, 25000.0, 25000.0);
    for (int i = 0; i < 20000; i++) {
        struct mat3 turn =
            attitude(fixture_uniform(&random, 0, 360), fixture_uniform(&random, -90, 90),
                     fixture_uniform(&random, -180, 180));
        struct mat3 matrix = local_frame_ecef_turn(&frame.axes, &turn);
        struct euler angles = euler_of(&matrix);
        struct mat3 again = euler_matrix(angles);
        /* sqrt of the rounding near the right angle, where phi is set to 0 */
        assert_true(euler_angle_between(&matrix, &again) < 3e-6);
        if (fabs(angles.theta) < 1.57)
            assert_true(euler_angle_between(&matrix, &again) < 1e-12);
        struct mat3 back = local_frame_world_turn(&frame.axes, &matrix);
        assert_true(euler_angle_between(&turn, &back) < 1e-14);
    }
}

/* A world on a ground file: places are those of the file's projection, heights those above the sea,
 * and the axes those of the map at each place. */
static void test_a_projected_world(void **state)
{
    static const struct vec3 places[] = {
        {25000, 300, 25000}, {0, 0, 0}, {50000, 1917, 0}, {49000, -400, 50000}, {12345, 60, 40000}};
    struct projection projection;
    struct local_frame there;
    (void)state;
    local_frame_project(&there, 44.27, -71.3, -27.0, 25000.0);
    projection_make(&projection, 44.27, -71.3, 50000.0);
    for (unsigned i = 0; i < sizeof places / sizeof *places; i++) {
        struct vec3 ecef = local_frame_ecef(&there, places[i]);
        struct geodesy_place place = geodesy_place_of(ecef);
        double x, z;
        assert_true(fabs(place.height_m - (places[i].y - 27.0)) < 1e-6);
        projection_world(&projection, place.latitude_rad * DEG_PER_RAD,
                         place.longitude_rad * DEG_PER_RAD, &x, &z);
        assert_true(fabs(x - places[i].x) < 1e-4 && fabs(z - places[i].z) < 1e-4);
        assert_true(apart(local_frame_world(&there, ecef), places[i]) < 1e-4);
        /* A step on the map is one on the earth along the axes, but for the stretch of the map. */
        struct mat3 axes = local_frame_axes(&there, places[i]);
        for (int n = 0; n < 3; n++) {
            struct vec3 step = {n == 0 ? 10.0 : 0.0, n == 1 ? 10.0 : 0.0, n == 2 ? 10.0 : 0.0};
            struct vec3 moved = vec3_sub(local_frame_ecef(&there, vec3_add(places[i], step)), ecef);
            struct vec3 along = rotation_apply(&axes, step);
            assert_true(apart(moved, along) < 5e-3); /* 300 ppm of height, 8 of the map */
            assert_true(apart(rotation_back(&axes, along), step) < 1e-9);
        }
    }
    /* The plane is 98 m above the sea in the corner: a projected vehicle there is on the ground. */
    struct local_frame plane;
    local_frame_make(&plane, 44.27, -71.3, -27.0, 25000.0, 25000.0);
    double above = geodesy_place_of(local_frame_ecef(&plane, places[1])).height_m -
                   geodesy_place_of(local_frame_ecef(&there, places[1])).height_m;
    assert_true(above > 95.0 && above < 100.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_projected_world),
        cmocka_unit_test(test_worked_places),
        cmocka_unit_test(test_worked_velocities),
        cmocka_unit_test(test_worked_orientations),
        cmocka_unit_test(test_attitudes_in_degrees),
        cmocka_unit_test(test_a_level_vehicle_elsewhere),
        cmocka_unit_test(test_the_sea_is_below_the_ellipsoid),
        cmocka_unit_test(test_the_plane_rises_above_the_ellipsoid),
        cmocka_unit_test(test_places_on_the_earth),
        cmocka_unit_test(test_random_orientations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
