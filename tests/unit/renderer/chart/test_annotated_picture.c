/* Annotated pictures: at every size nothing is drawn outside of the image, every vehicle shows
 * where the world table says, and drawing again gives the same pixels. */
#include "renderer/chart/annotated_picture.h"

#include "tests/support/map_stage.h"
#include "renderer/chart/instruments.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#define GUARD 64 /* [byte] before and behind a picture's pixels */

static const uint32_t sizes[][2] = {{64, 64},   {64, 300},  {320, 200}, {512, 512},
                                    {640, 360}, {360, 640}, {800, 600}, {1280, 720}};

struct canvas {
    struct image image;
    uint8_t *memory;
};

static void canvas_open(struct canvas *canvas, uint32_t width, uint32_t height)
{
    size_t bytes = (size_t)width * height * 4;
    canvas->memory = malloc(bytes + 2 * (size_t)GUARD);
    assert_non_null(canvas->memory);
    memset(canvas->memory, 0xa5, bytes + 2 * (size_t)GUARD);
    canvas->image = (struct image){width, height, canvas->memory + GUARD};
    for (size_t i = 0; i < bytes; i++)
        canvas->image.pixels[i] = (uint8_t)(i % 4 == 3 ? 255 : 120);
}

static void canvas_close(struct canvas *canvas)
{
    size_t bytes = (size_t)canvas->image.width * canvas->image.height * 4;
    for (size_t i = 0; i < GUARD; i++) {
        assert_int_equal(canvas->memory[i], 0xa5);
        assert_int_equal(canvas->memory[GUARD + bytes + i], 0xa5);
    }
    free(canvas->memory);
}

static int open_stage(void **context)
{
    *context = map_stage_new(fixture_seed(21));
    return 0;
}

static struct annotated_picture_source source_of(const struct map_stage *stage,
                                                 struct tracks *tracks, uint32_t slot)
{
    assert_int_equal(tracks_init(tracks, 64), 0);
    tracks_note(tracks, &stage->frame_view);
    return (struct annotated_picture_source){
        .frame_view = &stage->frame_view, .tracks = tracks, .slot = slot, .fps = 60.0};
}

static void open_picture(struct annotated_picture *picture, const struct map_stage *stage,
                         uint32_t width, uint32_t height)
{
    struct error_text error;
    if (annotated_picture_open(picture, stage->frame_view.world, width, height, &error) != 0)
        fail_msg("%s", error.text);
}

static void test_the_whole_map_shows_every_vehicle(void **context)
{
    const struct map_stage *stage = *context;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct annotated_picture picture;
        struct tracks tracks;
        struct canvas first, again;
        struct annotated_picture_source source = source_of(stage, &tracks, SLOT_NONE);
        open_picture(&picture, stage, sizes[i][0], sizes[i][1]);
        canvas_open(&first, sizes[i][0], sizes[i][1]);
        canvas_open(&again, sizes[i][0], sizes[i][1]);
        assert_int_equal(annotated_picture_map(&picture, &first.image, &source), 0);
        assert_int_equal(annotated_picture_map(&picture, &again.image, &source), 0);
        assert_memory_equal(first.image.pixels, again.image.pixels,
                            (size_t)sizes[i][0] * sizes[i][1] * 4);
        struct box box = picture.layout.whole;
        struct map_view view =
            map_whole(WORLD_SIDE_DEFAULT_M, box.left, box.top, (uint32_t)box.width);
        uint32_t hidden = 0;
        for (uint32_t slot = 0; slot < stage->state.head->used; slot++)
            hidden += !map_stage_shows(stage, &first.image, &view, slot);
        /* A legend on the map may cover some vehicles; at 64 pixels symbols cover each other. */
        if (box.width >= 200 && hidden > (picture.layout.legend.width > 0 ? 0 : 6))
            fail_msg("%ux%u: %u vehicles do not show", sizes[i][0], sizes[i][1], hidden);
        annotated_picture_close(&picture);
        tracks_free(&tracks);
        canvas_close(&first);
        canvas_close(&again);
    }
}

static uint32_t changed(const struct image *image, struct box box)
{
    uint32_t count = 0;
    for (int32_t y = box.top; y < box.top + box.height; y++)
        for (int32_t x = box.left; x < box.left + box.width; x++) {
            const uint8_t *p = image->pixels + ((size_t)y * image->width + (size_t)x) * 4;
            count += p[0] != 120 || p[1] != 120 || p[2] != 120;
        }
    return count;
}

/* Instruments leave the middle of the picture free, and an alarm is red at every size. */
static void test_instruments_keep_to_their_places(void **context)
{
    const struct map_stage *stage = *context;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        int32_t width = (int32_t)sizes[i][0], height = (int32_t)sizes[i][1];
        struct annotated_picture picture;
        struct tracks tracks;
        struct canvas canvas;
        struct annotated_picture_source source = source_of(stage, &tracks, 7);
        stage->state.entities.row[7].damage = DAMAGE_HIGH;
        open_picture(&picture, stage, sizes[i][0], sizes[i][1]);
        canvas_open(&canvas, sizes[i][0], sizes[i][1]);
        annotated_picture_instruments(&picture, &canvas.image, &source);
        struct box middle = {0, height * 3 / 10, width, height * 3 / 10};
        struct box left = {0, 0, width / 2, height / 2};
        if (width >= 200 && height >= 200) {
            assert_int_equal(changed(&canvas.image, middle), 0);
            assert_int_equal(changed(&canvas.image, left), 0);
        }
        assert_true(changed(&canvas.image, (struct box){0, height - 12, width, 12}) > 0);
        uint32_t red = 0;
        for (size_t at = (size_t)width * (size_t)(height / 2); at < (size_t)width * (size_t)height;
             at++) {
            const uint8_t *p = canvas.image.pixels + at * 4;
            red += p[0] == 196 && p[1] == 36 && p[2] == 20;
        }
        if (width >= 320)
            assert_true(red > 20);
        annotated_picture_close(&picture);
        tracks_free(&tracks);
        canvas_close(&canvas);
    }
}

static void test_labels_are_shortened_to_fit(void **context)
{
    const struct map_stage *stage = *context;
    struct annotated_picture picture;
    open_picture(&picture, stage, 320, 200);
    char label[64] = "a name that is much too long for the bar";
    annotated_picture_shorten(&picture, label, 12, 80);
    assert_true(text_width(picture.text, 12, label) <= 80);
    assert_true(strlen(label) > 4);
    assert_int_equal(label[strlen(label) - 1], '.');
    char brief[64] = "Padre";
    annotated_picture_shorten(&picture, brief, 12, 80);
    assert_string_equal(brief, "Padre");
    annotated_picture_close(&picture);
}

/* A glyph is the same after other sizes have evicted it from the cache. */
static void test_glyphs_are_kept_and_made_again(void **context)
{
    const struct map_stage *stage = *context;
    struct annotated_picture picture;
    struct canvas first, again;
    const struct rgba white = {255, 255, 255, 255};
    open_picture(&picture, stage, 320, 200);
    canvas_open(&first, 300, 40);
    canvas_open(&again, 300, 40);
    int32_t end = text_draw_rimmed(picture.text, &first.image, -5, 30, 14, white, "Jolon 0123");
    for (uint32_t size = 8; size < 60; size++)
        assert_true(text_width(picture.text, size, "Jolon") > 0);
    assert_int_equal(text_draw_rimmed(picture.text, &again.image, -5, 30, 14, white, "Jolon 0123"),
                     end);
    assert_int_equal(text_width(picture.text, 14, "Jolon 0123"), end + 5);
    assert_memory_equal(first.image.pixels, again.image.pixels, (size_t)300 * 40 * 4);
    canvas_close(&first);
    canvas_close(&again);
    annotated_picture_close(&picture);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, map_stage_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_the_whole_map_shows_every_vehicle),
        TEST(test_instruments_keep_to_their_places),
        TEST(test_labels_are_shortened_to_fit),
        TEST(test_glyphs_are_kept_and_made_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
