/* The manners of fighting: jets' passes, helicopters' ambushes, air defence, and firing positions.
 */
#include "mover/agent/attack.h"

#include "mover/agent/goal.h"
#include "mover/agent/target_search.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ   20
#define JETS 8u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 256; hz = 20.0; };");
    return 0;
}

static void attack(uint32_t row, uint32_t target)
{
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_ATTACK;
    steps_target(&f, row, target);
    e.row[row].goal_x = e.row[target].x;
    e.row[row].goal_z = e.row[target].z;
    e.row[row].until_tick = (uint32_t)(fixture_state(&f).head->tick + 300 * HZ);
}

/* --- jets --------------------------------------------------------------------------------------*/

/* Eight jets at 1 to 8 km from their targets, on all headings. */
static void put_jets(uint32_t *jet, uint32_t *target)
{
    for (uint32_t n = 0; n < JETS; n++) {
        double x = 8000.0 + 12000.0 * (n % 4), z = 15000.0 + 20000.0 * (double)(n / 4);
        target[n] = steps_put(&f, "truck", (struct vec3){x, 100.0, z}, FORCE_RED, BEHAVIOUR_HOLD);
        jet[n] = steps_put(&f, "jet", (struct vec3){x, 500.0, z - 1000.0 * (n + 1)}, FORCE_BLUE,
                           BEHAVIOUR_IDLE);
        struct entities e = steps_rows(&f);
        e.row[jet[n]].heading = (double)n * TWO_PI / JETS;
        e.row[jet[n]].vx = 250.0 * sin(e.row[jet[n]].heading);
        e.row[jet[n]].vz = -250.0 * cos(e.row[jet[n]].heading);
        attack(jet[n], target[n]);
    }
}

static void test_jets_that_attack_fire_within_a_minute(void **state)
{
    uint32_t jet[JETS], target[JETS], fired = 0;
    (void)state;
    put_jets(jet, target);
    fixture_run(&f, 60 * HZ);
    for (uint32_t n = 0; n < JETS; n++)
        fired += steps_rows(&f).row[jet[n]].rounds < steps_kind(&f, "jet")->rounds;
    if (fired < 7)
        fail_msg("%u of 8 jets fired", fired);
}

static void test_a_jet_extends_after_its_shot_and_flies_home_after_two(void **state)
{
    uint32_t jet[JETS], target[JETS];
    double farthest = 0.0;
    (void)state;
    steps_kind(&f, "truck")->resistance_j = 1e12;
    steps_kind(&f, "truck")->mass_kg = 1e12;
    put_jets(jet, target);
    uint32_t full = steps_kind(&f, "jet")->rounds;
    for (int frame = 0; frame < 180 * HZ && steps_rows(&f).row[jet[0]].rounds > full - 2; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        double away =
            hypot(e.row[jet[0]].x - e.row[target[0]].x, e.row[jet[0]].z - e.row[target[0]].z);
        if (e.row[jet[0]].rounds == full - 1)
            farthest = maths_max(farthest, away);
    }
    fixture_run(&f, 2);
    assert_true(farthest > 3500.0);
    assert_int_equal(steps_rows(&f).row[jet[0]].rounds, full - 2);
    assert_int_equal(steps_rows(&f).row[jet[0]].behaviour, BEHAVIOUR_WITHDRAW);
}

/* --- helicopters -------------------------------------------------------------------------------*/

static void test_a_helicopter_changes_sides_low_and_fires_from_above(void **state)
{
    uint32_t target =
        steps_put(&f, "truck", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = steps_put(&f, "helicopter", (struct vec3){25000.0, 145.0, 26500.0}, FORCE_BLUE,
                             BEHAVIOUR_IDLE);
    double low = INFINITY, fired_low = INFINITY;
    (void)state;
    steps_kind(&f, "truck")->resistance_j = 1e12;
    steps_kind(&f, "truck")->mass_kg = 1e12;
    attack(row, target);
    for (uint32_t frame = 0, fires = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        double height = steps_rows(&f).row[row].y - FIXTURE_GROUND_M;
        if (frame > 10 * HZ)
            low = maths_min(low, height);
        if (fixture_event_count(&f, EVENT_FIRE) > fires && frame > 10 * HZ)
            fired_low = maths_min(fired_low, height);
        fires = fixture_event_count(&f, EVENT_FIRE);
    }
    double usual = steps_kind(&f, "helicopter")->cruise_altitude_m;
    assert_true(low < 0.75 * usual);
    assert_true(fired_low < INFINITY && fired_low > low);
}

/* It comes at 70 m/s and hovers at 0.45 of its range, 1,125 m from its target. It flew on to 830.
 */
static void test_a_helicopter_stops_where_it_hovers(void **state)
{
    uint32_t target =
        steps_put(&f, "truck", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = steps_put(&f, "helicopter", (struct vec3){25000.0, 145.0, 28500.0}, FORCE_BLUE,
                             BEHAVIOUR_IDLE);
    double away = INFINITY, fastest = 0.0;
    (void)state;
    steps_kind(&f, "truck")->resistance_j = 1e12;
    steps_kind(&f, "truck")->mass_kg = 1e12;
    attack(row, target);
    for (uint32_t frame = 0; frame < 120 * HZ; frame++) {
        fixture_run(&f, 1);
        const struct vec3 off = vec3_sub(steps_position(&f, row), steps_position(&f, target));
        away = sqrt(off.x * off.x + off.z * off.z);
        fastest = maths_max(fastest, steps_speed(&f, row));
        if (fastest > 50.0 && steps_speed(&f, row) < 2.0)
            break;
    }
    print_message("stops %.0f m from its target after %.0f m/s\n", away, fastest);
    assert_true(fastest > 50.0 && away > 1050.0 && away < 1200.0);
}

/* The gun reaches 1,600 m, rockets reach 2,500. After twelve the helicopter flies home. */
static void test_a_helicopter_stays_out_of_reach_of_air_defence(void **state)
{
    uint32_t flak =
        steps_put(&f, "flak", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_IDLE);
    uint32_t row = steps_put(&f, "helicopter", (struct vec3){25000.0, 145.0, 27400.0}, FORCE_BLUE,
                             BEHAVIOUR_IDLE);
    double nearest = INFINITY;
    (void)state;
    steps_rows(&f).row[flak].flags = ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND;
    steps_kind(&f, "flak")->resistance_j = 1e12;
    steps_kind(&f, "flak")->mass_kg = 1e12;
    attack(row, flak);
    for (uint32_t frame = 0; frame < 80 * HZ && fixture_event_count(&f, EVENT_FIRE) < 10; frame++) {
        fixture_run(&f, 1);
        nearest = maths_min(
            nearest, vec3_length(vec3_sub(steps_position(&f, row), steps_position(&f, flak))));
    }
    print_message("10 rockets from %.0f m or further\n", nearest);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 10);
    for (uint32_t n = 0; n < 10; n++)
        assert_int_equal(fixture_event(&f, EVENT_FIRE, n)->fire.shooter.id, row + 1);
    assert_true(nearest > steps_kind(&f, "flak")->range_m);
}

/* --- air defence -------------------------------------------------------------------------------*/

static uint32_t flak_fires(const char *kind, double height, double distance)
{
    steps_empty(&f);
    uint32_t row =
        steps_put(&f, "flak", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_put(&f, kind, (struct vec3){25000.0, 100.0 + height, 25000.0 - distance}, FORCE_RED,
              BEHAVIOUR_HOLD);
    steps_rows(&f).row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
    fixture_run(&f, 60 * HZ);
    return fixture_event_count(&f, EVENT_FIRE);
}

static void test_flak_fires_at_aircraft_and_near_ground_targets(void **state)
{
    (void)state;
    steps_kind(&f, "helicopter")->resistance_j = 1e12;
    assert_true(flak_fires("helicopter", 60.0, 1200.0) > 3);
    assert_int_equal(flak_fires("helicopter", 60.0, 2500.0), 0);
    assert_int_equal(flak_fires("truck", 0.0, 1200.0), 0);
    assert_true(flak_fires("truck", 0.0, 400.0) > 0);
}

static void test_aircraft_evade_flak(void **state)
{
    static const char *const kinds[] = {"helicopter", "jet"};
    (void)state;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        steps_kind(&f, kinds[n])->courage = 1.0;
        uint32_t flak = steps_put(&f, "flak", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED,
                                  BEHAVIOUR_HOLD);
        uint32_t row = steps_put(&f, kinds[n], (struct vec3){25000.0, 500.0, 26000.0}, FORCE_BLUE,
                                 BEHAVIOUR_IDLE);
        struct entities e = steps_rows(&f);
        e.row[row].threat_slot = flak;
        e.row[row].threat_id = e.row[flak].id;
        fixture_run(&f, 1);
        assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_FLEE);
        const struct event *event = fixture_event(&f, EVENT_AGENT, 0);
        assert_int_equal(event->agent.because, REASON_SUPPRESSED);
    }
}

/* --- suppression and positions -----------------------------------------------------------------*/

/* Returns the seconds that a tank in a duel holds its fire after a burst beside it. */
static double silent_s(uint32_t seed)
{
    steps_empty(&f);
    steps_params(&f)->seed = seed;
    steps_kind(&f, "tank")->courage = 1.0;
    uint32_t target =
        steps_put(&f, "truck", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25800.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    attack(row, target);
    steps_rows(&f).row[row].flags = ENTITY_FLAG_STAND | ENTITY_FLAG_BURST;
    steps_rows(&f).row[row].reload_tick = HZ; /* its agent decides first */
    for (int frame = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        assert_false(steps_rows(&f).row[row].flags & ENTITY_FLAG_BURST && frame > 2);
        if (fixture_event_count(&f, EVENT_FIRE) > 0)
            return (double)frame / HZ;
    }
    return INFINITY;
}

static void test_a_burst_silences_a_crew_for_ten_to_thirty_seconds(void **state)
{
    double least = INFINITY, most = 0.0;
    (void)state;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        double time_s = silent_s(seed);
        least = maths_min(least, time_s);
        most = maths_max(most, time_s);
    }
    if (least < 10.0 || most > 34.0 || most < 20.0)
        fail_msg("from %g to %g s", least, most);
}

static void test_a_tank_fires_two_to_four_rounds_and_moves(void **state)
{
    uint32_t target =
        steps_put(&f, "ship", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25800.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t fired = 0, moves = 0;
    enum behaviour before = BEHAVIOUR_ATTACK;
    (void)state;
    steps_kind(&f, "ship")->resistance_j = 1e12;
    steps_kind(&f, "ship")->mass_kg = 1e12;
    attack(row, target);
    for (int frame = 0; frame < 120 * HZ; frame++) {
        fixture_run(&f, 1);
        enum behaviour now = (enum behaviour)steps_rows(&f).row[row].behaviour;
        if (now == BEHAVIOUR_REPOSITION && before != now) {
            uint32_t rounds = fixture_event_count(&f, EVENT_FIRE);
            assert_in_range(rounds - fired, 2, 4);
            fired = rounds;
            moves++;
        }
        before = now;
    }
    assert_true(moves >= 3);
}

/* A ridge of 2 m along x = 25000. */
static double ridge(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 100.0 + (fabs(x - 25000.0) < 60.0 ? 2.0 : 0.0);
}

static void test_a_position_behind_a_crest_hides_the_hull(void **state)
{
    struct step_context step;
    struct serial_context context;
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    uint32_t enemy =
        steps_put(&f, "tank", (struct vec3){25600.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 102.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_rows(&f).row[row].heading = HALF_PI;
    steps_serial_context(&f, &step, &context);
    goal_position(&step, row, enemy);
    struct vec3 at = {step.m->row[row].goal_x, 0.0, step.m->row[row].goal_z};
    double height = steps_kind(&f, "tank")->height_m, ground = steps_ground_at(&f, at.x, at.z);
    struct vec3 eye = target_search_eye(&step, enemy);
    assert_true(hypot(at.x - 25000.0, at.z - 25000.0) < 91.0);
    at.y = ground + 0.4 * height;
    assert_false(line_of_sight_clear(step.line_of_sight, eye, at));
    at.y = ground + 0.9 * height;
    assert_true(line_of_sight_clear(step.line_of_sight, eye, at));
}

/* --- first threatened --------------------------------------------------------------------------*/

/* A brave tank that carries out its order is fired upon. Returns what it does. */
static enum behaviour fired_upon(uint32_t *row, uint32_t *enemy)
{
    steps_kind(&f, "tank")->courage = 1.0;
    *enemy =
        steps_put(&f, "tank", (struct vec3){25600.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    *row = steps_put(&f, "tank",
                     (struct vec3){25000.0, steps_ground_at(&f, 25000.0, 25000.0), 25000.0},
                     FORCE_BLUE, BEHAVIOUR_IDLE);
    struct entities e = steps_rows(&f);
    e.row[*row].heading = HALF_PI;
    e.row[*row].threat_slot = *enemy;
    e.row[*row].threat_id = e.row[*enemy].id;
    fixture_run(&f, 1);
    return (enum behaviour)steps_rows(&f).row[*row].behaviour;
}

/* Returns true if the ground hides the hull of a row from another, and not its gun. */
static bool hull_hidden(uint32_t row, uint32_t enemy)
{
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    struct vec3 eye = target_search_eye(&step, enemy), at = entities_position(step.m, row);
    double height = steps_kind(&f, "tank")->height_m, ground = steps_ground_at(&f, at.x, at.z);
    at.y = ground + 0.4 * height;
    bool hull = line_of_sight_clear(step.line_of_sight, eye, at);
    at.y = ground + 0.9 * height;
    return !hull && line_of_sight_clear(step.line_of_sight, eye, at);
}

static void test_first_fired_upon_a_crew_fights_from_cover_that_is_near(void **state)
{
    uint32_t row, enemy;
    (void)state;
    assert_int_equal(fired_upon(&row, &enemy), BEHAVIOUR_ATTACK); /* nothing hides it */
    fixture_close(&f);
    open_world(NULL);
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    assert_int_equal(fired_upon(&row, &enemy), BEHAVIOUR_REPOSITION);
    assert_int_equal(steps_rows(&f).row[row].target_id, steps_rows(&f).row[enemy].id);
    assert_true(steps_rows(&f).row[row].owner_slot != 0); /* behind its smoke */
    fixture_run(&f, 20 * HZ);
    struct entities e = steps_rows(&f);
    assert_int_equal(e.row[row].behaviour, BEHAVIOUR_ATTACK);
    assert_int_equal(e.row[row].target_id, e.row[enemy].id);
    print_message("it fights %.0f m away at %.1f m/s: %s\n",
                  hypot(e.row[row].x - 25000.0, e.row[row].z - 25000.0),
                  hypot(e.row[row].vx, e.row[row].vz),
                  hull_hidden(row, enemy) ? "hull down" : "open");
    assert_true(hull_hidden(row, enemy));
}

/* It is hull down, and the target is further away than it usually fights. */
static void test_a_crew_does_not_leave_a_place_that_hides_its_hull(void **state)
{
    struct step_context step;
    struct serial_context context;
    double far = 0.8 * steps_kind(&f, "tank")->range_m;
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    uint32_t enemy = steps_put(&f, "tank", (struct vec3){25000.0 + far, 100.0, 25000.0}, FORCE_RED,
                               BEHAVIOUR_HOLD);
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 102.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_serial_context(&f, &step, &context);
    goal_position(&step, row, enemy);
    struct vec3 at = {step.m->row[row].goal_x, 0.0, step.m->row[row].goal_z};
    at.y = steps_ground_at(&f, at.x, at.z);
    steps_empty(&f);
    enemy = steps_put(&f, "tank", (struct vec3){25000.0 + far, 100.0, 25000.0}, FORCE_RED,
                      BEHAVIOUR_HOLD);
    row = steps_put(&f, "tank", at, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_rows(&f).row[row].heading = HALF_PI;
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_STAND;
    attack(row, enemy);
    assert_true(hull_hidden(row, enemy));
    fixture_run(&f, 5 * HZ);
    struct entities e = steps_rows(&f);
    print_message("target %.0f m away: it has moved %.1f m in 5 s\n", far,
                  hypot(e.row[row].x - at.x, e.row[row].z - at.z));
    assert_true(hypot(e.row[row].x - at.x, e.row[row].z - at.z) < 3.0);
}

static void test_a_crew_that_flees_takes_the_nearest_cover(void **state)
{
    struct step_context step;
    struct serial_context context;
    (void)state;
    steps_ground(&f, ridge, NULL);
    fixture_threads(&f, 1);
    uint32_t enemy =
        steps_put(&f, "tank", (struct vec3){25600.0, 100.0, 25000.0}, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row =
        steps_put(&f, "jeep", (struct vec3){24920.0, 101.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_serial_context(&f, &step, &context);
    goal_cover(&step, row, enemy);
    double away = hypot(step.m->row[row].goal_x - 24920.0, step.m->row[row].goal_z - 25000.0);
    struct vec3 at = {step.m->row[row].goal_x, 0.0, step.m->row[row].goal_z};
    at.y = steps_ground_at(&f, at.x, at.z) + steps_kind(&f, "jeep")->height_m;
    print_message("cover is %.0f m away\n", away);
    assert_true(away < 76.0);
    assert_false(line_of_sight_clear(step.line_of_sight, target_search_eye(&step, enemy), at));
}

/* Bursts keep a crew in cover for its time. */
static void test_another_burst_keeps_a_crew_in_cover(void **state)
{
    (void)state;
    for (int burst = 0; burst < 2; burst++) {
        fixture_close(&f);
        open_world(NULL);
        uint32_t row = steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE,
                                 BEHAVIOUR_FLEE);
        struct entities e = steps_rows(&f);
        e.row[row].order = BEHAVIOUR_IDLE;
        e.row[row].goal_x = e.row[row].x;
        e.row[row].goal_z = e.row[row].z;
        e.row[row].until_tick = (uint32_t)fixture_state(&f).head->tick + HZ;
        e.row[row].flags = burst ? ENTITY_FLAG_BURST : 0;
        fixture_run(&f, 9 * HZ);
        assert_int_equal(steps_rows(&f).row[row].behaviour,
                         burst ? BEHAVIOUR_FLEE : BEHAVIOUR_IDLE);
        fixture_run(&f, 23 * HZ);
        assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_IDLE);
    }
}

/* A carrier whose burst penetrates a tank's side from 800 m on stops within that, and not where
 * half of its range would let it stop. */
static void test_a_carrier_drives_to_where_its_rounds_penetrate(void **state)
{
    (void)state;
    uint32_t row = steps_put(&f, "carrier", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE,
                             BEHAVIOUR_IDLE);
    uint32_t target =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 23950.0}, FORCE_RED, BEHAVIOUR_HOLD);
    for (int frame = 0; frame < 60 * HZ; frame++) {
        attack(row, target);
        steps_rows(&f).row[row].reload_tick =
            UINT32_MAX; /* it does not fire, and does not move after it */
        fixture_run(&f, 1);
    }
    double away = steps_rows(&f).row[row].z - steps_rows(&f).row[target].z;
    print_message("it stops %.0f m away\n", away);
    assert_true(away > 600.0 && away < 800.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_jets_that_attack_fire_within_a_minute),
        TEST(test_a_jet_extends_after_its_shot_and_flies_home_after_two),
        TEST(test_a_helicopter_changes_sides_low_and_fires_from_above),
        TEST(test_a_helicopter_stops_where_it_hovers),
        TEST(test_a_helicopter_stays_out_of_reach_of_air_defence),
        TEST(test_flak_fires_at_aircraft_and_near_ground_targets),
        TEST(test_aircraft_evade_flak),
        TEST(test_a_burst_silences_a_crew_for_ten_to_thirty_seconds),
        TEST(test_a_tank_fires_two_to_four_rounds_and_moves),
        TEST(test_a_position_behind_a_crest_hides_the_hull),
        TEST(test_first_fired_upon_a_crew_fights_from_cover_that_is_near),
        TEST(test_a_crew_does_not_leave_a_place_that_hides_its_hull),
        TEST(test_a_crew_that_flees_takes_the_nearest_cover),
        TEST(test_another_burst_keeps_a_crew_in_cover),
        TEST(test_a_carrier_drives_to_where_its_rounds_penetrate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
