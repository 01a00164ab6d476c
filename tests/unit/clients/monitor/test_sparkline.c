/* The sparkline: the newest at the right, full at the limit, a mark beyond it. */
#include "clients/monitor/sparkline.c" /* the unit tests are not linked with the processes */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct sparkline sparkline;
static char text[SPARKLINE_TEXT_MAX];

static void test_levels(void **state)
{
    (void)state;
    sparkline = (struct sparkline){0};
    sparkline_text(text, &sparkline, 8, 16.0, false);
    assert_string_equal(text, "");
    for (int i = 0; i < 8; i++)
        sparkline_add(&sparkline, 2.0 * i + 0.5);
    sparkline_add(&sparkline, 16.0);
    sparkline_add(&sparkline, 16.1);
    sparkline_text(text, &sparkline, 10, 16.0, false);
    assert_string_equal(text, "_.,-:=+##!");
    sparkline_text(text, &sparkline, 4, 16.0, true);
    assert_string_equal(text, "▇██!");
    sparkline_text(text, &sparkline, 2, 0.0, false);
    assert_string_equal(text, "!!");
}

static void test_only_the_last_are_kept(void **state)
{
    (void)state;
    sparkline = (struct sparkline){0};
    sparkline_add(&sparkline, 100.0);
    for (uint32_t i = 0; i < SPARKLINE_SAMPLES; i++)
        sparkline_add(&sparkline, 1.0);
    sparkline_text(text, &sparkline, 2 * SPARKLINE_SAMPLES, 8.0, true);
    assert_int_equal(strlen(text), SPARKLINE_SAMPLES * strlen("▂"));
    assert_float_equal(sparkline_max(&sparkline, SPARKLINE_SAMPLES), 1.0, 0.0);
    sparkline_add(&sparkline, 9.0);
    assert_float_equal(sparkline_max(&sparkline, 1), 9.0, 0.0);
    assert_float_equal(sparkline_max(&sparkline, SPARKLINE_SAMPLES), 9.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_only_the_last_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
