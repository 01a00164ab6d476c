/* Perception: enemies in sight, odds, low fuel, and when agents return. */
#include "mover/agent/perception.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ     20.0
#define MIDDLE 25000.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, enum force force,
                    enum behaviour behaviour, uint8_t flags)
{
    const struct vec3 at = {x, steps_ground_at(&f, x, z), z};
    uint32_t row = steps_put(&f, kind, at, force, behaviour);
    struct entities e = steps_rows(&f);
    e.row[row].flags = flags;
    e.row[row].reload_tick = UINT32_MAX;
    return row;
}

static void seconds(double s)
{
    fixture_run(&f, (uint32_t)(s * HZ));
}

static enum behaviour behaviour_of(uint32_t row)
{
    return (enum behaviour)steps_rows(&f).row[row].behaviour;
}

/* The nth change of behaviour of a row is this one. */
static void told(uint32_t row, uint32_t nth, enum behaviour to, enum agent_reason because)
{
    const struct event *event;
    for (uint32_t n = 0; (event = fixture_event(&f, EVENT_AGENT, n)); n++) {
        if (event->agent.agent.id == row + 1 && nth-- == 0) {
            assert_int_equal(event->agent.to, to);
            assert_int_equal(event->agent.because, because);
            return;
        }
    }
    fail_msg("row %u has not changed its mind so often", row);
}

/* --- seeing ------------------------------------------------------------------------------------*/

static double ridge(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 100.0 + (fabs(x - MIDDLE) < 200.0 ? 40.0 : 0.0);
}

/* Does a tank that fires at will attack one on the other side of the middle within two minutes? */
static bool attacks_across(bool hill)
{
    fixture_close(&f);
    open_world(NULL);
    if (hill)
        steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1); /* what it knows of the ground follows from the ground */
    uint32_t row =
        put("tank", MIDDLE - 500.0, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, ENTITY_FLAG_FIRE_AT_WILL);
    put("tank", MIDDLE + 500.0, MIDDLE, FORCE_RED, BEHAVIOUR_HOLD, 0);
    for (int second = 0; second < 120 && behaviour_of(row) != BEHAVIOUR_ATTACK; second++)
        seconds(1.0);
    return behaviour_of(row) == BEHAVIOUR_ATTACK;
}

static void test_row_9_no_agent_sees_through_a_hill(void **state)
{
    (void)state;
    assert_true(attacks_across(false));
    assert_false(attacks_across(true));
}

static void test_row_9_an_agent_shot_at_from_behind_a_hill_does_not_shoot_at_it(void **state)
{
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    steps_kind(&f, "tank")->courage = 1.0;
    uint32_t row = put("tank", MIDDLE - 500.0, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, 0);
    uint32_t enemy = put("tank", MIDDLE + 500.0, MIDDLE, FORCE_RED, BEHAVIOUR_HOLD, 0);
    steps_rows(&f).row[row].heading = HALF_PI;
    steps_rows(&f).row[row].reload_tick = 0;
    steps_threaten(&f, row, enemy);
    seconds(5.0);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    assert_true(steps_speed(&f, row) > 5.0); /* it goes and looks */
}

/* Does a jeep that looks north attack an enemy at this bearing? */
static bool sees_at(double bearing_deg, double turret_deg)
{
    double sine, cosine;
    steps_empty(&f);
    maths_sincos(bearing_deg * RAD_PER_DEG, &sine, &cosine);
    uint32_t row =
        put("jeep", MIDDLE, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, ENTITY_FLAG_FIRE_AT_WILL);
    put("jeep", MIDDLE + 600.0 * sine, MIDDLE - 600.0 * cosine, FORCE_RED, BEHAVIOUR_HOLD, 0);
    for (int frame = 0; frame < (int)(60 * HZ) && behaviour_of(row) != BEHAVIOUR_ATTACK; frame++) {
        steps_rows(&f).row[row].turret = (float)(turret_deg * RAD_PER_DEG);
        fixture_run(&f, 1);
    }
    return behaviour_of(row) == BEHAVIOUR_ATTACK;
}

static void test_row_9_the_field_of_view_goes_with_the_turret(void **state)
{
    (void)state;
    steps_kind(&f, "jeep")->view_rad = 120.0 * RAD_PER_DEG;
    assert_true(sees_at(0.0, 0.0));
    assert_true(sees_at(55.0, 0.0) && sees_at(-55.0, 0.0));
    assert_false(sees_at(65.0, 0.0) || sees_at(-65.0, 0.0) || sees_at(180.0, 0.0));
    assert_true(sees_at(140.0, 90.0));
    assert_false(sees_at(-55.0, 90.0));
    steps_kind(&f, "jeep")->view_rad = TWO_PI;
    assert_true(sees_at(180.0, 0.0));
}

static void test_row_9_one_behind_a_hill_does_not_hide_the_others(void **state)
{
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    uint32_t row = put("tank", MIDDLE - 500.0, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE,
                       ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND);
    for (int n = 0; n < 5; n++) /* nearer than the one that can be seen */
        put("tank", MIDDLE + 300.0, MIDDLE + 40.0 * n, FORCE_RED, BEHAVIOUR_HOLD, 0);
    uint32_t seen = put("tank", MIDDLE - 2000.0, MIDDLE, FORCE_RED, BEHAVIOUR_HOLD, 0);
    for (int second = 0; second < 180 && behaviour_of(row) != BEHAVIOUR_ATTACK; second++)
        seconds(1.0);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    assert_int_equal(steps_rows(&f).row[row].target_slot, seen);
}

/* --- orders and odds ---------------------------------------------------------------------------*/

static void test_row_9_orders_to_stand_and_to_hold_fire(void **state)
{
    (void)state;
    steps_kind(&f, "tank")->courage = 0.0;
    uint32_t enemy = put("tank", MIDDLE, 24000.0, FORCE_RED, BEHAVIOUR_HOLD, 0);
    uint32_t stands = put("tank", MIDDLE, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, ENTITY_FLAG_STAND);
    uint32_t both = put("tank", 25100.0, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE,
                        ENTITY_FLAG_STAND | ENTITY_FLAG_HOLD_FIRE);
    steps_threaten(&f, stands, enemy);
    steps_threaten(&f, both, enemy);
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(stands), BEHAVIOUR_ATTACK);
    assert_int_equal(behaviour_of(both), BEHAVIOUR_IDLE);
}

static void test_row_9_odds_of_one_to_six_are_too_many_for_most(void **state)
{
    int fled = 0;
    (void)state;
    steps_kind(&f, "tank")->courage = 0.8;
    for (int n = 0; n < 4; n++) { /* four fights, far apart */
        double x = 10000.0 + 8000.0 * n;
        uint32_t row = put("tank", x, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, 0), enemy = 0;
        for (int m = 0; m < 6; m++)
            enemy = put("tank", x + 30.0 * m, 24000.0, FORCE_RED, BEHAVIOUR_HOLD, 0);
        steps_threaten(&f, row, enemy);
    }
    seconds(4.0);
    for (uint32_t n = 0; n < 4; n++)
        fled += behaviour_of(7 * n) == BEHAVIOUR_FLEE;
    assert_true(fled >= 3);
}

static void test_row_9_a_fleeing_agent_goes_where_it_is_not_seen(void **state)
{
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    steps_kind(&f, "jeep")->courage = 0.0;
    uint32_t enemy = put("tank", MIDDLE - 900.0, MIDDLE, FORCE_RED, BEHAVIOUR_HOLD, 0);
    uint32_t row = put("jeep", MIDDLE - 260.0, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, 0);
    steps_threaten(&f, row, enemy);
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_FLEE);
    struct entities e = steps_rows(&f);
    struct vec3 eye = {e.row[enemy].x, e.row[enemy].y + 2.0, e.row[enemy].z};
    struct vec3 to = {e.row[row].goal_x,
                      steps_ground_at(&f, e.row[row].goal_x, e.row[row].goal_z) + 1.0,
                      e.row[row].goal_z};
    assert_false(line_of_sight_clear(&f.stepper.mover.line_of_sight, eye, to));
}

/* --- home and back -----------------------------------------------------------------------------*/

static void home_and_back(uint32_t row, enum agent_reason because)
{
    const struct kind *kind = steps_kind(&f, "tank");
    struct force_base *base = &steps_params(&f)->base[FORCE_BLUE];
    seconds(1.1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_WITHDRAW);
    told(row, 0, BEHAVIOUR_WITHDRAW, because);
    seconds(90.0);
    told(row, 1, BEHAVIOUR_RESUPPLY, REASON_ARRIVED);
    told(row, 2, BEHAVIOUR_IDLE, REASON_SUPPLIED);
    struct entities e = steps_rows(&f);
    assert_true(hypot(e.row[row].x - base->x, e.row[row].z - base->z) < 160.0);
    assert_int_equal(e.row[row].rounds, kind->rounds);
    assert_true(e.row[row].fuel_l > 0.99 * kind->fuel_l);
    assert_int_equal(fixture_event_count(&f, EVENT_AGENT), 3);
}

static void test_row_9_an_agent_out_of_rounds_goes_to_its_base_and_returns(void **state)
{
    (void)state;
    steps_params(&f)->base[FORCE_BLUE] = (struct force_base){MIDDLE, 24000.0};
    uint32_t row = put("tank", MIDDLE, 24800.0, FORCE_BLUE, BEHAVIOUR_IDLE, 0);
    steps_rows(&f).row[row].rounds = 0;
    home_and_back(row, REASON_OUT_OF_ROUNDS);
}

static void test_row_9_an_agent_low_on_fuel_goes_to_its_base_and_returns(void **state)
{
    (void)state;
    steps_params(&f)->base[FORCE_BLUE] = (struct force_base){MIDDLE, 24000.0};
    uint32_t row = put("tank", MIDDLE, 24800.0, FORCE_BLUE, BEHAVIOUR_IDLE, 0);
    steps_rows(&f).row[row].fuel_l = 0.031 * steps_kind(&f, "tank")->fuel_l;
    home_and_back(row, REASON_LOW_FUEL);
}

static void test_supplies_come_evenly(void **state)
{
    (void)state;
    uint32_t row = put("tank", MIDDLE, MIDDLE, FORCE_BLUE, BEHAVIOUR_IDLE, 0);
    steps_params(&f)->base[FORCE_BLUE] = (struct force_base){MIDDLE, MIDDLE};
    steps_rows(&f).row[row].rounds = 0;
    seconds(1.5); /* it is there at once */
    uint32_t before = steps_rows(&f).row[row].rounds;
    for (int n = 0; n < 4; n++) {
        seconds(4.0);
        assert_in_range(steps_rows(&f).row[row].rounds - before, 10, 12); /* a fifth of 55 */
        before = steps_rows(&f).row[row].rounds;
    }
    assert_int_equal(behaviour_of(row), BEHAVIOUR_RESUPPLY);
}

static void test_a_turn_is_a_second_or_longer_in_a_crowd(void **state)
{
    (void)state;
    assert_int_equal(perception_think_frames(steps_params(&f), 100), 2);
    assert_int_equal(perception_think_frames(steps_params(&f), 3072 * 12), 12);
    assert_int_equal(perception_look_frames(steps_params(&f), 100), 20);
    assert_int_equal(perception_look_frames(steps_params(&f), 768 * 50), 48);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_9_no_agent_sees_through_a_hill),
        TEST(test_row_9_an_agent_shot_at_from_behind_a_hill_does_not_shoot_at_it),
        TEST(test_row_9_the_field_of_view_goes_with_the_turret),
        TEST(test_row_9_one_behind_a_hill_does_not_hide_the_others),
        TEST(test_row_9_orders_to_stand_and_to_hold_fire),
        TEST(test_row_9_odds_of_one_to_six_are_too_many_for_most),
        TEST(test_row_9_a_fleeing_agent_goes_where_it_is_not_seen),
        TEST(test_row_9_an_agent_out_of_rounds_goes_to_its_base_and_returns),
        TEST(test_row_9_an_agent_low_on_fuel_goes_to_its_base_and_returns),
        TEST(test_supplies_come_evenly),
        TEST(test_a_turn_is_a_second_or_longer_in_a_crowd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
