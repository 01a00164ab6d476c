/* Conversion to video colours, compared with the formulas of ITU-R BT.709. */
#include "renderer/image/yuv.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define PICTURES 60
#define SIDE_MAX 150u
#define GUARD    0xa5 /* byte after each row and plane */

struct planes {
    struct yuv yuv;
    size_t size[3];
};

static void alloc_planes(struct planes *planes, uint32_t width, uint32_t height)
{
    for (int i = 0; i < 3; i++) {
        uint32_t side = i == 0 ? 1 : 2;
        planes->yuv.stride[i] = (int)(width / 2 * 2 / side + 3);
        planes->size[i] = (size_t)planes->yuv.stride[i] * (height / 2 * 2 / side);
        planes->yuv.plane[i] = malloc(planes->size[i] + 1);
        assert_non_null(planes->yuv.plane[i]);
        memset(planes->yuv.plane[i], GUARD, planes->size[i] + 1);
    }
}

static void free_planes(struct planes *planes)
{
    for (int i = 0; i < 3; i++)
        free(planes->yuv.plane[i]);
}

/* Returns Y', Cb or Cr of the mean of the plane's side by side pixels. */
static double expected(const struct image *image, uint32_t x, uint32_t y, int plane)
{
    uint32_t side = plane == 0 ? 1 : 2;
    double c[3] = {0.0};
    for (uint32_t i = 0; i < side * side; i++) {
        const uint8_t *pixel =
            image->pixels +
            ((size_t)(y * side + i / side) * image->width + x * side + i % side) * 4;
        for (int k = 0; k < 3; k++)
            c[k] += pixel[k] / 255.0 / (side * side);
    }
    double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    if (plane == 0)
        return 16.0 + 219.0 * luma;
    return plane == 1 ? 128.0 + 224.0 * (c[2] - luma) / 1.8556
                      : 128.0 + 224.0 * (c[0] - luma) / 1.5748;
}

static void check(const struct planes *planes, const struct image *image, double tolerance)
{
    for (int i = 0; i < 3; i++) {
        uint32_t side = i == 0 ? 1 : 2, width = image->width / 2 * 2 / side;
        const uint8_t *row = planes->yuv.plane[i];
        for (uint32_t y = 0; y < image->height / 2 * 2 / side; y++, row += planes->yuv.stride[i]) {
            for (uint32_t x = 0; x < width; x++) {
                if (fabs(row[x] - expected(image, x, y, i)) > tolerance)
                    fail_msg("plane %d of %ux%u at %u,%u: %d, not %.2f", i, image->width,
                             image->height, x, y, row[x], expected(image, x, y, i));
            }
            for (uint32_t x = width; x < (uint32_t)planes->yuv.stride[i]; x++)
                assert_int_equal(row[x], GUARD);
        }
        assert_int_equal(*row, GUARD);
    }
}

static void test_matches_the_formula(void **state)
{
    uint64_t seed = fixture_seed(21);
    (void)state;
    for (uint64_t n = 0; n < PICTURES; n++) {
        struct image image;
        struct planes planes;
        uint64_t sides = random_u64(seed, n, 0, RANDOM_PLACE_X);
        assert_int_equal(image_init(&image, 2 + (uint32_t)sides % SIDE_MAX,
                                    2 + (uint32_t)(sides >> 32) % SIDE_MAX),
                         0);
        for (size_t i = 0; i < (size_t)image.width * image.height * 4; i++)
            image.pixels[i] = (uint8_t)random_u64(seed, n, i, RANDOM_NOISE);
        alloc_planes(&planes, image.width, image.height);
        yuv_of_image(&planes.yuv, &image);
        check(&planes, &image, 1.2); /* the coefficients are rounded to 256ths */
        free_planes(&planes);
        image_free(&image);
    }
}

static void test_extreme_colours(void **state)
{
    static const uint8_t colours[][3] = {{0, 0, 0},     {255, 255, 255}, {128, 128, 128},
                                         {255, 0, 0},   {0, 255, 0},     {0, 0, 255},
                                         {255, 255, 0}, {0, 255, 255},   {255, 0, 255}};
    (void)state;
    for (size_t k = 0; k < sizeof colours / sizeof colours[0]; k++) {
        struct image image;
        struct planes planes;
        assert_int_equal(image_init(&image, 66, 4), 0);
        for (size_t i = 0; i < (size_t)image.width * image.height; i++)
            memcpy(image.pixels + 4 * i, colours[k], 3);
        alloc_planes(&planes, image.width, image.height);
        yuv_of_image(&planes.yuv, &image);
        check(&planes, &image, 1.2);
        if (k < 3) {
            assert_int_equal(planes.yuv.plane[1][0], 128);
            assert_int_equal(planes.yuv.plane[2][0], 128);
        }
        free_planes(&planes);
        image_free(&image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_matches_the_formula),
        cmocka_unit_test(test_extreme_colours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
