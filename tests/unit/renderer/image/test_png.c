/* PNG pictures, decoded by libpng. */
#include "renderer/image/png.h"

#include "tests/support/fixture.h"
#include "world/maths/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include <cmocka.h>

#define PICTURES 40
#define SIDE_MAX 200u

/* Fills the picture with noise, or with runs of one colour. */
static void paint(struct image *image, uint64_t seed, uint64_t number)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        uint64_t place = number % 2 ? i : i / 37;
        for (int c = 0; c < 4; c++)
            image->pixels[4 * i + (size_t)c] =
                (uint8_t)(random_u64(seed, number, place, RANDOM_NOISE) >> (8 * c));
    }
}

static void check_pixels(const struct image *image, const uint8_t *bytes, size_t count)
{
    png_image read = {.version = PNG_IMAGE_VERSION};
    assert_int_not_equal(png_image_begin_read_from_memory(&read, bytes, count), 0);
    assert_int_equal(read.format, PNG_FORMAT_RGB);
    assert_int_equal(read.width, image->width);
    assert_int_equal(read.height, image->height);
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(read));
    assert_non_null(pixels);
    assert_int_not_equal(png_image_finish_read(&read, NULL, pixels, 0, NULL), 0);
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        assert_memory_equal(pixels + 3 * i, image->pixels + 4 * i, 3);
    free(pixels);
}

static void test_decodes_to_the_same(void **state)
{
    uint64_t seed = fixture_seed(11);
    (void)state;
    for (uint64_t n = 0; n < PICTURES; n++) {
        struct image image;
        uint8_t *bytes;
        size_t count;
        uint64_t sides = random_u64(seed, n, 0, RANDOM_PLACE_X);
        assert_int_equal(image_init(&image, 1 + (uint32_t)sides % SIDE_MAX,
                                    1 + (uint32_t)(sides >> 32) % SIDE_MAX),
                         0);
        paint(&image, seed, n);
        assert_int_equal(png_encode(&image, "words", &bytes, &count), 0);
        check_pixels(&image, bytes, count);
        free(bytes);
        image_free(&image);
    }
}

struct reading {
    const uint8_t *next;
};

static void read_bytes(png_structp png, png_bytep to, size_t count)
{
    struct reading *reading = png_get_io_ptr(png);
    memcpy(to, reading->next, count);
    reading->next += count;
}

/* This reader checks every checksum, including that of the text chunk. */
static void test_comment_is_the_description(void **state)
{
    struct image image;
    struct reading reading;
    uint8_t *bytes;
    size_t count;
    png_textp text;
    int texts = 0;
    (void)state;
    assert_int_equal(image_init(&image, 64, 48), 0);
    assert_int_equal(png_encode(&image, "frame=7 time_s=0.117", &bytes, &count), 0);
    reading.next = bytes;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_read_fn(png, &reading, read_bytes);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(png_get_text(png, info, &text, &texts), 1);
    assert_string_equal(text[0].key, "Description");
    assert_string_equal(text[0].text, "frame=7 time_s=0.117");
    assert_ptr_equal(reading.next, bytes + count);
    png_destroy_read_struct(&png, &info, NULL);
    free(bytes);
    image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decodes_to_the_same),
        cmocka_unit_test(test_comment_is_the_description),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
