/* Places as people write them: the three forms, what is refused, and where they lie in a world. */
#include "world/terrain/location.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct error_text error;

static struct location read_good(const char *text)
{
    struct location place;
    if (location_read(&place, text, &error) != 0)
        fail_msg("'%s' was refused: %s", text, error.text);
    return place;
}

static void test_the_three_forms(void **state)
{
    (void)state;
    struct location place = read_good(" 25000 , 24000.5 ");
    assert_true(!place.on_earth && place.x == 25000.0 && place.z == 24000.5);
    place = read_good("44.2705N,71.3033W");
    assert_true(place.on_earth && place.latitude_deg == 44.2705 && place.longitude_deg == -71.3033);
    place = read_good("33.85s, 151.2e");
    assert_true(place.on_earth && place.latitude_deg == -33.85 && place.longitude_deg == 151.2);
    place = read_good("19T CK 16174 04497");
    assert_true(place.on_earth && fabs(place.latitude_deg - 44.2705) < 1e-5 &&
                fabs(place.longitude_deg + 71.3033) < 1e-5);
}

static void test_what_is_no_place_is_refused_with_the_reason(void **state)
{
    static const struct {
        const char *text, *because;
    } wrong[] = {
        {"", "'': not a place; right would be: 25000,24000"},
        {"here", "not a place"},
        {"25000", "not a place"},
        {"25000,", "not a place"},
        {",24000", "not a place"},
        {"1,2,3", "not a place"},
        {"nan,1", "not a latitude"},
        {"1e400,1", "not a place"},
        {"0x10,5", "not a place"},
        {"5,0X1p3", "not a place"},
        {"44.5,-71.5", "degrees need letters, as 44.5N,71.5W"},
        {"-33.85,151.2", "degrees need letters, as 33.85S,151.2E"},
        {"-100,24000", "are not below 0; degrees need letters, as 44.2705N,71.3033W"},
        {"44.27N", "not a place"},
        {"91N,71W", "not a latitude of 0 to 90 degrees with N or S"},
        {"44N,181W", "a longitude of 0 to 180 with E or W"},
        {"-44N,71W", "not a latitude"},
        {"71W,44N", "not a latitude"},
        {"44.27N,71.3", "not a latitude"},
        {"19TXK16174", "its zone has no square of these letters"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct location place;
        assert_int_equal(location_read(&place, wrong[i].text, &error), -1);
        if (!strstr(error.text, wrong[i].because))
            fail_msg("'%s': \"%s\" does not say \"%s\"", wrong[i].text, error.text,
                     wrong[i].because);
    }
}

static void refused(const char *text, const struct location_frame *frame, const char *because)
{
    double x, z;
    const struct location place = read_good(text);
    assert_int_equal(location_world(&place, frame, &x, &z, &error), -1);
    if (!strstr(error.text, because))
        fail_msg("'%s': \"%s\" does not say \"%s\"", text, error.text, because);
}

static void test_a_place_has_coordinates_within_the_square(void **state)
{
    struct location_frame frame;
    double x, z;
    (void)state;
    location_frame_make(&frame, 44.45, -71.45, 50000.0);
    struct location place = read_good("44.45N,71.45W");
    assert_int_equal(location_world(&place, &frame, &x, &z, &error), 0);
    assert_true(fabs(x - 25000.0) < 1e-6 && fabs(z - 25000.0) < 1e-6);
    place = read_good("0,50000");
    assert_int_equal(location_world(&place, &frame, &x, &z, &error), 0);
    assert_true(x == 0.0 && z == 50000.0);
    refused("0,50000.1", &frame, "outside of the world; allowed: 0..50000 m each");
    refused("44.45N,71.13W", &frame,
            "that place is 25 km from the middle of the world, which is at 44.4500N,71.4500W");
    refused("48.1N,11.5E", &frame, "outside of its square of 50 km");
    refused("44.45S,108.55E", &frame, "that place is 20015 km from the middle");
}

static void test_there_and_back_is_the_same_place(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (uint64_t i = 0; i < 5000; i++) {
        double middle = -79.0 + 162.0 * random_unit(random, i, 0, 0), x, z;
        double side_m = 1000.0 + 499000.0 * random_unit(random, i, 1, 0);
        double east = side_m * (0.01 + 0.98 * random_unit(random, i, 2, 0));
        double south = side_m * (0.01 + 0.98 * random_unit(random, i, 3, 0));
        struct location_frame frame;
        struct location_earth earth;
        location_frame_make(&frame, middle, -180.0 + 360.0 * random_unit(random, i, 4, 0), side_m);
        location_earth(&earth, &frame, east, south);
        struct location place = read_good(earth.degrees);
        assert_int_equal(location_world(&place, &frame, &x, &z, &error), 0);
        assert_true(fabs(x - east) < 0.1 && fabs(z - south) < 0.1);
        if (!earth.mgrs[0])
            continue; /* near a pole */
        place = read_good(earth.mgrs);
        assert_int_equal(location_world(&place, &frame, &x, &z, &error), 0);
        assert_true(fabs(x - east) < 0.8 && fabs(z - south) < 0.8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_three_forms),
        cmocka_unit_test(test_what_is_no_place_is_refused_with_the_reason),
        cmocka_unit_test(test_a_place_has_coordinates_within_the_square),
        cmocka_unit_test(test_there_and_back_is_the_same_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
