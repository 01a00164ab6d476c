/* Back-pressure: the world is paused until all events are written, and only by the recorder. */
#include "recorder/back_pressure.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SLOTS 256u /* slots of the event ring */

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    steps_small_ring(&f, SLOTS);
    steps_params(&f)->when_full = WHEN_FULL_PAUSE;
    return 0;
}

static const struct state_head *head(void)
{
    return fixture_state(&f).head;
}

static void send_console(enum command_type type)
{
    static uint64_t number;
    steps_send(&f, RING_CLIENTS,
               (struct command){.type = type, .source = 9, .source_sequence = ++number});
    fixture_run(&f, 1);
}

/* Steps without writing until back-pressure pauses the world, and then the frame that applies the
 * pause. */
static void step_until_paused(struct back_pressure *pressure)
{
    while (atomic_load(&f.view.commands[RING_RECORDER]->head) == 0) {
        for (int i = 0; i < 4; i++)
            steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_NONE});
        fixture_run(&f, 1);
        back_pressure_update(pressure, &f.view, 0);
        assert_true(head()->event_end < SLOTS - SLOTS / 8);
    }
    fixture_run(&f, 1);
    assert_int_equal(head()->paused, 1);
    back_pressure_update(pressure, &f.view, 0);
    assert_true(back_pressure_holds(pressure));
}

static void test_back_pressure_pauses_until_all_is_written(void **state)
{
    struct back_pressure pressure, next;
    (void)state;
    back_pressure_open(&pressure, &f.view);
    step_until_paused(&pressure);
    uint64_t tick = head()->tick;
    back_pressure_open(&next,
                       &f.view); /* a new recorder finds that the recorder holds the world paused */
    assert_true(back_pressure_holds(&next));
    back_pressure_update(&next, &f.view, head()->event_end - 1);
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 1);
    back_pressure_update(&next, &f.view, head()->event_end);
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 2);
    fixture_run(&f, 1);
    assert_int_equal(head()->paused, 0);
    assert_int_equal(head()->tick, tick + 1);
    back_pressure_update(&next, &f.view, head()->event_end);
    assert_false(back_pressure_holds(&next));
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 2);
}

static void test_back_pressure_keeps_the_pauses_of_others(void **state)
{
    struct back_pressure pressure;
    (void)state;
    back_pressure_open(&pressure, &f.view);
    send_console(COMMAND_PAUSE);
    back_pressure_update(&pressure, &f.view, head()->event_end);
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 0);
    send_console(COMMAND_RESUME);
    step_until_paused(&pressure);
    send_console(COMMAND_PAUSE); /* now another ring wants the pause, too */
    back_pressure_update(&pressure, &f.view, head()->event_end);
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 1);
    send_console(COMMAND_RESUME);
    assert_int_equal(head()->paused, 0);
    back_pressure_update(&pressure, &f.view, 0); /* too early: no event is written yet */
    fixture_run(&f, 1);
    assert_int_equal(head()->paused, 1);
}

static void test_no_back_pressure_with_gaps(void **state)
{
    struct back_pressure pressure;
    (void)state;
    steps_params(&f)->when_full = WHEN_FULL_GAP;
    back_pressure_open(&pressure, &f.view);
    for (int i = 0; i < 100; i++) {
        for (int n = 0; n < 4; n++)
            steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_NONE});
        fixture_run(&f, 1);
        back_pressure_update(&pressure, &f.view, 0);
    }
    assert_true(head()->event_end > SLOTS);
    assert_int_equal(atomic_load(&f.view.commands[RING_RECORDER]->head), 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_back_pressure_pauses_until_all_is_written),
        TEST(test_back_pressure_keeps_the_pauses_of_others),
        TEST(test_no_back_pressure_with_gaps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
