/* The verdicts on deaths: supervisor/restart_policy.h. */
#include "supervisor/restart_policy.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define KILLED 137
#define SEGV   139

/* A death before a frame was completed. */
static struct death quick(enum role role, int status)
{
    return (struct death){.role = role, .status = status, .frame = 7, .frame_at_start = 7};
}

static enum verdict verdict_on(struct history *history, struct death death)
{
    uint64_t delay;
    return restart_policy_death(history, &death, &delay);
}

static void test_end_of_the_run_is_no_death(void **state)
{
    struct history history = {0};
    struct death death = quick(ROLE_MOVER, EXIT_OK);
    (void)state;
    death.finished = true;
    assert_int_equal(verdict_on(&history, death), VERDICT_FINISHED);
}

static void test_role_stopped_from_outside_is_restarted(void **state)
{
    struct history history = {0};
    (void)state;
    assert_int_equal(verdict_on(&history, quick(ROLE_MOVER, EXIT_OK)), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, quick(ROLE_RENDERER, EXIT_OK)), VERDICT_RESTART);
}

static void test_only_a_frame_role_that_refuses_ends_the_set(void **state)
{
    struct history history = {0};
    (void)state;
    assert_int_equal(verdict_on(&history, quick(ROLE_COLLIDER, EXIT_REFUSED)), VERDICT_REFUSED);
    assert_int_equal(verdict_on(&history, quick(ROLE_RENDERER, EXIT_REFUSED)), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, quick(ROLE_REPORTER, EXIT_USAGE)), VERDICT_RESTART);
}

static void test_three_crashes_on_a_frame_poison_it(void **state)
{
    struct history history = {0};
    (void)state;
    assert_int_equal(verdict_on(&history, quick(ROLE_COLLIDER, SEGV)), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, quick(ROLE_COLLIDER, SEGV)), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, quick(ROLE_COLLIDER, SEGV)), VERDICT_POISON);
}

static void test_three_hangs_on_a_frame_poison_it(void **state)
{
    struct history history = {0};
    struct death death = quick(ROLE_MOVER, KILLED);
    (void)state;
    death.hung = true;
    assert_int_equal(verdict_on(&history, death), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, death), VERDICT_RESTART);
    assert_int_equal(verdict_on(&history, death), VERDICT_POISON);
}

static void test_crashes_on_several_frames_poison_none(void **state)
{
    struct history history = {0};
    struct death death = quick(ROLE_COLLIDER, SEGV);
    (void)state;
    for (uint64_t frame = 8; frame < 100; frame++) {
        death.frame = frame;
        assert_int_equal(verdict_on(&history, death), VERDICT_RESTART);
        death.frame_at_start = frame;
    }
}

static void test_kills_from_outside_are_no_crashes(void **state)
{
    struct history history = {0};
    uint64_t delay, before = 0;
    struct death death = quick(ROLE_MOVER, KILLED);
    (void)state;
    for (uint32_t i = 1; i < RESTART_POLICY_QUICK_KILLS; i++) {
        assert_int_equal(restart_policy_death(&history, &death, &delay), VERDICT_RESTART);
        assert_true(delay >= before && delay <= NS_PER_S);
        if (i <= 8)
            assert_int_equal(delay, 0);
        before = delay;
    }
    assert_int_equal(verdict_on(&history, death), VERDICT_GIVE_UP);
}

static void test_work_clears_kills(void **state)
{
    struct history history = {0};
    struct death idle = quick(ROLE_MOVER, KILLED), busy = idle;
    (void)state;
    busy.frame = 8;
    for (uint32_t i = 0; i < 10 * RESTART_POLICY_QUICK_KILLS; i++) {
        assert_int_equal(verdict_on(&history, idle), VERDICT_RESTART);
        assert_int_equal(verdict_on(&history, busy), VERDICT_RESTART);
    }
    struct death renderer = quick(ROLE_RENDERER, KILLED);
    renderer.was_ready = true;
    history = (struct history){0};
    for (uint32_t i = 0; i < 10 * RESTART_POLICY_QUICK_KILLS; i++)
        assert_int_equal(verdict_on(&history, renderer), VERDICT_RESTART);
}

/* A role outside the frame loop dies in each way, again and again: the pause doubles up to its
 * limit, and the set goes on. */
static void test_other_roles_are_restarted_for_ever(void **state)
{
    static const enum role roles[] = {ROLE_REPORTER, ROLE_RECORDER, ROLE_RENDERER};
    static const int statuses[] = {SEGV, EXIT_REFUSED, EXIT_USAGE, KILLED, EXIT_OK};
    (void)state;
    for (size_t i = 0; i < sizeof roles / sizeof roles[0]; i++) {
        for (size_t k = 0; k < sizeof statuses / sizeof statuses[0]; k++) {
            struct history history = {0};
            struct death death = quick(roles[i], statuses[k]);
            uint64_t delay = 0, before = 0;
            for (uint32_t deaths = 0; deaths < 100000; deaths++) {
                death.frame += 10;
                assert_int_equal(restart_policy_death(&history, &death, &delay), VERDICT_RESTART);
                assert_true(delay <= RESTART_POLICY_PAUSE_MAX_NS &&
                            delay <= 5 * (uint64_t)NS_PER_S);
                assert_true(before == 0 || delay == 2 * before ||
                            delay == RESTART_POLICY_PAUSE_MAX_NS);
                before = delay;
            }
            assert_int_equal(delay, RESTART_POLICY_PAUSE_MAX_NS);
        }
    }
}

/* A role that is ready only for a moment each time makes no progress, but its first restart costs
 * no pause. */
static void test_the_first_crash_costs_no_pause(void **state)
{
    struct history history = {0};
    struct death death = quick(ROLE_RENDERER, SEGV);
    uint64_t delay;
    (void)state;
    death.was_ready = true;
    for (uint32_t i = 1; i < 5; i++) {
        assert_int_equal(restart_policy_death(&history, &death, &delay), VERDICT_RESTART);
        assert_int_equal(delay > 0, i > 1);
    }
}

/* A stand-by process that cannot start, or dies every time, does not end a set that goes on. */
static void test_stand_by_death_does_not_end_the_set(void **state)
{
    static const int statuses[] = {EXIT_REFUSED, SEGV, KILLED, EXIT_USAGE};
    struct history history = {0};
    uint64_t delay = 0;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct death death = quick(ROLE_COLLIDER, statuses[i % 4]);
        death.stood_by = true;
        assert_int_equal(restart_policy_death(&history, &death, &delay), VERDICT_RESTART);
    }
    assert_int_equal(delay, NS_PER_S);
    assert_int_equal(history.same_frame, 0);
}

static void test_long_life_clears_crashes(void **state)
{
    struct history history = {0};
    struct death death = quick(ROLE_REPORTER, SEGV);
    uint64_t delay;
    (void)state;
    death.lived_ns = 60 * (uint64_t)NS_PER_S;
    death.was_ready = true;
    for (uint32_t i = 0; i < 100; i++) {
        assert_int_equal(restart_policy_death(&history, &death, &delay), VERDICT_RESTART);
        assert_int_equal(delay, 0);
    }
    death.was_ready = false; /* the failure only took long */
    (void)restart_policy_death(&history, &death, &delay);
    assert_true(delay > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_end_of_the_run_is_no_death),
        cmocka_unit_test(test_role_stopped_from_outside_is_restarted),
        cmocka_unit_test(test_only_a_frame_role_that_refuses_ends_the_set),
        cmocka_unit_test(test_three_crashes_on_a_frame_poison_it),
        cmocka_unit_test(test_three_hangs_on_a_frame_poison_it),
        cmocka_unit_test(test_crashes_on_several_frames_poison_none),
        cmocka_unit_test(test_kills_from_outside_are_no_crashes),
        cmocka_unit_test(test_work_clears_kills),
        cmocka_unit_test(test_other_roles_are_restarted_for_ever),
        cmocka_unit_test(test_the_first_crash_costs_no_pause),
        cmocka_unit_test(test_stand_by_death_does_not_end_the_set),
        cmocka_unit_test(test_long_life_clears_crashes),
    };
    return cmocka_run_group_tests_name("judge", tests, NULL, NULL);
}
