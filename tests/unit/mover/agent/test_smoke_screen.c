/* Smoke grenades: who fires them, and what they hide for how long. */
#include "mover/agent/smoke_screen.h"

#include "tests/support/steps.h"
#include "world/entity/smoke.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 20

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    fixture_threads(&f, 1);
    return 0;
}

static uint32_t put(const char *kind, double height, double z, enum force force,
                    enum behaviour behaviour)
{
    const struct vec3 at = {25000.0, FIXTURE_GROUND_M + height, z};
    return steps_put(&f, kind, at, force, behaviour);
}

/* Puts a crew without courage that an enemy has fired at. */
static uint32_t put_target(const char *kind, uint32_t enemy)
{
    steps_kind(&f, kind)->courage = 0.0;
    uint32_t row = put(kind, 0.0, 25600.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_threaten(&f, row, enemy);
    fixture_run(&f, 1);
    return row;
}

static bool between(uint32_t a, uint32_t b)
{
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    return smoke_screen_between(&step, a, b);
}

static void test_a_tank_that_flees_is_hidden_for_its_time(void **state)
{
    uint32_t enemy = put("tank", 0.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t above = put("helicopter", 400.0, 25300.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put_target("tank", enemy);
    int first = -1, last = -1;
    (void)state;
    assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_FLEE);
    for (int frame = 0; frame < 20 * HZ; frame++) {
        fixture_run(&f, 1);
        assert_int_equal(between(enemy, row), between(row, enemy));
        assert_false(frame < 15 * HZ && between(above, row));
        if (between(enemy, row)) {
            first = first < 0 ? frame : first;
            last = frame;
        }
    }
    print_message("smoke hides a tank from %.2f to %.2f s after the shot\n", (double)first / HZ,
                  (double)last / HZ);
    assert_true(fabs((double)first / HZ - SMOKE_GROWS_S) < 0.2);
    assert_true(fabs((double)last / HZ - SMOKE_S) < 0.2);
}

static void test_a_gunner_does_not_fire_into_smoke(void **state)
{
    (void)state;
    for (int smoke = 0; smoke < 2; smoke++) {
        steps_empty(&f);
        uint32_t row = put("tank", 0.0, 25600.0, FORCE_BLUE, BEHAVIOUR_HOLD);
        uint32_t gunner = put("tank", 0.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
        uint32_t before = fixture_event_count(&f, EVENT_FIRE);
        fixture_run(&f, 2 * HZ);
        struct entities e = steps_rows(&f);
        uint32_t now = (uint32_t)fixture_state(&f).head->tick;
        e.row[gunner].behaviour = BEHAVIOUR_ATTACK;
        e.row[gunner].heading = PI;
        e.row[gunner].target_slot = row;
        e.row[gunner].target_id = e.row[row].id;
        e.row[gunner].goal_x = e.row[row].x;
        e.row[gunner].goal_z = e.row[row].z;
        e.row[gunner].until_tick = UINT32_MAX;
        e.row[gunner].seen_tick = now - UINT32_MAX / 2;
        if (smoke)
            e.row[row].owner_slot = now - (uint32_t)(SMOKE_GROWS_S * HZ);
        fixture_run(&f, 12 * HZ);
        assert_int_equal(fixture_event_count(&f, EVENT_FIRE) > before, !smoke);
    }
}

static void test_launchers_are_loaded_for_three_minutes(void **state)
{
    uint32_t enemy = put("tank", 0.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put_target("tank", enemy), first = steps_rows(&f).row[row].owner_slot;
    (void)state;
    assert_true(first != 0);
    for (int again = 0; again < 2; again++) {
        fixture_run(&f, (uint32_t)(again ? (SMOKE_AGAIN_S - 20.0) * HZ : 20 * HZ));
        struct entities e = steps_rows(&f);
        e.row[row].behaviour = e.row[row].order = BEHAVIOUR_IDLE;
        steps_threaten(&f, row, enemy);
        fixture_run(&f, 2);
        assert_int_equal(steps_rows(&f).row[row].owner_slot != first, again);
    }
}

static void test_jeeps_and_trucks_have_none(void **state)
{
    uint32_t enemy = put("tank", 0.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    (void)state;
    assert_int_equal(steps_rows(&f).row[put_target("jeep", enemy)].owner_slot, 0);
    assert_int_equal(steps_rows(&f).row[put_target("truck", enemy)].owner_slot, 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_tank_that_flees_is_hidden_for_its_time),
        TEST(test_a_gunner_does_not_fire_into_smoke),
        TEST(test_launchers_are_loaded_for_three_minutes),
        TEST(test_jeeps_and_trucks_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
