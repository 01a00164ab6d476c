/* Turrets and guns: rates and limits, laying on moving targets, and when an agent fires. */
#include "mover/weapon/turret.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 60.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, enum force force,
                    enum behaviour behaviour)
{
    return steps_put(&f, kind, (struct vec3){x, FIXTURE_GROUND_M, z}, force, behaviour);
}

static void train(uint32_t row, double traverse, double elevate)
{
    struct event_command answer =
        steps_command(&f, (struct command){.type = COMMAND_DRIVE,
                                           .entity = steps_rows(&f).row[row].id,
                                           .value = {0.0, 0.0, 0.0, traverse, elevate}});
    assert_int_equal(answer.result, COMMAND_DONE);
}

/* --- by hand -----------------------------------------------------------------------------------*/

static void test_the_controls_turn_turret_and_gun_at_their_rates(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    train(row, 1.0, -0.5);
    fixture_run(&f, 29);
    struct entities e = steps_rows(&f);
    assert_true(fabs((double)e.row[row].turret - 0.5 * kind->turret_rate_rps) < 1e-5);
    assert_true(fabs((double)e.row[row].gun -
                     maths_max(-0.25 * kind->gun_rate_rps, kind->gun_low_rad)) < 1e-5);
    fixture_run(&f, 600); /* around and around; the gun at its stop */
    e = steps_rows(&f);
    assert_true((double)e.row[row].turret >= -PI - 1e-6 && (double)e.row[row].turret <= PI + 1e-6);
    assert_true(fabs((double)e.row[row].gun - kind->gun_low_rad) < 1e-6);
    float stands = e.row[row].turret;
    train(row, 0.0, 0.0);
    fixture_run(&f, 60);
    assert_true(fabsf(steps_rows(&f).row[row].turret - stands) < 0.02f);
    stands = steps_rows(&f).row[row].turret;
    fixture_run(&f, 60); /* let go it stays where it is */
    assert_true(steps_rows(&f).row[row].turret == stands);
}

static void test_what_has_no_turret_or_gun_turns_none(void **state)
{
    uint32_t jet = put("jet", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t truck = put("truck", 26000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    train(jet, 1.0, 1.0);
    train(truck, 1.0, 1.0);
    fixture_run(&f, 60);
    struct entities e = steps_rows(&f);
    assert_true(e.row[jet].turret == 0.0f && e.row[jet].gun == 0.0f);
    assert_true(e.row[truck].turret == 0.0f && e.row[truck].gun == 0.0f);
}

static void test_the_gunner_keeps_a_drivers_target_until_a_hand_is_on_the_turret(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t target = put("truck", 25000.0, 26000.0, FORCE_RED, BEHAVIOUR_IDLE); /* behind */
    struct command shot = {.type = COMMAND_FIRE, .entity = row + 1, .target = target + 1};
    (void)state;
    train(row, 0.0, 0.0);
    assert_int_equal(steps_command(&f, shot).result, COMMAND_CANNOT);
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(fabs(fabs((double)steps_rows(&f).row[row].turret) - PI) < 0.01);
    assert_int_equal(steps_command(&f, shot).result, COMMAND_DONE);
    train(row, 0.1, 0.0);
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).row[row].target_id, 0);
}

static void test_fired_without_a_target_a_round_goes_where_the_gun_points(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    struct entities e = steps_rows(&f);
    (void)state;
    steps_kind(&f, "shell")->dispersion_rad = 0.0;
    e.row[row].heading = 1.0;
    e.row[row].turret = 0.75f;
    e.row[row].gun = 0.125f;
    e.row[row].behaviour = BEHAVIOUR_DRIVEN;
    assert_int_equal(
        steps_command(&f, (struct command){.type = COMMAND_FIRE, .entity = row + 1}).result,
        COMMAND_DONE);
    e = steps_rows(&f);
    assert_true(fabs(e.row[1].heading - 1.75) < 1e-9 && fabs(e.row[1].pitch - 0.125) < 1e-9);
}

/* --- rates and limits, whatever happens --------------------------------------------------------*/

static void test_no_turret_passes_its_rate_and_no_gun_its_limits(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "helicopter", "attack-tomato"};
    uint64_t random = fixture_seed(77);
    uint32_t row[5], target[3];
    (void)state;
    for (uint32_t n = 0; n < 3; n++)
        target[n] = put("jeep", 25000.0 + 400.0 * n, 25600.0, FORCE_RED, BEHAVIOUR_PATROL);
    for (uint32_t n = 0; n < 5; n++)
        row[n] = put(kinds[n], 24000.0 + 500.0 * n, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
    for (int frame = 0; frame < 1500; frame++) {
        float turret[5], gun[5];
        struct entities e = steps_rows(&f);
        for (uint32_t n = 0; n < 5; n++) {
            if (frame % 50 == 0)
                steps_target(&f, row[n], target[fixture_random(&random) % 3]);
            turret[n] = e.row[row[n]].turret;
            gun[n] = e.row[row[n]].gun;
        }
        fixture_run(&f, 1);
        e = steps_rows(&f);
        for (uint32_t n = 0; n < 5; n++) {
            const struct kind *kind = steps_kind(&f, kinds[n]);
            double turned = maths_wrap_half((double)e.row[row[n]].turret - (double)turret[n]);
            double raised = (double)e.row[row[n]].gun - (double)gun[n];
            assert_true(fabs(turned) <= kind->turret_rate_rps / HZ + 1e-6);
            assert_true(fabs(raised) <= kind->gun_rate_rps / HZ + 1e-6);
            assert_true((double)e.row[row[n]].gun >= kind->gun_low_rad - 1e-6 &&
                        (double)e.row[row[n]].gun <= kind->gun_high_rad + 1e-6);
        }
    }
}

static void test_at_rest_it_goes_back_ahead(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].turret = 1.5f;
    e.row[row].gun = 0.1f;
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(steps_rows(&f).row[row].turret == 0.0f && steps_rows(&f).row[row].gun == 0.0f);
}

/* --- an agent's trigger ------------------------------------------------------------------------*/

/* The frame in which an attacker fires first at something in a direction; 0: in none of so many. */
static uint32_t first_shot(uint32_t row, uint32_t target, uint32_t frames)
{
    steps_target(&f, row, target);
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_ATTACK;
    e.row[row].until_tick = UINT32_MAX;
    for (uint32_t frame = 1; frame <= frames; frame++) {
        fixture_run(&f, 1);
        if (fixture_event_count(&f, EVENT_FIRE) > 0)
            return frame;
    }
    return 0;
}

static void test_an_agent_fires_when_its_gun_bears(void **state)
{
    double rate = steps_kind(&f, "tank")->turret_rate_rps;
    (void)state;
    for (int n = 0; n < 8; n++) {
        double bearing = -PI + 0.05 + n * 0.8;
        fixture_close(&f);
        open_world(NULL);
        uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
        uint32_t target = put("truck", 25000.0 + 800.0 * maths_sin(bearing),
                              25000.0 - 800.0 * maths_cos(bearing), FORCE_RED, BEHAVIOUR_HOLD);
        steps_kind(&f, "tank")->turn_rate_rps = 1e-9; /* the hull stands */
        uint32_t frame = first_shot(row, target, 60 * 6);
        double least = (fabs(bearing) - 0.004) / rate * HZ;
        assert_true(frame >= least && frame <= least + 4.0);
    }
}

static void test_out_of_range_or_below_its_gun_it_holds_its_fire(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t far = put("truck", 25000.0, 25000.0 - steps_kind(&f, "tank")->range_m - 5.0, FORCE_RED,
                       BEHAVIOUR_HOLD);
    (void)state;
    steps_kind(&f, "tank")->max_speed_mps = 1e-9; /* it cannot go nearer */
    assert_int_equal(first_shot(row, far, 300), 0);
    steps_kind(&f, "tank")->gun_high_rad = 0.2;
    uint32_t above = fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                             .at = {25000.0, 700.0, 24000.0},
                                                             .force = FORCE_RED});
    assert_int_equal(first_shot(row, above, 300), 0);
    steps_kind(&f, "tank")->gun_high_rad = 0.8;
    assert_true(first_shot(row, above, 300) > 0);
}

static void test_hold_fire_holds_it(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t target = put("truck", 25000.0, 24300.0, FORCE_RED, BEHAVIOUR_HOLD);
    (void)state;
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_HOLD_FIRE;
    assert_int_equal(first_shot(row, target, 200), 0);
    steps_rows(&f).row[row].flags = 0;
    assert_true(first_shot(row, target, 200) > 0);
}

static void test_it_does_not_fire_through_a_friend(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t target = put("truck", 25000.0, 24300.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t between = put("jeep", 25001.0, 24900.0, FORCE_BLUE, BEHAVIOUR_HOLD);
    (void)state;
    steps_kind(&f, "tank")->max_speed_mps = 1e-9;
    assert_int_equal(first_shot(row, target, 200), 0);
    steps_rows(&f).row[between].x = 25010.0; /* beside it */
    assert_true(first_shot(row, target, 200) > 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_the_controls_turn_turret_and_gun_at_their_rates),
        TEST(test_what_has_no_turret_or_gun_turns_none),
        TEST(test_the_gunner_keeps_a_drivers_target_until_a_hand_is_on_the_turret),
        TEST(test_fired_without_a_target_a_round_goes_where_the_gun_points),
        TEST(test_no_turret_passes_its_rate_and_no_gun_its_limits),
        TEST(test_at_rest_it_goes_back_ahead),
        TEST(test_an_agent_fires_when_its_gun_bears),
        TEST(test_out_of_range_or_below_its_gun_it_holds_its_fire),
        TEST(test_hold_fire_holds_it),
        TEST(test_it_does_not_fire_through_a_friend),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
