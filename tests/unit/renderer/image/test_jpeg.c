/* JPEG pictures, decoded by libjpeg. */
#include "renderer/image/jpeg.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>

#include <cmocka.h>

/* A smooth gradient of colours, which JPEG keeps well. */
static void paint(struct image *image)
{
    for (uint32_t y = 0; y < image->height; y++) {
        for (uint32_t x = 0; x < image->width; x++) {
            uint8_t *pixel = image->pixels + ((size_t)y * image->width + x) * 4;
            pixel[0] = (uint8_t)(x * 255 / image->width);
            pixel[1] = (uint8_t)(y * 255 / image->height);
            pixel[2] = 80;
            pixel[3] = (uint8_t)x; /* ignored by the encoder */
        }
    }
}

static void check(const struct image *image, const uint8_t *bytes, size_t count)
{
    struct jpeg_error_mgr errors;
    struct jpeg_decompress_struct jpeg = {.err = jpeg_std_error(&errors)};
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, bytes, count);
    assert_int_equal(jpeg_read_header(&jpeg, TRUE), JPEG_HEADER_OK);
    jpeg_start_decompress(&jpeg);
    assert_int_equal(jpeg.output_width, image->width);
    assert_int_equal(jpeg.output_height, image->height);
    assert_int_equal(jpeg.output_components, 3);
    uint8_t *pixels = malloc((size_t)image->width * 3);
    assert_non_null(pixels);
    for (uint32_t y = 0; y < image->height; y++) {
        JSAMPROW row = pixels;
        assert_int_equal(jpeg_read_scanlines(&jpeg, &row, 1), 1);
        for (uint32_t x = 0; x < image->width; x++) {
            const uint8_t *was = image->pixels + ((size_t)y * image->width + x) * 4;
            for (int c = 0; c < 3; c++)
                assert_in_range(pixels[3 * x + (uint32_t)c] + 12 - was[c], 0, 24);
        }
    }
    free(pixels);
    jpeg_finish_decompress(&jpeg);
    assert_int_equal(errors.num_warnings, 0);
    jpeg_destroy_decompress(&jpeg);
}

static void test_decodes_to_nearly_the_same(void **state)
{
    static const uint32_t sides[][2] = {{64, 64}, {320, 180}, {129, 67}, {1, 1}, {640, 361}};
    (void)state;
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        struct image image;
        uint8_t *bytes;
        size_t count;
        assert_int_equal(image_init(&image, sides[i][0], sides[i][1]), 0);
        paint(&image);
        assert_int_equal(jpeg_encode(&image, 80, &bytes, &count), 0);
        check(&image, bytes, count);
        free(bytes);
        image_free(&image);
    }
}

/* The result has more bytes than pixels; the buffer must hold them. */
static void test_noise_at_best_quality_fits_the_buffer(void **state)
{
    struct image image;
    uint8_t *bytes;
    size_t count;
    uint32_t noise = 1;
    (void)state;
    assert_int_equal(image_init(&image, 333, 222), 0);
    for (size_t i = 0; i < (size_t)333 * 222 * 4; i++) {
        noise = noise * 1664525u + 1013904223u;
        image.pixels[i] = noise >> 31 ? 255 : 0;
    }
    assert_int_equal(jpeg_encode(&image, 100, &bytes, &count), 0);
    assert_true(count > (size_t)333 * 222);
    free(bytes);
    image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decodes_to_nearly_the_same),
        cmocka_unit_test(test_noise_at_best_quality_fits_the_buffer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
