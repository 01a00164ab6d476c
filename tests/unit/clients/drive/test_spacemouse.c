/* SpaceMouse: motions and buttons as the daemon sends them, and the controls that result. */
#include "clients/drive/device_library.c" /* the unit tests are not linked with the processes */
#include "clients/drive/spacemouse.c"
#include "clients/drive/control_shaping.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define T0 1000000000u

static struct controls after(const int push[3], const int turn[3], bool aircraft)
{
    struct control_shaping shaping;
    struct intents queue = {.count = 0};
    control_shaping_reset(&shaping, T0);
    spacemouse_motion(push, turn, &queue);
    for (uint32_t i = 0; i < queue.count; i++)
        control_shaping_apply(&shaping, &queue.intent[i], T0);
    (void)control_shaping_step(&shaping, T0 + 100000000u);
    return control_shaping_controls(&shaping, aircraft);
}

/* Thesis row 11. */
static void test_harder_is_faster(void **state)
{
    (void)state;
    double half = (double)after((const int[3]){0, 0, 175}, (const int[3]){0, 0, 0}, false).throttle;
    double full = (double)after((const int[3]){0, 0, 350}, (const int[3]){0, 0, 0}, false).throttle;
    assert_true(half > 0.0 && full > 2.0 * half);
    assert_true(after((const int[3]){0, 0, -350}, (const int[3]){0, 0, 0}, false).throttle < 0.0f);
}

static void test_six_degrees(void **state)
{
    (void)state;
    struct controls c = after((const int[3]){350, -350, 0}, (const int[3]){350, -350, 0}, false);
    assert_true(c.traverse == 1.0f && c.elevate == -1.0f && c.steer == -1.0f && c.brake == 1.0f);
    c = after((const int[3]){0, -350, 0}, (const int[3]){0, 0, 0}, true);
    assert_true(c.climb == -1.0f && c.brake == 0.0f);
    c = after((const int[3]){20, -20, 20}, (const int[3]){20, 20, 20}, false); /* a resting hand */
    assert_true(c.throttle == 0.0f && c.steer == 0.0f && c.brake == 0.0f && c.traverse == 0.0f);
}

/* Row 11: the pick button fires, as it goes down. */
static void test_pick_button(void **state)
{
    (void)state;
    struct intents queue = {.count = 0};
    spacemouse_button(0, true, &queue);
    spacemouse_button(0, false, &queue);
    spacemouse_button(31, true, &queue);
    spacemouse_button(-1, true, &queue);
    assert_int_equal(queue.count, 1);
    assert_int_equal(queue.intent[0].type, INTENT_ACT);
    assert_int_equal(queue.intent[0].action, ACTION_FIRE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_harder_is_faster),
        cmocka_unit_test(test_six_degrees),
        cmocka_unit_test(test_pick_button),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
