/* Vehicles on wheels turn by driving to and fro, never on the spot. */
#include "mover/agent/driving/shunting.h"

#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/entity/kind.h"
#include "world/maths/maths.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define HZ     60
#define TIGHT  1.001 /* of the turn of the tightest circle, for rounding */
#define START  25000.0
#define WHEELS 4u

static const char *const wheels[WHEELS] = {"jeep", "truck", "hamburger", "attack-tomato"};

static struct fixture f;

/* What a vehicle has done. */
struct turned {
    double most_rps;     /* its fastest turn */
    double tightest;     /* its turn over that of its tightest circle, at most, in any frame */
    double farthest_m;   /* from its start */
    double mps;          /* its last speed that was not 0 */
    uint32_t to_and_fro; /* changes between forwards and backwards */
};

static double forward_of(const struct entities *e, uint32_t row)
{
    double sine, cosine;
    maths_sincos(e->row[row].heading, &sine, &cosine);
    return e->row[row].vx * sine - e->row[row].vz * cosine;
}

/* Notes what row 0 has done from one frame to the next. was: where it headed, and its speed. */
static void note(struct turned *turned, const struct kind *kind, double was_rad, double was_mps)
{
    const struct entities e = steps_rows(&f);
    const double rps = fabs(maths_wrap_half(e.row[0].heading - was_rad)) * HZ;
    const double speed = maths_max(fabs(was_mps), fabs(forward_of(&e, 0)));
    const double most = speed / maths_max(kind->least_turn_m, 0.1);
    const double dx = e.row[0].x - START, dz = e.row[0].z - START;
    if (rps > 1e-9)
        turned->tightest = maths_max(turned->tightest, rps / maths_max(most, 1e-12));
    turned->most_rps = maths_max(turned->most_rps, rps);
    turned->farthest_m = maths_max(turned->farthest_m, sqrt(dx * dx + dz * dz));
    turned->to_and_fro += turned->mps * forward_of(&e, 0) < 0.0;
    turned->mps = forward_of(&e, 0) != 0.0 ? forward_of(&e, 0) : turned->mps;
}

/* Runs until the vehicle of row 0 heads for this heading, or for this time. Returns how long [s].
 */
static double run_until(double heading_rad, double most_s, struct turned *turned)
{
    const struct kind *kind = &f.view.world.kinds[steps_rows(&f).row[0].kind];
    uint32_t frames = 0;
    while (frames < (uint32_t)(most_s * HZ) &&
           !(fabs(maths_wrap_half(steps_rows(&f).row[0].heading - heading_rad)) < 0.02)) {
        const struct entities e = steps_rows(&f);
        const double was_rad = e.row[0].heading, was_mps = forward_of(&e, 0);
        fixture_run(&f, 1);
        note(turned, kind, was_rad, was_mps);
        frames++;
    }
    return (double)frames / HZ;
}

static void open_world(const char *kind, const char *steps, const char *others)
{
    char text[2048];
    snprintf(text, sizeof text,
             "scripts = ( { name = \"s\"; steps = ( %s ); } );\n"
             "vehicles = ( { kind = \"%s\"; at = [25000.0, 25000.0]; heading_deg = 0.0; script = "
             "\"s\"; } %s );",
             steps, kind, others);
    fixture_open(&f, text);
}

/* A script that gives a heading alone: wheels get there to and fro, within some metres. */
static void test_wheels_face_a_heading_to_and_fro(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < WHEELS; k++) {
        struct turned turned = {0};
        open_world(wheels[k], "{ wait_s = 1.0; }, { face_deg = 180.0; }, { wait_s = 100.0; }", "");
        double time_s = run_until(PI, 60.0, &turned);
        fixture_run(&f, 5 * HZ);
        print_message("# figures: %s about in %.1f s, %u times to and fro, %.1f m from its place, "
                      "%.3f of its tightest circle\n",
                      wheels[k], time_s, turned.to_and_fro, turned.farthest_m, turned.tightest);
        assert_true(time_s > 2.0 && time_s < 40.0);
        assert_true(turned.tightest > 0.5 && turned.tightest < TIGHT);
        assert_true(turned.to_and_fro >= 2);
        assert_true(turned.farthest_m < 12.0);
        assert_true(fabs(maths_wrap_half(steps_rows(&f).row[0].heading - PI)) < 0.02);
        assert_true(steps_speed(&f, 0) == 0.0);
        fixture_close(&f);
    }
}

static void test_tracks_face_a_heading_on_the_spot(void **state)
{
    static const char *const tracks[] = {"tank", "carrier", "howitzer", "flak"};
    (void)state;
    for (size_t k = 0; k < sizeof tracks / sizeof tracks[0]; k++) {
        struct turned turned = {0};
        open_world(tracks[k], "{ face_deg = 180.0; }, { wait_s = 100.0; }", "");
        assert_true(run_until(PI, 30.0, &turned) < 15.0);
        assert_true(turned.farthest_m == 0.0);
        fixture_close(&f);
    }
}

/* A point beside the vehicle is within its turning circle: it drove around it for ever. */
static void test_wheels_get_to_a_point_beside_them(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < WHEELS; k++) {
        for (double east = -6.0; east < 7.0; east += 4.0) {
            struct turned turned = {0};
            char steps[128];
            snprintf(steps, sizeof steps, "{ go = [%.1f, %.1f]; }, { stop = true; }", START + east,
                     START + 1.0);
            open_world(wheels[k], steps, "");
            (void)run_until(NAN, 40.0, &turned);
            const struct entities e = steps_rows(&f);
            const double dx = e.row[0].x - START - east, dz = e.row[0].z - START - 1.0;
            assert_true(turned.tightest < TIGHT);
            if (e.row[0].behaviour != BEHAVIOUR_IDLE)
                fail_msg("%s is %.1f m off a point %.0f m beside it", wheels[k],
                         sqrt(dx * dx + dz * dz), east);
            fixture_close(&f);
        }
    }
}

/* Before a wall it cannot drive forwards, and its goal is behind. */
static void test_wheels_turn_before_a_wall(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < 2; k++) {
        struct turned turned = {0};
        open_world(wheels[k], "{ go = [25000.0, 25200.0]; }, { stop = true; }",
                   ", { kind = \"tank\"; count = 9; at = [25000.0, 24991.0]; formation = \"line\"; "
                   "spacing_m = 5.0; heading_deg = 0.0; behaviour = \"hold\"; speed_mps = 0.0; }");
        double time_s = run_until(PI, 60.0, &turned);
        fixture_run(&f, 40 * HZ);
        const struct entities e = steps_rows(&f);
        print_message("# figures: %s about before a wall in %.1f s, %u times to and fro\n",
                      wheels[k], time_s, turned.to_and_fro);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        assert_true(turned.tightest < TIGHT && time_s < 40.0);
        assert_int_equal(e.row[0].behaviour, BEHAVIOUR_IDLE);
        assert_true(e.row[0].z > 25195.0);
        fixture_close(&f);
    }
}

/* Five houses on each side of a street to the north, whose walls are this far apart, and a sixth
 * one across its southern end. */
static void open_streets(double width_m, bool closed, const char *vehicles)
{
    char text[4096];
    int length = snprintf(text, sizeof text, "collision = { shape = \"model\"; };\nobjects = (");
    for (int n = 0; n < 10; n++)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "%s{ kind = \"building\"; at = [%.1f, %.1f]; heading_deg = 0.0; }",
                           n > 0 ? "," : "", START + (n % 2 ? 1.0 : -1.0) * (6.6 + 0.5 * width_m),
                           START - 36.0 + 18.0 * (n / 2));
    if (closed)
        length += snprintf(text + length, sizeof text - (size_t)length,
                           ",{ kind = \"building\"; at = [%.1f, %.1f]; heading_deg = 90.0; }",
                           START, START + 36.0 + 15.6);
    snprintf(text + length, sizeof text - (size_t)length, "); %s", vehicles);
    fixture_open(&f, text);
}

/* Returns true if a row gave up its order since it was stuck. */
static bool tells_stuck(uint32_t row)
{
    for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_AGENT); n++) {
        const struct event_agent *agent = &fixture_event(&f, EVENT_AGENT, n)->agent;
        if (agent->agent.id == steps_rows(&f).row[row].id && agent->to == BEHAVIOUR_IDLE &&
            agent->because == REASON_STUCK)
            return true;
    }
    return false;
}

/* One that faces the wrong way in a street gave up after some metres. */
static void test_wheels_get_out_of_streets(void **state)
{
    static const char *const kinds[] = {"jeep", "truck"};
    static const double wide[] = {5.0, 6.0, 8.0, 10.0, 14.0};
    (void)state;
    for (uint32_t n = 0; n < 20; n++) {
        const bool closed = n / 10 != 0;
        char vehicles[256];
        snprintf(vehicles, sizeof vehicles,
                 "vehicles = ( { kind = \"%s\"; at = [%.1f, %.1f]; heading_deg = 180.0; route = "
                 "([%.1f, %.1f], [%.1f, %.1f]); } );",
                 kinds[n % 2], START, START + 24.0, START, START - 200.0, START, START - 400.0);
        open_streets(wide[n / 2 % 5], closed, vehicles);
        double time_s = 0.0, back_mps = 0.0;
        while (time_s < 120.0 && steps_rows(&f).row[0].z > START - 70.0) {
            fixture_run(&f, HZ);
            const struct entities e = steps_rows(&f);
            back_mps = maths_max(back_mps, -forward_of(&e, 0));
            time_s += 1.0;
        }
        print_message("# figures: %s out of a %s of %.0f m after %.0f s, backwards at up to %.1f "
                      "m/s\n",
                      kinds[n % 2], closed ? "dead end" : "street", wide[n / 2 % 5], time_s,
                      back_mps);
        assert_true(time_s < 120.0 && back_mps < 3.1);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        fixture_close(&f);
    }
}

/* A step of a script that gives a heading did not end in alleys. */
static void test_wheels_face_a_heading_in_an_alley(void **state)
{
    static const char *const kinds[] = {"jeep", "truck"};
    static const double wide[] = {8.0, 10.0, 14.0};
    (void)state;
    for (uint32_t n = 0; n < 6; n++) {
        char vehicles[320];
        snprintf(
            vehicles, sizeof vehicles,
            "scripts = ( { name = \"s\"; steps = ( { face_deg = 180.0; }, { face_deg = 85.0; } "
            "); } );\n"
            "vehicles = ( { kind = \"%s\"; at = [%.1f, %.1f]; heading_deg = 0.0; script = "
            "\"s\"; } );",
            kinds[n % 2], START, START + 20.0);
        open_streets(wide[n / 2], true, vehicles);
        double time_s = 0.0;
        for (; time_s < 240.0 && steps_rows(&f).row[0].order != BEHAVIOUR_IDLE; time_s += 1.0)
            fixture_run(&f, HZ);
        print_message("# figures: %s turned twice in an alley of %.0f m in %.0f s\n", kinds[n % 2],
                      wide[n / 2], time_s);
        assert_true(fabs(maths_wrap_half(steps_rows(&f).row[0].heading - 85.0 * RAD_PER_DEG)) <
                    0.02);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
        assert_false(tells_stuck(0));
        fixture_close(&f);
    }
}

/* In a yard of 6 x 17 m a truck cannot turn about, and says so. */
static void test_a_heading_that_is_not_possible_is_told(void **state)
{
    (void)state;
    fixture_open(
        &f, "world = { seed = 2; capacity = 64; };\n"
            "collision = { shape = \"model\"; };\n"
            "objects = ( { kind = \"building\"; at = [24990.4, 25000.0]; heading_deg = 0.0; },"
            "{ kind = \"building\"; at = [25009.6, 25000.0]; heading_deg = 0.0; },"
            "{ kind = \"building\"; at = [25000.0, 24984.4]; heading_deg = 90.0; },"
            "{ kind = \"building\"; at = [25000.0, 25015.6]; heading_deg = 90.0; } );\n"
            "scripts = ( { name = \"s\"; steps = ( { face_deg = 180.0; }, { wait_s = 900.0; } ); } "
            ");\n"
            "vehicles = ( { kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 0.0; script = "
            "\"s\"; } );");
    double time_s = 0.0;
    for (; time_s < 600.0 && !tells_stuck(0); time_s += 1.0)
        fixture_run(&f, HZ);
    print_message("# figures: a truck in a yard gives up after %.0f s\n", time_s);
    assert_true(time_s > 40.0 && time_s < 600.0);
    assert_int_equal(steps_rows(&f).row[0].behaviour, BEHAVIOUR_IDLE);
    fixture_close(&f);
}

/* A truck that turned between tanks 11 m away ran into one of them. */
static void test_it_turns_between_vehicles(void **state)
{
    (void)state;
    fixture_open(
        &f,
        "collision = { shape = \"model\"; };\nscripts = ( { name = \"s\"; steps = ( { face_deg = "
        "180.0; }, { face_deg = 10.0; }, { face_deg = 265.0; } ); } );\n"
        "vehicles = ( { kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 45.0; script = "
        "\"s\"; }, { kind = \"tank\"; at = [25011.0, 25000.0]; heading_deg = 0.0; behaviour = "
        "\"idle\"; }, { kind = \"tank\"; at = [24989.0, 25000.0]; heading_deg = 0.0; behaviour "
        "= \"idle\"; }, { kind = \"tank\"; at = [25000.0, 25011.0]; heading_deg = 90.0; "
        "behaviour = \"idle\"; }, { kind = \"tank\"; at = [25000.0, 24989.0]; heading_deg = "
        "90.0; behaviour = \"idle\"; } );");
    for (int second = 0; second < 120 && steps_rows(&f).row[0].order != BEHAVIOUR_IDLE; second++)
        fixture_run(&f, HZ);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_true(fabs(maths_wrap_half(steps_rows(&f).row[0].heading - 265.0 * RAD_PER_DEG)) < 0.02);
    fixture_close(&f);
}

/* Returns where a row heads, also if it cruises. */
static double heading_of(uint32_t row, double hz)
{
    const struct state state = fixture_state(&f);
    return cruise_heading(&state.entities, row, state.head->tick, 1.0 / hz);
}

/* Also while they cruise, and at any rate, no vehicle on patrol turns tighter than its circle.
 * Those on their springs may be pushed. */
static void test_no_patrol_turns_tighter(void **state)
{
    uint64_t seed = fixture_seed(14);
    (void)state;
    for (int round = 0; round < 4; round++) {
        char text[512];
        double turns = 0.0;
        snprintf(text, sizeof text,
                 "world = { hz = %.1f; cruise = %s; seed = %u; };\n"
                 "vehicles = ( { kind = \"jeep\"; count = 8; area = [24900.0, 24900.0, 25100.0, "
                 "25100.0]; behaviour = \"patrol\"; },"
                 "{ kind = \"truck\"; count = 8; area = [24900.0, 24900.0, 25100.0, 25100.0]; "
                 "behaviour = \"patrol\"; } );",
                 round % 2 ? 10.0 : 60.0, round / 2 ? "true" : "false",
                 (unsigned)(fixture_random(&seed) % 1000));
        fixture_open(&f, text);
        const double hz = round % 2 ? 10.0 : 60.0;
        for (int frame = 0; frame < (int)(60.0 * hz); frame++) {
            double heading[16], speed[16];
            for (uint32_t i = 0; i < 16; i++) {
                heading[i] = heading_of(i, hz);
                speed[i] = vec3_length(steps_velocity(&f, i));
            }
            fixture_run(&f, 1);
            for (uint32_t i = 0; i < 16; i++) {
                const double fast = maths_max(speed[i], vec3_length(steps_velocity(&f, i)));
                const double turn = fabs(maths_wrap_half(heading_of(i, hz) - heading[i])) * hz;
                const double most =
                    fast / f.view.world.kinds[steps_rows(&f).row[i].kind].least_turn_m;
                turns += turn / hz;
                if (!(steps_rows(&f).row[i].flags & ENTITY_FLAG_CHASSIS) &&
                    turn > TIGHT * most + 1e-9)
                    fail_msg("round %d: row %u turns by %.7f of %.7f rad/s at frame %d", round, i,
                             turn, most, frame);
            }
        }
        assert_true(turns > 10.0);
        fixture_close(&f);
    }
}

/* A goal near behind is reached backwards, and then the vehicle goes forwards again, also when it
 * decides only as its stretches begin: half of these went on backwards, for a kilometre. */
static void test_patrols_of_small_areas_stay_there(void **state)
{
    char text[1024] = "world = { cruise = true; };\nvehicles = (";
    size_t length = strlen(text);
    (void)state;
    for (int n = 0; n < 6; n++) {
        int x = 20000 + 500 * n;
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   "%s{ kind = \"%s\"; area = [%d.0, 20000.0, %d.0, 20060.0]; "
                                   "behaviour = \"patrol\"; }",
                                   n > 0 ? "," : "", n % 2 ? "jeep" : "truck", x, x + 60);
    }
    snprintf(text + length, sizeof text - length, ");");
    fixture_open(&f, text);
    fixture_run(&f, 1);
    for (int second = 0; second < 300; second++) {
        fixture_continue(&f, HZ);
        for (uint32_t i = 0; i < 6; i++) {
            const struct vec3 at = steps_position(&f, i);
            const double off_x = at.x - (20030.0 + 500.0 * i), off_z = at.z - 20030.0;
            if (fabs(off_x) > 70.0 || fabs(off_z) > 70.0)
                fail_msg("row %u is %.0f, %.0f m off its area's middle after %d s", i, off_x, off_z,
                         second);
        }
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wheels_face_a_heading_to_and_fro),
        cmocka_unit_test(test_tracks_face_a_heading_on_the_spot),
        cmocka_unit_test(test_wheels_get_to_a_point_beside_them),
        cmocka_unit_test(test_wheels_turn_before_a_wall),
        cmocka_unit_test(test_wheels_get_out_of_streets),
        cmocka_unit_test(test_wheels_face_a_heading_in_an_alley),
        cmocka_unit_test(test_a_heading_that_is_not_possible_is_told),
        cmocka_unit_test(test_it_turns_between_vehicles),
        cmocka_unit_test(test_no_patrol_turns_tighter),
        cmocka_unit_test(test_patrols_of_small_areas_stay_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
