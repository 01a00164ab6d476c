/* Pictures in 256 colours look like the picture, and are the same each time. */
#include "docs/figures/palette.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH  160u
#define HEIGHT 90u
#define BLOCK  10u /* [pixel] colours are compared as means of such squares, as eyes do */

static void draw_sky_and_noise(struct image *image, uint64_t seed)
{
    assert_int_equal(image_init(image, WIDTH, HEIGHT), 0);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint8_t *p = image->pixels + ((size_t)y * WIDTH + x) * 4;
            double noise = y < HEIGHT / 2 ? 0.0 : fixture_uniform(&seed, -30.0, 30.0);
            p[0] = (uint8_t)(60 + x + noise);
            p[1] = (uint8_t)(90 + y + noise);
            p[2] = (uint8_t)(200 - y - noise);
            p[3] = 255;
        }
}

static double block_mean(const struct image *image, const struct palette *palette,
                         const uint8_t *indices, uint32_t left, uint32_t top, uint32_t channel)
{
    double sum = 0.0;
    for (uint32_t y = top; y < top + BLOCK; y++)
        for (uint32_t x = left; x < left + BLOCK; x++) {
            size_t at = (size_t)y * WIDTH + x;
            sum += indices != NULL ? palette->colours[indices[at]][channel]
                                   : image->pixels[at * 4 + channel];
        }
    return sum / (BLOCK * BLOCK);
}

static void test_few_colours_look_the_same(void **context)
{
    (void)context;
    static struct palette palette, again;
    static uint8_t indices[WIDTH * HEIGHT], once_more[WIDTH * HEIGHT];
    struct image image;
    draw_sky_and_noise(&image, fixture_seed(9));
    assert_int_equal(palette_reduce(&palette, indices, &image), 0);
    assert_true(palette.count > 200 && palette.count <= PALETTE_COLOURS);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(indices[i] < palette.count);
    for (uint32_t y = 0; y < HEIGHT; y += BLOCK)
        for (uint32_t x = 0; x < WIDTH; x += BLOCK)
            for (uint32_t i = 0; i < 3; i++) {
                double was = block_mean(&image, &palette, NULL, x, y, i);
                double is = block_mean(&image, &palette, indices, x, y, i);
                if (fabs(was - is) > 2.5)
                    fail_msg("channel %u at %u, %u: %.1f became %.1f", i, x, y, was, is);
            }
    assert_int_equal(palette_reduce(&again, once_more, &image), 0);
    assert_memory_equal(&palette, &again, sizeof palette);
    assert_memory_equal(indices, once_more, sizeof indices);
    image_free(&image);
}

static void test_one_colour_stays(void **context)
{
    (void)context;
    static struct palette palette;
    static uint8_t indices[WIDTH * HEIGHT];
    struct image image;
    assert_int_equal(image_init(&image, WIDTH, HEIGHT), 0);
    image_rectangle(&image, 0, 0, WIDTH, HEIGHT, (struct rgba){17, 113, 201, 255});
    assert_int_equal(palette_reduce(&palette, indices, &image), 0);
    assert_int_equal(palette.count, 1);
    assert_int_equal(palette.colours[0][0], 17);
    assert_int_equal(palette.colours[0][1], 113);
    assert_int_equal(palette.colours[0][2], 201);
    image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_few_colours_look_the_same),
        cmocka_unit_test(test_one_colour_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
