/* The projection of ground files, against places that PROJ computed, and there and back again. */
#include "world/terrain/projection.h"

#include "tests/support/fixture.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define SIDE_M 500000.0

/* From PROJ 9.1.1: gdaltransform -output_xy -s_srs "+proj=tmerc +lat_0=44.5 +lon_0=-71.5 +k=1
 * +datum=WGS84 +units=m" -t_srs EPSG:4326. */
static const struct known {
    double middle_latitude, middle_longitude, east_m, north_m, latitude, longitude;
} known[] = {
    {44.5, -71.5, 0, 0, 44.5, -71.5},
    {44.5, -71.5, 50000, 50000, 44.9481806445475, -70.866430009626},
    {44.5, -71.5, -250000, -250000, 42.2098092159542, -74.5272997969259},
    {44.5, -71.5, 250000, 250000, 46.7026164688226, -68.2309381838934},
    {44.5, -71.5, 12345.678, -200000, 42.6997928078452, -71.3493268721871},
    {0, 0, 50000, 50000, 0.452170656346523, 0.449166904674585},
    {0, 0, -250000, -250000, -2.25916367264099, -2.24694518136839},
    {-77.85, 166.67, -250000, -250000, -79.8419794083142, 153.877956334392},
    {-77.85, 166.67, 250000, 250000, -75.4410845729558, 175.607615934538},
    {83.9, -179.9, 50000, 50000, 84.3300556886699, -175.364216599324},
    {83.9, -179.9, -250000, -250000, 81.3683218418067, 165.019357032543},
    {83.9, -179.9, 250000, 250000, 85.5377433724839, -149.776848184743},
};

static void test_places_are_those_of_proj(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const struct known *k = &known[i];
        struct projection projection;
        double x, z, latitude, longitude;
        projection_make(&projection, k->middle_latitude, k->middle_longitude, SIDE_M);
        projection_world(&projection, k->latitude, k->longitude, &x, &z);
        assert_true(fabs(x - 0.5 * SIDE_M - k->east_m) < 1e-6);
        assert_true(fabs(0.5 * SIDE_M - z - k->north_m) < 1e-6);
        projection_place(&projection, x, z, &latitude, &longitude);
        assert_true(fabs(latitude - k->latitude) < 1e-11);
        assert_true(fabs(longitude - k->longitude) < 1e-11);
    }
}

static void test_there_and_back_is_the_same_place(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        struct projection projection;
        double x2, z2, latitude, longitude;
        double middle =
            (2.0 * random_unit(random, i, 0, RANDOM_NOISE) - 1.0) * PROJECTION_LATITUDE_MAX_DEG;
        double x = SIDE_M * random_unit(random, i, 1, RANDOM_NOISE);
        double z = SIDE_M * random_unit(random, i, 2, RANDOM_NOISE);
        projection_make(&projection, middle,
                        360.0 * random_unit(random, i, 3, RANDOM_NOISE) - 180.0, SIDE_M);
        projection_place(&projection, x, z, &latitude, &longitude);
        projection_world(&projection, latitude, longitude, &x2, &z2);
        if (fabs(x2 - x) > 1e-6 || fabs(z2 - z) > 1e-6 || fabs(longitude) > 180.0)
            fail_msg("middle %g: (%.9g, %.9g) became (%.9g, %.9g)", middle, x, z, x2, z2);
    }
}

/* The stretch is the ratio of a short way on the map to the same way along the ellipsoid's
 * parallel. */
static void test_stretch_grows_with_the_square_of_the_distance(void **state)
{
    struct projection projection;
    double x[2], z;
    (void)state;
    projection_make(&projection, 0.0, 0.0, SIDE_M);
    for (double degrees = 0.1; degrees < 2.2; degrees += 0.3) {
        projection_world(&projection, 0.0, degrees, &x[0], &z);
        projection_world(&projection, 0.0, degrees + 1e-4, &x[1], &z);
        double ground_m = 1e-4 * RAD_PER_DEG * 6378137.0;
        double stretch = (x[1] - x[0]) / ground_m - 1.0;
        assert_true(fabs(projection_stretch(x[0] - 0.5 * SIDE_M) - stretch) <
                    0.01 * stretch + 2e-9);
    }
    assert_true(fabs(projection_stretch(25000.0) - 7.7e-6) < 0.05e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places_are_those_of_proj),
        cmocka_unit_test(test_there_and_back_is_the_same_place),
        cmocka_unit_test(test_stretch_grows_with_the_square_of_the_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
