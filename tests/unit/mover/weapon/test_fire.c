/* Shots: aim, dispersion, reloading, rounds, and what happens when there is no room. */
#include "mover/weapon/fire.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, struct vec3 velocity)
{
    return fixture_put(&f, (struct fixture_entity){
                               .kind = kind, .at = {x, FIXTURE_GROUND_M, z}, .velocity = velocity});
}

static enum command_result fire(uint32_t shooter, uint32_t target)
{
    struct entities e = steps_rows(&f);
    if (target != SLOT_NONE)
        steps_aim(&f, shooter, target);
    return (enum command_result)steps_command(
               &f, (struct command){.type = COMMAND_FIRE,
                                    .entity = e.row[shooter].id,
                                    .target = target == SLOT_NONE ? 0 : e.row[target].id})
        .result;
}

/* --- aim ---------------------------------------------------------------------------------------*/

/* Fires one round without dispersion at a tank that drives by; true when the round strikes it. */
static bool strikes(const char *shooter_kind, const char *round, double distance, double course)
{
    fixture_close(&f);
    fixture_open(&f, "");
    steps_kind(&f, round)->dispersion_rad = 0.0;
    double sine = maths_sin(course), cosine = maths_cos(course);
    uint32_t shooter = put(shooter_kind, 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t target =
        put("tank", 25000.0 + distance, 25000.0, (struct vec3){16.67 * sine, 0.0, -16.67 * cosine});
    assert_int_equal(fire(shooter, target), COMMAND_DONE);
    fixture_run(&f, 240);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    return event->detonation.struck == STRUCK_VEHICLE &&
           event->detonation.struck_party.id == target + 1;
}

static void test_aim_leads_a_moving_target_on_level_ground(void **state)
{
    (void)state;
    for (double distance = 200.0; distance <= 2400.0; distance += 550.0) {
        for (int course = 0; course < 8; course++)
            assert_true(strikes("tank", "shell", distance, course * PI / 4.0));
    }
    for (double distance = 200.0; distance <= 1200.0; distance += 250.0)
        assert_true(strikes("jeep", "bullet", distance, HALF_PI));
}

static void check_dispersion(double speed_mps, double error_rad)
{
    double sum[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
    int shots = 400;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 2048; };");
    struct kind *kind = steps_kind(&f, "shell"), *tank = steps_kind(&f, "tank");
    kind->dispersion_rad = 0.02;
    kind->dispersion_moving_rad = 0.05;
    kind->life_s = 600.0;
    tank->reload_s = 0.0;
    tank->rounds = 1000;
    uint32_t shooter = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                               .at = {25000.0, 5000.0, 25000.0},
                                                               .velocity = {0.0, 0.0, -speed_mps}});
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    for (int n = 0; n < shots; n++) {
        assert_true(fire_shoot(&context, shooter, SLOT_NONE, KIND_NONE));
        const struct entities *m = &f.view.m.entities;
        uint32_t row = (uint32_t)(1 + n);
        double angle[2] = {maths_wrap_half(m->row[row].heading), m->row[row].pitch};
        for (int i = 0; i < 2; i++) {
            sum[i] += angle[i];
            square[i] += angle[i] * angle[i];
        }
    }
    for (int i = 0; i < 2; i++) {
        double mean = sum[i] / shots, deviation = sqrt(square[i] / shots - mean * mean);
        assert_true(fabs(mean) < 4.0 * error_rad / sqrt(shots));
        assert_true(fabs(deviation - error_rad) < 0.15 * error_rad);
    }
}

static void test_dispersion_is_the_kinds_standard_error(void **state)
{
    double top = steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    check_dispersion(0.0, 0.02);
    check_dispersion(0.25 * top, 0.035);
    check_dispersion(0.5 * top, 0.05);
    check_dispersion(top, 0.05);
}

static void test_a_round_starts_clear_of_its_shooter(void **state)
{
    uint32_t shooter = put("tank", 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t target = put("jeep", 25000.0, 25800.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    assert_int_equal(fire(shooter, target), COMMAND_DONE);
    struct entities e = steps_rows(&f);
    const struct event *event = fixture_event(&f, EVENT_FIRE, 0);
    uint32_t round = 2;
    const struct kind *heat = steps_kind(&f, "heat"); /* a jeep has thin armour */
    double reach = steps_kind(&f, "tank")->radius_m + heat->radius_m;
    assert_int_equal(e.row[round].behaviour, BEHAVIOUR_FLIGHT);
    assert_true(vec3_length(vec3_sub(entities_position(&e, round),
                                     entities_position(&e, shooter))) > reach);
    assert_true(fabs(steps_speed(&f, round) - heat->max_speed_mps) < 1e-6);
    assert_int_equal(e.row[round].kind, fixture_kind(&f, "heat"));
    assert_int_equal(e.row[round].owner_id, e.row[shooter].id);
    assert_int_equal(e.row[round].target_id, e.row[target].id);
    assert_int_equal(event->fire.shooter.id, e.row[shooter].id);
    assert_int_equal(event->fire.target.id, e.row[target].id);
    assert_int_equal(event->fire.munition.id, e.row[round].id);
    assert_true(event->fire.point[2] == e.row[round].z);
    assert_int_equal(fixture_state(&f).head->tally.fires, 1);
}

static void test_without_a_target_it_fires_ahead(void **state)
{
    uint32_t shooter = put("tank", 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    steps_rows(&f).row[shooter].heading = 2.0;
    steps_kind(&f, "shell")->dispersion_rad = 0.0;
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_DONE);
    assert_true(fabs(steps_rows(&f).row[1].heading - 2.0) < 1e-12);
    assert_true(fabs(steps_rows(&f).row[1].pitch) < 1e-12);
}

/* --- supply ------------------------------------------------------------------------------------*/

static void test_reloading_takes_its_time_and_rounds_run_out(void **state)
{
    uint32_t shooter = put("tank", 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t reload = (uint32_t)(steps_kind(&f, "tank")->reload_s * 60.0);
    (void)state;
    steps_rows(&f).row[shooter].rounds = 2;
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_DONE);
    assert_int_equal(steps_rows(&f).row[shooter].rounds, 1);
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_CANNOT);
    fixture_run(&f, reload - 3); /* two frames of it went by with the commands */
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_CANNOT);
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_DONE);
    assert_int_equal(steps_rows(&f).row[shooter].rounds, 0);
    fixture_run(&f, reload);
    assert_int_equal(fire(shooter, SLOT_NONE), COMMAND_CANNOT);
    assert_int_equal(fixture_state(&f).head->tally.fires, 2);
}

static void test_a_wreck_and_the_unarmed_cannot_fire(void **state)
{
    uint32_t truck = put("truck", 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    uint32_t wreck = put("tank", 25100.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    steps_rows(&f).row[wreck].state = ENTITY_WRECK;
    assert_int_equal(fire(truck, SLOT_NONE), COMMAND_CANNOT);
    assert_int_equal(fire(wreck, SLOT_NONE), COMMAND_CANNOT);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
}

static void test_a_full_table_refuses_a_shot_and_changes_nothing(void **state)
{
    struct step_context step;
    struct serial_context context;
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 16; };");
    for (uint32_t n = 0; n < 16; n++)
        put("tank", 24000.0 + 50.0 * n, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    steps_serial_context(&f, &step, &context);
    uint64_t before = steps_moved_hash(&f);
    assert_false(fire_shoot(&context, 3, 4, KIND_NONE));
    assert_int_equal(f.view.m.head->tally.spawns_refused, 1);
    f.view.m.head->tally.spawns_refused = 0; /* the count is all that it leaves */
    assert_true(steps_moved_hash(&f) == before);
    assert_false(fire_drop_bomb(&context, fixture_kind(&f, "bomb"), 25000.0, 25000.0));
    f.view.m.head->tally.spawns_refused = 0;
    assert_true(steps_moved_hash(&f) == before);
}

static void test_a_frame_full_of_intents_refuses_a_shot_and_changes_nothing(void **state)
{
    uint32_t shooter = put("tank", 25000.0, 25000.0, (struct vec3){0.0, 0.0, 0.0});
    struct step_context step;
    struct serial_context context;
    (void)state;
    steps_serial_context(&f, &step, &context);
    f.view.m.head->intent_count = f.view.world.params->intents_per_frame;
    uint64_t before = steps_moved_hash(&f);
    assert_false(fire_shoot(&context, shooter, SLOT_NONE, KIND_NONE));
    assert_false(fire_drop_bomb(&context, fixture_kind(&f, "bomb"), 25000.0, 25000.0));
    assert_true(steps_moved_hash(&f) == before);
}

static void test_a_drop_falls_straight_onto_its_point(void **state)
{
    (void)state;
    struct event_command answer =
        steps_command(&f, (struct command){.type = COMMAND_FIRE,
                                           .kind = fixture_kind(&f, "artillery"),
                                           .value = {25040.0, 25050.0}});
    assert_int_equal(answer.result, COMMAND_DONE);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.shooter.id, 0);
    fixture_run(&f, 120);
    const struct event *event = fixture_event(&f, EVENT_DETONATION, 0);
    assert_non_null(event);
    assert_int_equal(event->detonation.struck, STRUCK_GROUND);
    assert_true(event->detonation.point[0] == 25040.0 && event->detonation.point[2] == 25050.0);
    assert_true(fabs(event->detonation.point[1] - FIXTURE_GROUND_M) < 1e-9);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_aim_leads_a_moving_target_on_level_ground),
        TEST(test_dispersion_is_the_kinds_standard_error),
        TEST(test_a_round_starts_clear_of_its_shooter),
        TEST(test_without_a_target_it_fires_ahead),
        TEST(test_reloading_takes_its_time_and_rounds_run_out),
        TEST(test_a_wreck_and_the_unarmed_cannot_fire),
        TEST(test_a_full_table_refuses_a_shot_and_changes_nothing),
        TEST(test_a_frame_full_of_intents_refuses_a_shot_and_changes_nothing),
        TEST(test_a_drop_falls_straight_onto_its_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
