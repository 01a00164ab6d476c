/* Grids of the undulation: between nodes, over the date line, outside, damaged files, and PROJ's
 * own grid where it is installed. */
#include "gateway/earth/geoid_grid.h"

#include "gateway/earth/local_frame.h"

#include "gateway/pdu/octets.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char path[64];
static struct error_text error;
static double undulation_m;

struct header {
    double south, west, lat_step, lon_step;
    uint32_t rows, columns;
};

static void write_grid(struct header header, const float *nodes, size_t count)
{
    uint8_t bytes[40 + 4 * 16];
    octets_put_f64(bytes, header.south);
    octets_put_f64(bytes + 8, header.west);
    octets_put_f64(bytes + 16, header.lat_step);
    octets_put_f64(bytes + 24, header.lon_step);
    octets_put_u32(bytes + 32, header.rows);
    octets_put_u32(bytes + 36, header.columns);
    for (size_t i = 0; i < count; i++)
        octets_put_f32(bytes + 40 + 4 * i, nodes[i]);
    snprintf(path, sizeof path, "/tmp/jolon-geoid.%d", (int)getpid());
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, 40 + 4 * count, file), 40 + 4 * count);
    fclose(file);
}

static void assert_at(double latitude_deg, double longitude_deg, double right_m)
{
    if (geoid_grid_read(path, latitude_deg, longitude_deg, &undulation_m, &error) != 0)
        fail_msg("%s", error.text);
    if (fabs(undulation_m - right_m) > 1e-5)
        fail_msg("%g, %g: %.6f instead of %.6f", latitude_deg, longitude_deg, undulation_m,
                 right_m);
}

static void assert_refused(double latitude_deg, double longitude_deg, const char *why)
{
    assert_int_equal(geoid_grid_read(path, latitude_deg, longitude_deg, &undulation_m, &error), -1);
    if (!strstr(error.text, why) || !strstr(error.text, path))
        fail_msg("\"%s\" has no \"%s\"", error.text, why);
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

/* The four nodes of EGM96 around Fort Hunter Liggett. */
static void test_between_nodes(void **state)
{
    static const float nodes[] = {-35.0f, -34.0f, -33.0f, -31.0f};
    (void)state;
    write_grid((struct header){35.75, -121.25, 0.25, 0.25, 2, 2}, nodes, 4);
    assert_at(35.75, -121.25, -35.0);
    assert_at(35.75, -121.0, -34.0);
    assert_at(36.0, -121.25, -33.0);
    assert_at(36.0, -121.0, -31.0);
    assert_at(35.875, -121.125, -33.25);
    assert_at(35.95, -121.25, -33.4);
    assert_at(35.95, 360.0 - 121.25, -33.4);
    assert_refused(35.74, -121.25, "does not reach");
    assert_refused(36.01, -121.25, "does not reach");
    assert_refused(35.9, -121.26, "does not reach");
    assert_refused(35.9, -120.99, "does not reach");
}

static void test_around_the_earth(void **state)
{
    static const float nodes[] = {0.0f, 1.0f, 2.0f, 4.0f, 10.0f, 11.0f, 12.0f, 14.0f};
    (void)state;
    write_grid((struct header){-90.0, -180.0, 180.0, 90.0, 2, 4}, nodes, 8);
    assert_at(-90.0, 90.0, 4.0);
    assert_at(-90.0, 135.0, 2.0); /* between the last column and the first */
    assert_at(-90.0, 180.0, 0.0);
    assert_at(-90.0, -180.0, 0.0);
    assert_at(90.0, 179.9, 14.0 - 4.0 * 89.9 / 90.0);
    assert_at(0.0, -45.0, 6.5);
}

static void test_damaged_grids(void **state)
{
    static const float nodes[] = {1.0f, -88.8888f, 2.0f, NAN};
    static const struct header wrong[] = {
        {NAN, 0.0, 1.0, 1.0, 2, 2},        {-91.0, 0.0, 1.0, 1.0, 2, 2},
        {0.0, 1e300, 1.0, 1.0, 2, 2},      {0.0, 0.0, 0.0, 1.0, 2, 2},
        {0.0, 0.0, -1.0, 1.0, 2, 2},       {0.0, 0.0, 1.0, NAN, 2, 2},
        {0.0, 0.0, 1.0, 1.0, 1, 2},        {0.0, 0.0, 1.0, 1.0, 2, 0},
        {0.0, 0.0, 1.0, 1.0, 2, 1u << 31}, {0.0, 0.0, 1.0, 1.0, ~0u, 2},
    };
    (void)state;
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        write_grid(wrong[i], nodes, 4);
        assert_refused(0.5, 0.5, "is no GTX grid");
    }
    write_grid((struct header){0.0, 0.0, 1.0, 1.0, 2, 2}, nodes, 4); /* a node has no value */
    assert_refused(0.5, 0.5, "has no undulation at this place");
    write_grid((struct header){0.0, 0.0, 1.0, 1.0, 3, 2}, nodes, 4); /* it ends too early */
    assert_refused(1.5, 0.5, "has no undulation at this place");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("short", file);
    fclose(file);
    assert_refused(0.5, 0.5, "shorter than the header");
    unlink(path);
    assert_refused(0.5, 0.5, "cannot be read");
}

/* The height of the sea at each place of a square: what is sent lies that far above the ellipsoid,
 * and comes back to the same place. */
static void test_a_square_with_a_grid(void **state)
{
    static const float nodes[] = {-40.0f, -20.0f, -36.0f, -16.0f}; /* 20 m a degree to the east */
    struct local_frame frame, even;
    double worst_m = 0.0;
    (void)state;
    write_grid((struct header){35.0, -122.0, 2.0, 1.0, 2, 2}, nodes, 4);
    local_frame_make(&even, 35.95, -121.5, -28.1, 25000.0, 25000.0);
    frame = even;
    assert_int_equal(local_frame_read_undulation(&frame, path, -28.1, &error), 0);
    for (double x = 0.0; x <= 50000.0; x += 1250.0) {
        for (double z = 0.0; z <= 50000.0; z += 1250.0) {
            struct vec3 at = {x, 312.0, z};
            struct vec3 ecef = local_frame_ecef(&frame, at);
            struct geodesy_place place = geodesy_place_of(ecef);
            struct geodesy_place flat = geodesy_place_of(local_frame_ecef(&even, at));
            double right_m;
            assert_int_equal(geoid_grid_read(path, place.latitude_rad * DEG_PER_RAD,
                                             place.longitude_rad * DEG_PER_RAD, &right_m, &error),
                             0);
            double off_m = fabs(place.height_m - flat.height_m - (right_m + 28.1));
            worst_m = off_m > worst_m ? off_m : worst_m;
            assert_true(vec3_length(vec3_sub(local_frame_world(&frame, ecef), at)) < 1e-6);
        }
    }
    print_message("%.2e m off the grid at most\n", worst_m);
    assert_true(worst_m < 2e-3);
    /* Without the grid all is as before. */
    unlink(path);
    assert_int_equal(local_frame_read_undulation(&even, path, -28.1, &error), -1);
    assert_false(even.uneven);
}

/* 33.7 m below the ellipsoid, as cs2cs says for EPSG:4326+5773 to EPSG:4979. */
static void test_projs_own_grid(void **state)
{
    (void)state;
    if (access(GEOID_GRID_PATH, R_OK) != 0)
        skip();
    assert_int_equal(geoid_grid_read(GEOID_GRID_PATH, 35.95, -121.25, &undulation_m, &error), 0);
    assert_true(fabs(undulation_m + 33.68388) < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_between_nodes, remove_file),
        cmocka_unit_test_teardown(test_around_the_earth, remove_file),
        cmocka_unit_test_teardown(test_damaged_grids, remove_file),
        cmocka_unit_test(test_a_square_with_a_grid),
        cmocka_unit_test(test_projs_own_grid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
