/* Vehicles of other simulators at other time scales than 1: their owners tell motion by the clock,
 * and the world has it by simulated time. */
#include "gateway/pdu/timestamp.h"
#include "tests/unit/gateway/remote_stage.h"

static void set_scale(double to)
{
    struct command scale = {.type = COMMAND_SCALE, .value = {to}};
    assert_int_equal(steps_command(&f, scale).result, COMMAND_DONE);
}

/* What is told by the clock is by simulated time in the ring, as far as the world takes it. A pause
 * keeps the scale. */
static void test_motion_at_other_time_scales(void **state)
{
    static const struct {
        double scale, velocity, acceleration, rates;
    } cases[] = {{2.0, 150.0, 22.5, 5.0}, {0.25, 1200.0, 1440.0, 40.0}, {0.02, 1e4, 1e4, 100.0}};
    (void)state;
    for (uint16_t i = 0; i < 3; i++) {
        struct pdu pdu = state_of(5 + i, (struct vec3){25100.0, 900.0, 24900.0});
        set_scale(cases[i].scale);
        steps_command(&f, (struct command){.type = i == 0 ? COMMAND_PAUSE : COMMAND_RESUME});
        pass(0.1);
        pdu.entity_state.dead_reckoning = DEAD_RECKONING_RVB;
        pdu.entity_state.velocity[0] = 300.0f;
        pdu.entity_state.acceleration[1] = 90.0f;
        pdu.entity_state.angular_velocity[2] = 10.0f;
        take(&pdu, &peer);
        remote_input_tell(&input, &f.view, now_ns);
        struct remote_record track = last_record();
        assert_true(fabs(length_of(track.velocity) / cases[i].velocity - 1.0) < 1e-5);
        assert_true(fabs(length_of(track.acceleration) / cases[i].acceleration - 1.0) < 1e-5);
        assert_true(fabs(length_of(track.rates) / cases[i].rates - 1.0) < 1e-5);
        pass(0.1);
        assert_int_equal(fixture_event(&f, EVENT_INPUT, i)->input.refused, 0);
    }
}

/* What the world knows already goes on by the clock, from the frame on in which the scale changes.
 * What stands, and our own vehicles, are not touched. */
static void test_a_change_of_the_time_scale(void **state)
{
    (void)state;
    for (uint16_t i = 0; i < 2; i++) {
        struct pdu pdu = state_of(5 + i, (struct vec3){25100.0, 900.0, 24900.0 + 100.0 * i});
        pdu.entity_state.dead_reckoning = i == 0 ? DEAD_RECKONING_RVW : DEAD_RECKONING_STATIC;
        vec3_to_floats(pdu.entity_state.velocity,
                       rotation_apply(&frame.axes, (struct vec3){30.0, 0.0, 0.0}));
        pdu.entity_state.angular_velocity[2] = 0.5f;
        take(&pdu, &peer);
    }
    pass(0.2);
    struct entities e = steps_rows(&f);
    uint32_t row = row_of(5), stands = row_of(6);
    e.row[row].climb = 8.0f; /* the acceleration, east */
    double spin = e.row[row].spin_y, velocity = e.row[row].vx;
    assert_true(fabs(velocity - 30.0) < 1e-3 && fabs(spin) > 0.1);
    set_scale(4.0);
    e = steps_rows(&f);
    double gain = 8.0 / 16.0 / 60.0;
    assert_true(fabs(e.row[row].vx - velocity / 4.0 - gain) < 1e-4);
    assert_true(fabs(e.row[row].spin_y - spin / 4.0) < 1e-6);
    assert_true(fabs((double)e.row[row].climb - 0.5) < 1e-6);
    assert_true(e.row[stands].vx == 0.0 && e.row[stands].spin_y == 0.0);
    set_scale(1.0);
    e = steps_rows(&f);
    assert_true(fabs(e.row[row].vx - velocity) < 0.2 && fabs(e.row[row].spin_y - spin) < 1e-6);
    set_scale(0.01); /* absurd speeds are cut off, as those that are told */
    e = steps_rows(&f);
    assert_true(fabs(e.row[row].vx - 3000.0) < 200.0);
    assert_true(fabs((double)e.row[row].climb) <= 1e4 + 1.0);
}

/* What the gateway has told before it saw the new scale is told again. */
static void test_told_while_the_scale_changes(void **state)
{
    struct pdu pdu = state_of(5, (struct vec3){25100.0, 900.0, 24900.0});
    (void)state;
    pdu.entity_state.dead_reckoning = DEAD_RECKONING_FPW;
    vec3_to_floats(pdu.entity_state.velocity,
                   rotation_apply(&frame.axes, (struct vec3){30.0, 0.0, 0.0}));
    take(&pdu, &peer);
    pass(0.2);
    pass(0.2);
    uint64_t tracks = input.tracks;
    set_scale(2.0);
    take(&pdu, &peer); /* a copy: nothing is new */
    pdu.header.timestamp = timestamp_of(1.0, false);
    take(&pdu, &peer);
    remote_input_tell(&input, &f.view, now_ns);
    assert_int_equal(input.tracks, tracks + 1);
    assert_true(fabs(length_of(last_record().velocity) - 30.0) < 1e-3); /* by the old scale */
    pass(0.2);
    assert_int_equal(input.tracks, tracks + 2);
    assert_true(fabs(length_of(last_record().velocity) - 15.0) < 1e-3);
    assert_true(fabs(steps_rows(&f).row[row_of(5)].vx - 15.0) < 1e-3);
    pass(0.2); /* once is enough */
    assert_int_equal(input.tracks, tracks + 2);
}

#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_world, close_world, &f)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_motion_at_other_time_scales),
        TEST(test_a_change_of_the_time_scale),
        TEST(test_told_while_the_scale_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
