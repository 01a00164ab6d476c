/* The memory of axes between pairs of bodies. */
#include "collider/narrow_phase/axis_memory.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct axis_memory memory;

static int open_memory(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; };");
    return axis_memory_init(&memory, &f.view.world);
}

static int close_memory(void **state)
{
    (void)state;
    axis_memory_free(&memory);
    fixture_close(&f);
    return 0;
}

static void keep(uint32_t a, uint32_t b, double x, uint32_t failed)
{
    const struct remembered_axis axis = {.pair = {a, b}, .axis = {x, 0.0, 0.0}, .failed = failed};
    axis_memory_keep(&memory, &axis);
}

static void test_an_unknown_pair_has_no_axis(void **state)
{
    (void)state;
    struct remembered_axis axis = axis_memory_recall(&memory, &(struct pair){3, 5});
    assert_true(axis.axis.x == 0.0 && axis.axis.y == 0.0 && axis.axis.z == 0.0);
    assert_int_equal(axis.failed, 0);
}

static void test_a_pair_gets_back_what_was_kept(void **state)
{
    (void)state;
    keep(3, 5, 1.0, 0);
    keep(3, PAIR_FIXED | 5, -1.0, 4);
    assert_true(axis_memory_recall(&memory, &(struct pair){3, 5}).axis.x == 1.0);
    struct remembered_axis wall = axis_memory_recall(&memory, &(struct pair){3, PAIR_FIXED | 5});
    assert_true(wall.axis.x == -1.0);
    assert_int_equal(wall.failed, 4);
}

/* Of two pairs with one place the later one is kept, and neither gets the axis of the other. */
static void test_a_full_memory_forgets(void **state)
{
    (void)state;
    uint32_t known = 0;
    for (uint32_t b = 1; b < 8 * (memory.mask + 1); b++)
        keep(0, b, (double)b, b);
    for (uint32_t b = 1; b < 8 * (memory.mask + 1); b++) {
        struct remembered_axis axis = axis_memory_recall(&memory, &(struct pair){0, b});
        assert_true(axis.failed == 0 || (axis.failed == b && axis.axis.x == (double)b));
        known += axis.failed > 0;
    }
    assert_in_range(known, (memory.mask + 1) / 2, memory.mask + 1);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_memory, close_memory)
    const struct CMUnitTest tests[] = {
        TEST(test_an_unknown_pair_has_no_axis),
        TEST(test_a_pair_gets_back_what_was_kept),
        TEST(test_a_full_memory_forgets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
