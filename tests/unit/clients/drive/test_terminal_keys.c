/* Keys: bytes of plain terminals and of those with the Kitty protocol, in any pieces. */
#include "clients/drive/terminal_keys.c" /* the unit tests are not linked with the processes */

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct terminal_keys keys;
static struct intents queue;

static void decode(const char *bytes)
{
    queue.count = 0;
    terminal_keys_decode(&keys, bytes, strlen(bytes), &queue);
}

static int open_keys(void **state)
{
    (void)state;
    keys = (struct terminal_keys){0};
    return 0;
}

static void assert_push(uint32_t which, enum intent_type type, enum input_axis axis, double value)
{
    assert_true(which < queue.count);
    assert_int_equal(queue.intent[which].type, type);
    assert_int_equal(queue.intent[which].axis, axis);
    assert_true((double)queue.intent[which].value == value);
}

static void assert_act(uint32_t which, enum input_action action)
{
    assert_true(which < queue.count);
    assert_int_equal(queue.intent[which].type, INTENT_ACT);
    assert_int_equal(queue.intent[which].action, action);
}

static void test_plain_keys(void **state)
{
    (void)state;
    decode("wA tq");
    assert_int_equal(queue.count, 5);
    assert_push(0, INTENT_DOWN, AXIS_THROTTLE, 1.0);
    assert_false(queue.intent[0].reports_release);
    assert_push(1, INTENT_DOWN, AXIS_STEER, -1.0);
    assert_act(2, ACTION_FIRE);
    assert_act(3, ACTION_LOCK);
    assert_act(4, ACTION_QUIT);
    decode("\003");
    assert_act(0, ACTION_QUIT);
    decode("\r~\377");
    assert_int_equal(queue.count, 1);
    assert_act(0, ACTION_TAKE);
}

static void test_arrows(void **state)
{
    (void)state;
    decode("\033[A\033[D\033OB\033OC");
    assert_int_equal(queue.count, 4);
    assert_push(0, INTENT_DOWN, AXIS_AIM_Y, 1.0);
    assert_push(1, INTENT_DOWN, AXIS_AIM_X, -1.0);
    assert_push(2, INTENT_DOWN, AXIS_AIM_Y, -1.0);
    assert_push(3, INTENT_DOWN, AXIS_AIM_X, 1.0);
}

static void test_protocol(void **state)
{
    (void)state;
    decode("\033[119u"); /* before anything says that releases come */
    assert_push(0, INTENT_DOWN, AXIS_THROTTLE, 1.0);
    assert_false(queue.intent[0].reports_release);
    decode("\033[?11u");
    assert_int_equal(queue.count, 0);
    assert_true(keys.reports_release);
    decode(
        "\033[119;1:1u\033[119;1:2u\033[119;1:3u\033[1;1:3A\033[32;1:1u\033[32;1:2u\033[32;1:3u");
    assert_int_equal(queue.count, 5);
    assert_push(0, INTENT_DOWN, AXIS_THROTTLE, 1.0);
    assert_true(queue.intent[0].reports_release);
    assert_push(1, INTENT_DOWN, AXIS_THROTTLE, 1.0);
    assert_push(2, INTENT_UP, AXIS_THROTTLE, 1.0);
    assert_push(3, INTENT_UP, AXIS_AIM_Y, 1.0);
    assert_act(4, ACTION_FIRE); /* once, however long it is held */
    decode("\033[99;5u");       /* ctrl-c comes as a key there, and nobody sends the signal */
    assert_act(0, ACTION_QUIT);
    decode("\033[119;5u"); /* ctrl-w is not w */
    assert_int_equal(queue.count, 0);
    decode("\033[119:87;2:1u\033[47:63;2u"); /* with shift */
    assert_push(0, INTENT_DOWN, AXIS_THROTTLE, 1.0);
    assert_act(1, ACTION_HELP);
}

static void test_pieces(void **state)
{
    (void)state;
    const char text[] = "w\033[A\033[119;1:3u\033[?11us";
    struct intents whole;
    decode(text);
    whole = queue;
    keys = (struct terminal_keys){0};
    queue.count = 0;
    for (const char *byte = text; *byte; byte++)
        terminal_keys_decode(&keys, byte, 1, &queue);
    assert_int_equal(queue.count, whole.count);
    assert_memory_equal(queue.intent, whole.intent, whole.count * sizeof whole.intent[0]);
}

static void test_other_sequences_are_nothing(void **state)
{
    (void)state;
    decode("\033[200~\033[3~\033[?62;4c\033q\033[<0;10;10M\033\033[A");
    assert_int_equal(queue.count, 1); /* the arrow; what a mouse, a paste, alt-q say is not ours */
    assert_push(0, INTENT_DOWN, AXIS_AIM_Y, 1.0);
}

static void test_any_bytes(void **state)
{
    (void)state;
    static const char likely[] = "\033[]OABCDu~?;:0123456789wasd \377";
    uint64_t seed = fixture_seed(13);
    for (int i = 0; i < 20000; i++) {
        char bytes[40];
        size_t count = fixture_random(&seed) % sizeof bytes;
        for (size_t k = 0; k < count; k++)
            bytes[k] = likely[fixture_random(&seed) % (sizeof likely - 1)];
        queue.count = 0;
        terminal_keys_decode(&keys, bytes, count, &queue);
        assert_true(queue.count <= INTENTS_MAX && keys.length < TERMINAL_KEYS_SEQUENCE_MAX);
    }
}

/* The help names every key that does something. */
static void test_help_is_whole(void **state)
{
    (void)state;
    char all[512] = "";
    bool hand_brake = false;
    const char *names, *meaning;
    for (uint32_t i = 0; terminal_keys_help(i, &names, &meaning); i++) {
        assert_true(strlen(names) <= 11 && strlen(meaning) + 14 <= 80);
        (void)strcat(strcat(all, names), " ");
        hand_brake |= strchr(names, 'r') && strstr(meaning, "hand brake");
    }
    assert_true(hand_brake);
    for (size_t i = 0; i < sizeof bindings / sizeof bindings[0]; i++) {
        uint32_t code = bindings[i].code;
        if (code > ' ' && code < TERMINAL_KEYS_UP && code != '=' && code != '?')
            assert_non_null(strchr(all, (int)code));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_plain_keys, open_keys),
        cmocka_unit_test_setup(test_arrows, open_keys),
        cmocka_unit_test_setup(test_protocol, open_keys),
        cmocka_unit_test_setup(test_pieces, open_keys),
        cmocka_unit_test_setup(test_other_sequences_are_nothing, open_keys),
        cmocka_unit_test_setup(test_any_bytes, open_keys),
        cmocka_unit_test_setup(test_help_is_whole, open_keys),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
