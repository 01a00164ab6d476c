/* Quality control: it lowers quality when the rate cannot be kept, raises it again, and does not
 * oscillate. */
#include "renderer/quality_control.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define FPS 60.0

static double now_s;

/* How often quality was lowered and raised. */
struct changes {
    int lowered, raised;
};

/* Draws pictures that take took_s each, for for_s seconds. */
static struct changes draw(struct quality_control *quality, double took_s, double for_s)
{
    struct changes changes = {0, 0};
    double interval_s = took_s > 1.0 / FPS ? took_s : 1.0 / FPS;
    for (double end_s = now_s + for_s; now_s < end_s; now_s += interval_s) {
        int change = quality_control_note(quality, took_s, now_s);
        changes.lowered += change < 0;
        changes.raised += change > 0;
    }
    return changes;
}

/* Simulates for_s seconds of a renderer whose pictures take full_s at level 0, and less at others.
 */
static struct changes live(struct quality_control *quality, double full_s, double for_s)
{
    static const double share[QUALITY_CONTROL_LEVELS] = {1.0, 0.8, 0.68, 0.6, 0.4, 0.2};
    struct changes all = {0, 0};
    for (double end_s = now_s + for_s; now_s < end_s;) {
        struct changes one =
            draw(quality, full_s * share[quality->level], 0.5 / FPS); /* one picture */
        all.lowered += one.lowered;
        all.raised += one.raised;
    }
    return all;
}

static int set_up(void **state)
{
    static struct quality_control quality;
    quality_control_init(&quality, FPS);
    now_s = 100.0;
    *state = &quality;
    return 0;
}

static void test_levels_fall(void **state)
{
    (void)state;
    assert_true(quality_control_levels[0].detail == 1.0 && quality_control_levels[0].quarters == 4);
    for (uint32_t i = 1; i < QUALITY_CONTROL_LEVELS; i++) {
        assert_true(quality_control_levels[i].detail <= quality_control_levels[i - 1].detail);
        assert_true(quality_control_levels[i].quarters <= quality_control_levels[i - 1].quarters);
        assert_true(quality_control_levels[i].detail > 0.0 &&
                    quality_control_levels[i].quarters > 0);
    }
}

static void test_what_keeps_the_rate_stays(void **state)
{
    struct quality_control *quality = *state;
    struct changes changes = draw(quality, 0.9 / FPS, 60.0);
    assert_int_equal(changes.lowered + changes.raised, 0);
    assert_int_equal(quality->level, 0);
}

static void test_a_single_slow_picture_is_none(void **state)
{
    struct quality_control *quality = *state;
    for (int i = 0; i < 50; i++) {
        assert_int_equal(draw(quality, 0.7 / FPS, 0.1).lowered, 0);
        assert_int_equal(quality_control_note(quality, 0.3, now_s), 0);
    }
}

static void test_too_slow_falls_to_the_last_level_and_stays(void **state)
{
    struct quality_control *quality = *state;
    struct changes changes = draw(quality, 2.0 / FPS, 10.0);
    assert_int_equal(changes.lowered, QUALITY_CONTROL_LEVELS - 1);
    assert_int_equal(changes.raised, 0);
    assert_int_equal(quality->level, QUALITY_CONTROL_LEVELS - 1);
    assert_true(quality_control_median_s(quality) == 2.0 / FPS);
    assert_true(quality->judged_s == 2.0 / FPS);
}

static void test_a_fall_comes_within_a_second(void **state)
{
    struct quality_control *quality = *state;
    draw(quality, 0.3 / FPS, 5.0);
    assert_true(draw(quality, 1.5 / FPS, 0.4).lowered >= 1);
}

static void test_more_again_when_there_is_time(void **state)
{
    struct quality_control *quality = *state;
    draw(quality, 2.0 / FPS, 10.0);
    assert_int_equal(draw(quality, 0.2 / FPS, QUALITY_CONTROL_RAISE_DELAY_S - 0.3).raised, 0);
    struct changes changes = draw(quality, 0.2 / FPS, 60.0);
    assert_int_equal(changes.raised, QUALITY_CONTROL_LEVELS - 1);
    assert_int_equal(changes.lowered, 0);
    assert_int_equal(quality->level, 0);
}

/* The right quality lies between two levels: the higher one is tried ever more seldom. */
static void test_no_to_and_fro(void **state)
{
    struct quality_control *quality = *state;
    quality->level = 4;
    double full_s = 2.5 * QUALITY_CONTROL_BUSY / FPS * 0.5; /* level 4: half; level 3: below busy */
    struct changes settled = live(quality, full_s, 600.0);
    assert_true(settled.lowered + settled.raised <= 8);

    quality_control_init(quality, FPS);
    /* A picture takes 0.48 of the interval at level 5, and 0.96 at level 4. */
    double wrong_s = 0.48 / 0.2 / FPS;
    struct changes first = live(quality, wrong_s, 60.0), later = live(quality, wrong_s, 600.0);
    assert_true(first.lowered >= 5);
    assert_true(later.raised <= 12);
    assert_true(later.lowered <= 12);
}

static void test_without_a_rate_everything_is_drawn(void **state)
{
    struct quality_control *quality = *state;
    quality_control_init(quality, 0.0);
    assert_int_equal(draw(quality, 5.0, 200.0).lowered, 0);
    assert_int_equal(quality->level, 0);
}

#define TEST(name) cmocka_unit_test_setup(name, set_up)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_levels_fall),
        TEST(test_what_keeps_the_rate_stays),
        TEST(test_a_single_slow_picture_is_none),
        TEST(test_too_slow_falls_to_the_last_level_and_stays),
        TEST(test_a_fall_comes_within_a_second),
        TEST(test_more_again_when_there_is_time),
        TEST(test_no_to_and_fro),
        TEST(test_without_a_rate_everything_is_drawn),
    };
    return cmocka_run_group_tests_name("governor", tests, NULL, NULL);
}
