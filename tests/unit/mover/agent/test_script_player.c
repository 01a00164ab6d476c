/* Scripts: every step, by the clock and in sequence; interruptions; repetition. */
#include "mover/agent/script_player.h"

#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define HZ 60

static struct fixture f;

/* A world of one vehicle of this kind in slot 0 with a script of these steps, at (25000, 25000),
 * heading north, and a truck "T" 500 m north of it. */
static void open_script(const char *kind, const char *head, const char *steps)
{
    char text[4096];
    snprintf(text, sizeof text,
             "scripts = ( { name = \"s\"; %s steps = ( %s ); } );\n"
             "vehicles = ( { kind = \"%s\"; force = \"blue\"; at = [25000.0, 25000.0]; heading_deg "
             "= 0.0; script = \"s\"; }, { kind = \"truck\"; name = \"T\"; at = [25000.0, 24500.0]; "
             "force = \"red\"; behaviour = \"hold\"; speed_mps = 0.0; } );",
             head, steps, kind);
    fixture_open(&f, text);
}

static const struct entities *now(void)
{
    static struct state state;
    state = fixture_state(&f);
    return &state.entities;
}

static void run_s(double seconds)
{
    fixture_run(&f, (uint32_t)(seconds * HZ + 0.5));
}

static double off(double x, double z)
{
    const struct entities *e = now();
    return sqrt((e->row[0].x - x) * (e->row[0].x - x) + (e->row[0].z - z) * (e->row[0].z - z));
}

static double speed(void)
{
    const struct entities *e = now();
    return sqrt(e->row[0].vx * e->row[0].vx + e->row[0].vz * e->row[0].vz);
}

static void check_step(uint32_t step)
{
    assert_int_equal(now()->row[0].leg, step);
}

/* Events of agents with this reason so far. */
static uint32_t said(enum agent_reason reason)
{
    uint32_t count = 0, all = fixture_event_count(&f, EVENT_AGENT);
    for (uint32_t i = 0; i < all; i++)
        count += fixture_event(&f, EVENT_AGENT, i)->agent.because == reason;
    return count;
}

/* It is there at its time, within the path of a frame, for every kind and point. */
static void test_it_arrives_at_its_time(void **state)
{
    static const char *const kinds[] = {"tank", "jeep", "truck", "helicopter"};
    (void)state;
    uint64_t seed = fixture_seed(12);
    for (int round = 0; round < 12; round++) {
        const char *kind = kinds[round % 4];
        char steps[512];
        double angle = fixture_uniform(&seed, 0.0, TWO_PI), sine, cosine, t[3], x[3], z[3];
        double at = 0.0, east = 25000.0, south = 25000.0;
        for (int i = 0; i < 3; i++) { /* bends of up to a right angle, at most 60 % of full speed */
            double metres = fixture_uniform(&seed, 120.0, 400.0);
            angle += i > 0 ? fixture_uniform(&seed, -HALF_PI, HALF_PI) : 0.0;
            maths_sincos(angle, &sine, &cosine);
            at += 12.0 + metres / fixture_uniform(&seed, 4.0, 9.0);
            t[i] = at;
            x[i] = east += metres * sine;
            z[i] = south -= metres * cosine;
        }
        snprintf(steps, sizeof steps,
                 "{ at_s = %.4f; arrive = [%.3f, %.3f]; }, { at_s = %.4f; arrive = [%.3f, %.3f]; },"
                 "{ at_s = %.4f; arrive = [%.3f, %.3f]; }",
                 t[0], x[0], z[0], t[1], x[1], z[1], t[2], x[2], z[2]);
        open_script(kind, "", steps);
        uint32_t frame = 0;
        for (int i = 0; i < 3; i++) {
            uint32_t due = (uint32_t)(t[i] * HZ + 0.5);
            fixture_run(&f, due - frame);
            frame = due;
            if (!(off(x[i], z[i]) < speed() / HZ + 1.5))
                fail_msg("round %d: a %s is %.2f m off its point %d at %.2f s, at %.2f m/s", round,
                         kind, off(x[i], z[i]), i, t[i], speed());
        }
        run_s(2.0); /* nothing after it: it stands there */
        assert_true(off(x[2], z[2]) < 3.0);
        assert_true(speed() < 0.1);
        assert_int_equal(said(REASON_ARRIVED), 3);
        assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_IDLE);
        fixture_close(&f);
    }
}

/* It has to speed up and to flare on the way; the mean is up to 37.5 m/s, near what it can do. */
static void test_a_helicopter_arrives_from_afar_at_its_time(void **state)
{
    (void)state;
    for (double metres = 800.0; metres <= 1500.0; metres += 350.0) {
        char steps[96];
        snprintf(steps, sizeof steps, "{ at_s = 40.0; arrive = [25000.0, %.1f]; }",
                 25000.0 - metres);
        open_script("helicopter", "", steps);
        run_s(40.0);
        print_message("from %.0f m: %.2f m off after 40 s\n", metres,
                      off(25000.0, 25000.0 - metres));
        assert_true(off(25000.0, 25000.0 - metres) < speed() / HZ + 1.5);
        fixture_close(&f);
    }
}

/* It flies through a point on its way to the next, at up to 15 m/s: a quarter of a second before
 * its time it is up to 4 m off, and at its time it is there. */
static void test_a_helicopter_flies_through_its_point_at_its_time(void **state)
{
    (void)state;
    for (double metres = 200.0; metres <= 600.0; metres += 200.0) {
        char steps[160];
        snprintf(steps, sizeof steps,
                 "{ at_s = 40.0; arrive = [25000.0, %.1f]; }, { at_s = 80.0; arrive = [25300.0, "
                 "%.1f]; }",
                 25000.0 - metres, 25000.0 - metres);
        open_script("helicopter", "", steps);
        run_s(40.0);
        print_message("from %.0f m: %.2f m off after 40 s, at %.1f m/s\n", metres,
                      off(25000.0, 25000.0 - metres), speed());
        assert_true(off(25000.0, 25000.0 - metres) < 0.3);
        assert_true(speed() > 3.0);
        fixture_close(&f);
    }
}

static void test_one_step_follows_the_other(void **state)
{
    (void)state;
    open_script("tank", "",
                "{ go = [25000.0, 24900.0]; speed_mps = 8.0; }, { face_deg = 90.0; }, "
                "{ wait_s = 2.0; }, { stop = true; }, { go = [25060.0, 24900.0]; }");
    run_s(10.0);
    check_step(0);
    assert_true(fabs(speed() - 8.0) < 0.5);
    run_s(8.0);
    assert_true(off(25000.0, 24900.0) < 3.0);
    run_s(30.0);
    assert_true(off(25060.0, 24900.0) < 3.0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.1);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_IDLE);
    assert_int_equal(now()->row[0].order, BEHAVIOUR_IDLE);
    assert_int_equal(said(REASON_ARRIVED), 2);
    assert_int_equal(said(REASON_SCRIPT), 0); /* the last arrival says it */
    fixture_close(&f);
}

/* A wait lasts as long as it says, to the frame. */
static void test_a_wait_lasts_as_long_as_it_says(void **state)
{
    (void)state;
    open_script(
        "tank", "",
        "{ wait_s = 2.0; }, { at_s = 5.0; wait_s = 1.0; }, { after_s = 3.0; stop = true; }");
    run_s(2.0 - 1.0 / HZ);
    check_step(0);
    run_s(3.0 / HZ);
    check_step(1);
    run_s(3.9);
    check_step(1);
    run_s(0.2);
    check_step(2);
    run_s(2.7);
    check_step(2);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_SCRIPT);
    run_s(0.5);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_IDLE);
    fixture_close(&f);
}

/* The first frame that a step acts in begins at its time, and the last one ends when it is over, at
 * any rate. */
static void test_a_step_acts_from_its_time_on_at_any_rate(void **state)
{
    static const char *const worlds[] = {"", "world = { hz = 10; };", "world = { hz = 20; };"};
    static const uint32_t hz[] = {60, 10, 20};
    (void)state;
    for (int n = 0; n < 3; n++) {
        char text[512];
        snprintf(text, sizeof text,
                 "%s scripts = ( { name = \"s\"; steps = ( { at_s = 0.4; throttle = 1.0; for_s = "
                 "0.6; }, { at_s = 2.0; wait_s = 1.0; } ); } );\n"
                 "vehicles = ( { kind = \"jeep\"; at = [25000.0, 25000.0]; script = \"s\"; } );",
                 worlds[n]);
        fixture_open(&f, text);
        fixture_run(&f, 2 * hz[n] / 5);
        assert_true(now()->row[0].throttle == 0.0f && speed() == 0.0);
        fixture_run(&f, 1);
        assert_true(now()->row[0].throttle == 1.0f && speed() > 0.0);
        fixture_run(&f, 3 * hz[n] / 5 - 1);
        assert_true(now()->row[0].throttle == 1.0f);
        fixture_run(&f, 1);
        assert_true(now()->row[0].throttle == 0.0f);
        fixture_close(&f);
    }
}

/* A step with a time begins at it, even if those before it have not ended. */
static void test_a_time_cuts_off_the_steps_before_it(void **state)
{
    (void)state;
    open_script("tank", "",
                "{ go = [25000.0, 20000.0]; }, { wait_s = 100.0; }, { at_s = 4.0; face_deg = 90.0; "
                "}, { wait_s = 1.0; }");
    run_s(4.0 - 2.0 / HZ);
    check_step(0);
    assert_true(speed() > 5.0);
    run_s(4.0 / HZ);
    check_step(2);
    run_s(8.0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.05);
    fixture_close(&f);
}

static void test_shots_are_fired_at_vehicles_and_points(void **state)
{
    (void)state;
    open_script(
        "tank", "",
        "{ at_s = 1.0; fire = \"T\"; }, { fire_at = [25000.0, 24800.0]; }, { stop = true; }");
    run_s(0.9);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    run_s(3.0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 1);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.target.id, 2);
    run_s(10.0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 1)->fire.target.id, 0);
    uint32_t last = fixture_event_count(&f, EVENT_DETONATION) - 1;
    const struct event *struck = fixture_event(&f, EVENT_DETONATION, last);
    assert_true(fabs(struck->detonation.point[0] - 25000.0) < 5.0);
    assert_true(fabs(struck->detonation.point[2] - 24800.0) < 40.0);
    fixture_close(&f);
}

/* Without a turret the hull aims: it turns there from wherever it looks. */
static void test_who_aims_with_the_hull_turns_it(void **state)
{
    (void)state;
    open_script("helicopter", "",
                "{ altitude_m = 40.0; }, { face_deg = 200.0; }, { fire = \"T\"; }, "
                "{ fire_at = [25400.0, 25000.0]; }, { stop = true; }");
    run_s(40.0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.target.id, 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 1)->fire.target.id, 0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.1);
    fixture_close(&f);
}

static void test_controls_are_held_for_their_time(void **state)
{
    (void)state;
    open_script("jeep", "", "{ throttle = 0.5; steer = 0.0; for_s = 4.0; }, { stop = true; }");
    run_s(3.9);
    assert_true(speed() > 3.0);
    run_s(8.0);
    assert_true(speed() < 0.1);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_IDLE);
    assert_true(now()->row[0].throttle == 0.0f);
    fixture_close(&f);
}

/* Its way through the water is lost slowly and gained slowly: it is not stuck meanwhile. */
static void test_a_ship_goes_astern_for_its_script(void **state)
{
    (void)state;
    open_script("jeep", "",
                "{ throttle = 1.0; for_s = 20.0; }, { throttle = -1.0; for_s = 80.0; }");
    steps_cover(&f, COVER_LAKE, 20000.0, 20000.0, 30000.0, 24900.0);
    uint32_t ship = fixture_put(
        &f, (struct fixture_entity){.kind = "ship", .at = {23000.0, FIXTURE_GROUND_M, 23000.0}});
    struct entities e = steps_rows(&f);
    e.row[ship].behaviour = e.row[ship].order = BEHAVIOUR_SCRIPT;
    e.row[ship].order_arg = e.row[0].order_arg;
    run_s(20.0);
    assert_true(now()->row[ship].vz < -5.0);
    run_s(75.0);
    print_message("a ship with its throttle at -1 for 75 s goes astern with %.1f m/s\n",
                  now()->row[ship].vz);
    assert_true(now()->row[ship].vz > 5.0);
    assert_int_equal(now()->row[ship].behaviour, BEHAVIOUR_SCRIPT);
    fixture_close(&f);
}

static void test_aircraft_keep_the_height_of_their_steps(void **state)
{
    (void)state;
    open_script("helicopter", "",
                "{ altitude_m = 60.0; }, { go = [25000.0, 24400.0]; }, { go = [25000.0, 24000.0]; "
                "altitude_m = 90.0; }, { wait_s = 60.0; }");
    run_s(9.0);
    assert_true(fabs(now()->row[0].y - FIXTURE_GROUND_M - 60.0) < 5.0);
    run_s(30.0);
    assert_true(fabs(now()->row[0].y - FIXTURE_GROUND_M - 90.0) < 5.0);
    fixture_close(&f);
}

/* At 3 m the nose of a helicopter touched the ground as it leaned, and it stood there for ever. A
 * lower height than these is refused. */
static void test_helicopters_fly_at_their_least_height(void **state)
{
    static const char *const kinds[] = {"helicopter", "helo-cow"};
    static const double least_m[] = {3.7, 2.7};
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[1024];
        snprintf(
            text, sizeof text,
            "collision = { shape = \"model\"; };\n"
            "scripts = ( { name = \"s\"; steps = ( { go = [25000.0, 24600.0]; altitude_m = %.1f; "
            "}, { go = [25300.0, 24700.0]; }, { face_deg = 90.0; }, { go = [25200.0, 24700.0]; "
            "speed_mps = 10.0; }, { wait_s = 5.0; }, { go = [25100.0, 25000.0]; speed_mps = "
            "50.0; }, { go = [25100.0, 25600.0]; }, { stop = true; } ); } );\n"
            "vehicles = ( { kind = \"%s\"; at = [25000.0, 25000.0]; altitude_m = 20.0; "
            "heading_deg = 180.0; script = \"s\"; } );",
            least_m[k], kinds[k]);
        fixture_open(&f, text);
        for (int second = 0; second < 240 && steps_rows(&f).row[0].order != BEHAVIOUR_IDLE;
             second++) {
            fixture_run(&f, HZ);
            assert_false(steps_rows(&f).row[0].flags & ENTITY_FLAG_LANDED);
            assert_int_equal(steps_rows(&f).row[0].damage, DAMAGE_NONE);
        }
        assert_int_equal(steps_rows(&f).row[0].order, BEHAVIOUR_IDLE);
        assert_int_equal(steps_rows(&f).row[0].leg, 7);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        fixture_close(&f);
    }
}

static void test_a_step_gives_it_back_to_its_agent(void **state)
{
    (void)state;
    open_script("tank", "", "{ wait_s = 1.0; }, { behaviour = \"patrol\"; }");
    run_s(1.2);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_PATROL);
    assert_int_equal(now()->row[0].order, BEHAVIOUR_PATROL);
    assert_int_equal(now()->row[0].order_arg, 0);
    assert_int_equal(said(REASON_SCRIPT), 1);
    run_s(10.0);
    assert_true(speed() > 1.0);
    fixture_close(&f);
}

/* By the clock a pass begins at the last time of the one before; else after the last step. */
static void test_scripts_repeat(void **state)
{
    (void)state;
    open_script(
        "tank", "repeat = true;",
        "{ at_s = 0.0; face_deg = 90.0; }, { at_s = 20.0; face_deg = 270.0; }, { at_s = 40.0; "
        "stop = true; }");
    run_s(19.0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.05);
    run_s(20.0);
    assert_true(fabs(now()->row[0].heading - 3.0 * HALF_PI) < 0.05);
    run_s(20.0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.05);
    run_s(200.0);
    assert_true(fabs(now()->row[0].heading - HALF_PI) < 0.05);
    assert_int_equal(now()->row[0].leg / 3, 6);
    fixture_close(&f);
    open_script("tank", "repeat = true;", "{ wait_s = 1.0; }, { face_deg = 0.0; }");
    run_s(10.0);
    assert_true(now()->row[0].leg / 2 >= 8 && now()->row[0].leg / 2 <= 10);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_SCRIPT);
    fixture_close(&f);
}

/* Shot at, it keeps to its script; with react it fights and then goes on. */
static void test_it_reacts_only_when_it_shall(void **state)
{
    (void)state;
    for (int reacts = 0; reacts < 2; reacts++) {
        open_script("tank", reacts ? "react = true;" : "", "{ go = [25000.0, 20000.0]; }");
        run_s(2.0);
        struct state state_now = fixture_state(&f);
        for (int shot = 0; shot < 20; shot++) {
            state_now = fixture_state(&f);
            state_now.entities.row[0].threat_slot = 1;
            state_now.entities.row[0].threat_id = 2;
            fixture_run(&f, 2);
        }
        assert_int_equal(said(REASON_FIRED_UPON), reacts);
        assert_int_equal(now()->row[0].order, BEHAVIOUR_SCRIPT);
        fixture_close(&f);
    }
}

/* A player has it for 20 s; released, it goes where the clock says it should be going. */
static void test_it_goes_on_by_the_clock_after_an_interruption(void **state)
{
    (void)state;
    open_script("tank", "",
                "{ at_s = 20.0; arrive = [25000.0, 24800.0]; }, { at_s = 35.0; arrive = [25100.0, "
                "24800.0]; }, { at_s = 68.0; arrive = [25100.0, 24600.0]; }, { wait_s = 1000.0; }");
    run_s(10.0);
    struct state state_now = fixture_state(&f);
    state_now.entities.row[0].behaviour = BEHAVIOUR_DRIVEN;
    state_now.entities.row[0].driver = 99;
    state_now.entities.row[0].throttle = 0.0f;
    state_now.entities.row[0].until_tick = 36 * HZ; /* a lease */
    run_s(27.0);
    assert_int_equal(now()->row[0].behaviour, BEHAVIOUR_SCRIPT);
    check_step(1);
    run_s(68.0 - 37.0);
    assert_true(off(25100.0, 24600.0) < speed() / HZ + 1.5);
    run_s(5.0);
    check_step(3);
    fixture_close(&f);
}

/* Several with one script: each at its own place off the first. */
static void test_several_keep_their_places(void **state)
{
    (void)state;
    fixture_open(&f, "scripts = ( { name = \"s\"; steps = ( { at_s = 60.0; arrive = [25000.0, "
                     "24700.0]; } ); } );\nvehicles = ( { kind = \"jeep\"; count = 5; area = "
                     "[24950.0, 24950.0, 25050.0, 25050.0]; script = \"s\"; } );");
    double x[5], z[5];
    assert_int_equal(f.view.world.counts.scripts, 5);
    for (int i = 0; i < 5; i++) {
        x[i] = now()->row[i].x - now()->row[0].x;
        z[i] = now()->row[i].z - now()->row[0].z;
    }
    run_s(60.0);
    for (int i = 0; i < 5; i++) {
        double dx = now()->row[i].x - 25000.0 - x[i], dz = now()->row[i].z - 24700.0 - z[i];
        if (!(sqrt(dx * dx + dz * dz) < 2.0))
            fail_msg("jeep %d is %.2f m off its place", i, sqrt(dx * dx + dz * dz));
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_arrives_at_its_time),
        cmocka_unit_test(test_a_helicopter_arrives_from_afar_at_its_time),
        cmocka_unit_test(test_a_helicopter_flies_through_its_point_at_its_time),
        cmocka_unit_test(test_one_step_follows_the_other),
        cmocka_unit_test(test_a_wait_lasts_as_long_as_it_says),
        cmocka_unit_test(test_a_step_acts_from_its_time_on_at_any_rate),
        cmocka_unit_test(test_a_time_cuts_off_the_steps_before_it),
        cmocka_unit_test(test_shots_are_fired_at_vehicles_and_points),
        cmocka_unit_test(test_who_aims_with_the_hull_turns_it),
        cmocka_unit_test(test_controls_are_held_for_their_time),
        cmocka_unit_test(test_a_ship_goes_astern_for_its_script),
        cmocka_unit_test(test_aircraft_keep_the_height_of_their_steps),
        cmocka_unit_test(test_helicopters_fly_at_their_least_height),
        cmocka_unit_test(test_a_step_gives_it_back_to_its_agent),
        cmocka_unit_test(test_scripts_repeat),
        cmocka_unit_test(test_it_reacts_only_when_it_shall),
        cmocka_unit_test(test_it_goes_on_by_the_clock_after_an_interruption),
        cmocka_unit_test(test_several_keep_their_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
