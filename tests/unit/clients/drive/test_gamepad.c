/* Gamepads: events of the kernel's input layer, without a device. */
#include "clients/drive/device_library.c" /* the unit tests are not linked with the processes */

#include "clients/drive/gamepad.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct gamepad pad;
static struct intents queue;

static int open_pad(void **state)
{
    (void)state;
    pad = (struct gamepad){0};
    queue.count = 0;
    pad.range[ABS_X] = pad.range[ABS_Y] = (struct gamepad_range){-32768, 32767};
    pad.range[ABS_RX] = pad.range[ABS_RY] = (struct gamepad_range){0, 255};
    pad.range[ABS_Z] = pad.range[ABS_RZ] = (struct gamepad_range){0, 1023};
    return 0;
}

/* As it is read from the device. */
static void event(uint16_t type, uint16_t code, int32_t value)
{
    const struct input_event raw = {.type = type, .code = code, .value = value};
    gamepad_decode(&pad, raw.type, raw.code, raw.value, &queue);
}

static void assert_position(uint32_t which, enum input_axis axis, double value)
{
    assert_true(which < queue.count);
    assert_int_equal(queue.intent[which].type, INTENT_SET);
    assert_int_equal(queue.intent[which].axis, axis);
    assert_true((double)queue.intent[which].value > value - 0.01 &&
                (double)queue.intent[which].value < value + 0.01);
}

static void test_sticks(void **state)
{
    (void)state;
    event(EV_ABS, ABS_X, 32767);
    event(EV_ABS, ABS_Y, -32768); /* away from oneself */
    event(EV_ABS, ABS_RX, 0);
    event(EV_ABS, ABS_RY, 128);
    assert_int_equal(queue.count, 4);
    assert_position(0, AXIS_STEER, 1.0);
    assert_position(1, AXIS_CLIMB, 1.0);
    assert_position(2, AXIS_AIM_X, -1.0);
    assert_position(3, AXIS_AIM_Y, 0.0);
}

static void test_pedals(void **state)
{
    (void)state;
    event(EV_ABS, ABS_RZ, 0);
    event(EV_ABS, ABS_RZ, 1023);
    event(EV_ABS, ABS_Z, 512);
    assert_position(0, AXIS_THROTTLE, 0.0);
    assert_position(1, AXIS_THROTTLE, 1.0);
    assert_position(2, AXIS_BRAKE, 0.5);
}

static void test_buttons(void **state)
{
    (void)state;
    event(EV_KEY, BTN_SOUTH, 1);
    event(EV_KEY, BTN_SOUTH, 2);
    event(EV_KEY, BTN_SOUTH, 0);
    event(EV_KEY, BTN_WEST, 1);
    event(EV_KEY, KEY_A, 1);
    assert_int_equal(queue.count, 2);
    assert_int_equal(queue.intent[0].action, ACTION_FIRE);
    assert_int_equal(queue.intent[1].action, ACTION_LOCK);
}

static void test_cross(void **state)
{
    (void)state;
    event(EV_ABS, ABS_HAT0X, 1);
    event(EV_ABS, ABS_HAT0X, 1);
    event(EV_ABS, ABS_HAT0X, 0);
    event(EV_ABS, ABS_HAT0X, -1);
    event(EV_ABS, ABS_HAT0Y, -1);
    assert_int_equal(queue.count, 3);
    assert_int_equal(queue.intent[0].action, ACTION_NEXT);
    assert_int_equal(queue.intent[1].action, ACTION_PREVIOUS);
    assert_int_equal(queue.intent[2].action, ACTION_GEAR_UP);
}

/* An axis that the device did not describe, codes beyond the table, other types. */
static void test_what_is_not_ours(void **state)
{
    (void)state;
    event(EV_ABS, ABS_GAS, 100);
    event(EV_ABS, ABS_MT_SLOT, 1);
    event(EV_ABS, 0xffff, 1);
    event(EV_REL, REL_X, 5);
    event(EV_SYN, SYN_REPORT, 0);
    event(EV_SYN, SYN_DROPPED, 0);
    assert_int_equal(queue.count, 0);
}

static void test_refusals(void **state)
{
    (void)state;
    struct input input;
    struct error_text error;
    assert_int_equal(gamepad_open(&input, "/nowhere/event0", &error), -1);
    assert_non_null(strstr(error.text, "/nowhere/event0"));
    assert_int_equal(gamepad_open(&input, "/dev/null", &error), -1);
    assert_non_null(strstr(error.text, "not a gamepad"));
    const struct device_library_function none = {"no_such_function", &evdev.free};
    assert_int_equal(device_library_open("libnone.so.9", "libnone9", &none, 1, &error), -1);
    assert_non_null(strstr(error.text, "apt-get install libnone9"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_sticks, open_pad),
        cmocka_unit_test_setup(test_pedals, open_pad),
        cmocka_unit_test_setup(test_buttons, open_pad),
        cmocka_unit_test_setup(test_cross, open_pad),
        cmocka_unit_test_setup(test_what_is_not_ours, open_pad),
        cmocka_unit_test_setup(test_refusals, open_pad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
