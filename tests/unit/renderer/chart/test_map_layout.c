/* Layouts of all sizes: no parts overlap, and none is cut off. */
#include "renderer/chart/map_layout.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void check(uint32_t width, uint32_t height)
{
    struct map_layout layout;
    map_layout_init(&layout, width, height);
    const struct box picture = {0, 0, (int32_t)width, (int32_t)height};
    const struct box boxes[] = {layout.whole, layout.close_up, layout.figures, layout.legend};
    const size_t count = sizeof boxes / sizeof boxes[0];
    assert_int_equal(layout.whole.width, layout.whole.height);
    assert_int_equal(layout.whole.width, width < height ? width : height);
    assert_true(layout.font_size >= MAP_LAYOUT_FONT_MIN);
    for (size_t i = 0; i < count; i++) {
        if (boxes[i].width == 0)
            continue;
        if (!box_within(boxes[i], picture) || boxes[i].height <= 0)
            fail_msg("%ux%u: part %zu is %d,%d %dx%d", width, height, i, boxes[i].left,
                     boxes[i].top, boxes[i].width, boxes[i].height);
        for (size_t j = 0; j < i; j++)
            if (boxes[j].width > 0 && box_overlap(boxes[i], boxes[j]))
                fail_msg("%ux%u: parts %zu and %zu overlap", width, height, i, j);
    }
}

static void test_parts_lie_beside_each_other(void **context)
{
    (void)context;
    uint64_t seed = fixture_seed(3);
    for (uint32_t i = 0; i < 20000; i++)
        check((uint32_t)fixture_uniform(&seed, 64.0, 4097.0),
              (uint32_t)fixture_uniform(&seed, 64.0, 4097.0));
    check(64, 64);
    check(4096, 64);
    check(64, 4096);
}

static void test_usual_sizes_have_all_parts(void **context)
{
    (void)context;
    static const uint32_t sizes[][2] = {{640, 360},   {1280, 720}, {1920, 1080},
                                        {3840, 2160}, {720, 1280}, {1024, 768}};
    struct map_layout layout;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        map_layout_init(&layout, sizes[i][0], sizes[i][1]);
        assert_true(layout.close_up.width > 0);
        assert_true(layout.figures.width > 0);
        assert_true(layout.legend.width > 0);
    }
    map_layout_init(&layout, 512, 512);
    assert_int_equal(layout.legend.width, 0);
    map_layout_init(&layout, 320, 200);
    assert_int_equal(layout.close_up.width, 0);
    assert_true(layout.legend.width > 0);
}

static void test_a_place_is_taken_once(void **context)
{
    (void)context;
    struct label_space space = {.bounds = {10, 10, 100, 50}};
    assert_true(label_space_take(&space, (struct box){10, 10, 20, 10}));
    assert_false(label_space_take(&space, (struct box){29, 19, 5, 5}));
    assert_true(label_space_take(&space, (struct box){30, 19, 5, 5}));
    assert_false(label_space_take(&space, (struct box){100, 30, 11, 5})); /* beyond the edge */
    assert_false(label_space_take(&space, (struct box){9, 30, 5, 5}));
    for (uint32_t i = 0; i < 2 * LABEL_SPACE_MAX; i++)
        label_space_take(&space, (struct box){10 + (int32_t)i % 50, 40 + (int32_t)i / 50, 1, 1});
    assert_int_equal(space.count, LABEL_SPACE_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parts_lie_beside_each_other),
        cmocka_unit_test(test_usual_sizes_have_all_parts),
        cmocka_unit_test(test_a_place_is_taken_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
