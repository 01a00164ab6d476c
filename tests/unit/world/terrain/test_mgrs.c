/* References of the Military Grid Reference System, against those of GeographicLib, and there and
 * back again. */
#include "world/terrain/mgrs.h"

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

#define DEGREE_M 111320.0

static struct error_text error;

/* From GeographicLib 2.1.2: GeoConvert -m -p 0. Off Norway and Svalbard zones are wider. */
static const struct known {
    double latitude, longitude;
    const char *reference;
} known[] = {
    {44.2705, -71.3033, "19TCK1617404497"}, {21.3, -157.9, "04QFJ1409655747"},
    {0.0, 0.0, "31NAA6602100000"},          {-1e-06, -1e-06, "30MZE3397899999"},
    {60.0, 5.0, "32VKM7697958157"},         {59.5, 2.9, "31VDF9433895733"},
    {75.0, 10.0, "33XUD5570629692"},        {78.2, 15.6, "33XWG1369680760"},
    {80.5, 8.99999, "31XFK1036343099"},     {-80.0, -180.0, "01CDM4186716915"},
    {51.5, -0.1, "30UYC0127709417"},        {-33.85, 151.2, "56HLH3347153018"},
    {35.95, -121.25, "10SFE5783079818"},    {83.9999, -179.99999, "01XDP6500428994"},
    {-54.8, -68.3, "19FEV4500027239"},
};

static void test_references_are_those_of_geographiclib(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        char text[MGRS_TEXT_MAX];
        double latitude, longitude;
        assert_true(mgrs_write(text, known[i].latitude, known[i].longitude));
        assert_string_equal(text, known[i].reference);
        assert_int_equal(mgrs_read(text, &latitude, &longitude, &error), 0);
        assert_true(fabs(latitude - known[i].latitude) * DEGREE_M < 0.8);
    }
}

/* From GeographicLib 2.1.2: GeoConvert -g -p 4, which takes the middle of a square, too. */
static void test_a_short_reference_is_the_middle_of_its_square(void **state)
{
    static const struct known shorts[] = {
        {33.334235085, 44.403627848, "38SMB4488"},        {44.687685439, -70.892924385, "19TCK"},
        {21.409801158, -157.916076317, "4QFJ1234567890"}, {60.149778620, 4.946090555, "32VKM77"},
        {74.998123949, 9.993439393, "33XUD5529"},         {33.334235, 44.403628, "  38s mb 44 88 "},
    };
    (void)state;
    for (size_t i = 0; i < sizeof shorts / sizeof shorts[0]; i++) {
        double latitude, longitude;
        assert_int_equal(mgrs_read(shorts[i].reference, &latitude, &longitude, &error), 0);
        if (fabs(latitude - shorts[i].latitude) > 1e-3 ||
            fabs(longitude - shorts[i].longitude) > 1e-3)
            fail_msg("%s: %.6f %.6f", shorts[i].reference, latitude, longitude);
    }
}

static void test_there_and_back_is_the_same_square(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        double latitude = -80.0 + 164.0 * random_unit(random, i, 0, 0), south;
        double longitude = -180.0 + 360.0 * random_unit(random, i, 1, 0), east;
        char text[MGRS_TEXT_MAX], again[MGRS_TEXT_MAX];
        assert_true(mgrs_write(text, latitude, longitude));
        if (mgrs_read(text, &south, &east, &error) != 0)
            fail_msg("%.9f %.9f: %s", latitude, longitude, error.text);
        assert_true(fabs(south - latitude) * DEGREE_M < 0.8);
        /* The square of a zone's edge may have its middle in the next zone. */
        assert_true(mgrs_write(again, south, east));
        if (strcmp(again, text) != 0) {
            double there, away;
            assert_int_equal(mgrs_read(again, &there, &away, &error), 0);
            assert_true(fabs(there - latitude) * DEGREE_M < 2.0);
        }
    }
}

static void test_what_is_no_reference_is_refused_with_the_reason(void **state)
{
    static const struct {
        const char *text, *because;
    } wrong[] = {
        {"", "no zone with three letters"},
        {"19TC", "no zone with three letters"},
        {"TCK1617404497", "no zone with three letters"},
        {"119TCK", "no zone with three letters"},
        {"0TCK", "no such zone"},
        {"61TCK", "no such zone"},
        {"19ICK", "no such band"},
        {"19ACK", "caps of the poles"},
        {"19TIK", "no square of these letters"},
        {"19TXK", "its zone has no square of these letters"},
        {"19TCI", "its zone has no square of these letters"},
        {"19TCA", "its band has no square of these letters"},
        {"32XNA", "off Svalbard"},
        {"19TCK123", "not as many digits"},
        {"19TCK12345678x0", "not as many digits"},
        {"19TCK161740449700", "more than ten digits"},
        {"19TCK\n", "not as many digits"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        double latitude, longitude;
        assert_int_equal(mgrs_read(wrong[i].text, &latitude, &longitude, &error), -1);
        if (!strstr(error.text, wrong[i].because))
            fail_msg("'%s': \"%s\" does not say \"%s\"", wrong[i].text, error.text,
                     wrong[i].because);
    }
}

static void test_the_caps_have_no_reference(void **state)
{
    char text[MGRS_TEXT_MAX] = "x";
    (void)state;
    assert_false(mgrs_write(text, 84.001, 0.0));
    assert_string_equal(text, "");
    assert_false(mgrs_write(text, -80.001, 0.0));
    assert_false(mgrs_write(text, NAN, 0.0));
    assert_false(mgrs_write(text, 0.0, 181.0));
    assert_true(mgrs_write(text, 84.0, 180.0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_references_are_those_of_geographiclib),
        cmocka_unit_test(test_a_short_reference_is_the_middle_of_its_square),
        cmocka_unit_test(test_there_and_back_is_the_same_square),
        cmocka_unit_test(test_what_is_no_reference_is_refused_with_the_reason),
        cmocka_unit_test(test_the_caps_have_no_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
