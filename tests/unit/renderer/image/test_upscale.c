/* Enlarging: one colour stays one colour, and pixels keep their places. */
#include "renderer/image/upscale.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct image picture(uint32_t width, uint32_t height)
{
    struct image image;
    assert_int_equal(image_init(&image, width, height), 0);
    return image;
}

static uint8_t *at(const struct image *image, uint32_t x, uint32_t y)
{
    return image->pixels + ((size_t)y * image->width + x) * 4;
}

static void fill(const struct image *image, uint32_t seed)
{
    for (size_t i = 0; i < (size_t)image->width * image->height * 4; i++) {
        seed = seed * 1664525u + 1013904223u;
        image->pixels[i] = (uint8_t)(seed >> 24);
    }
}

static void test_same_size_copies(void **state)
{
    (void)state;
    struct image from = picture(37, 23), to = picture(37, 23);
    fill(&from, 5);
    image_upscale(&to, &from);
    assert_memory_equal(to.pixels, from.pixels, 37 * 23 * 4);
    image_free(&from);
    image_free(&to);
}

static void test_one_colour_stays(void **state)
{
    (void)state;
    struct image from = picture(48, 27), to = picture(64, 36);
    for (uint32_t i = 0; i < 48 * 27; i++)
        memcpy(from.pixels + (size_t)i * 4, "\xff\x80\x01\xfe", 4);
    image_upscale(&to, &from);
    for (uint32_t i = 0; i < 64 * 36; i++)
        assert_memory_equal(to.pixels + (size_t)i * 4, "\xff\x80\x01\xfe", 4);
    image_free(&from);
    image_free(&to);
}

/* No channel leaves the range of the input pixels or takes from a neighbouring channel. */
static void test_stays_in_range_of_the_pixels(void **state)
{
    (void)state;
    struct image from = picture(2, 2), to = picture(8, 8);
    for (uint32_t round = 0; round < 200; round++) {
        fill(&from, round);
        image_upscale(&to, &from);
        for (uint32_t i = 0; i < 64; i++)
            for (uint32_t c = 0; c < 4; c++) {
                uint8_t low = 255, high = 0, value = to.pixels[i * 4 + c];
                for (uint32_t k = 0; k < 4; k++) {
                    low = from.pixels[k * 4 + c] < low ? from.pixels[k * 4 + c] : low;
                    high = from.pixels[k * 4 + c] > high ? from.pixels[k * 4 + c] : high;
                }
                assert_in_range(value, low > 0 ? low - 1 : 0, high);
            }
    }
    image_free(&from);
    image_free(&to);
}

static void test_twice_the_size(void **state)
{
    (void)state;
    struct image from = picture(2, 1), to = picture(4, 2);
    memcpy(from.pixels, "\x00\x00\x00\xff\x80\x40\xff\xff", 8);
    image_upscale(&to, &from);
    for (uint32_t y = 0; y < 2; y++) {
        assert_memory_equal(at(&to, 0, y), "\x00\x00\x00\xff", 4);
        assert_memory_equal(at(&to, 1, y), "\x20\x10\x3f\xff", 4);
        assert_memory_equal(at(&to, 2, y), "\x60\x30\xbf\xff", 4);
        assert_memory_equal(at(&to, 3, y), "\x80\x40\xff\xff", 4);
    }
    image_free(&from);
    image_free(&to);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_size_copies),
        cmocka_unit_test(test_one_colour_stays),
        cmocka_unit_test(test_stays_in_range_of_the_pixels),
        cmocka_unit_test(test_twice_the_size),
    };
    return cmocka_run_group_tests_name("upscale", tests, NULL, NULL);
}
