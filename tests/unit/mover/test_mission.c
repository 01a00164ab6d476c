/* Missions: every order, every condition, reactions, objectives, the result, and the next battle.
 */
#include "mover/mission.h"

#include "mover/mission_conditions.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define HZ 60

static struct fixture f;

/* A world with more vehicles before its two tanks and its truck. */
#define WORLD WORLD_OF("")
#define WORLD_OF(more)                                                                             \
    "objectives = ( { name = \"hill\"; area = [25000.0, 25000.0, 25200.0, 25200.0]; force = "      \
    "\"red\"; } );"                                                                                \
    "vehicles = ( " more                                                                           \
    "{ name = \"A\"; kind = \"tank\"; force = \"blue\"; at = [25100.0, 25400.0]; "                 \
    "heading_deg = 0.0; },"                                                                        \
    "{ name = \"B\"; kind = \"tank\"; force = \"blue\"; at = [25160.0, 25400.0]; heading_deg = "   \
    "0.0; },"                                                                                      \
    "{ name = \"R\"; kind = \"truck\"; force = \"red\"; at = [20000.0, 25000.0]; behaviour = "     \
    "\"hold\"; speed_mps = 0.0; } );"

/* Opens a world in which the tanks A and B, 300 m south of the red hill, have these phases, and "m"
 * these other members. */
static void open_mission(const char *group, const char *phases, const char *more)
{
    static char text[4096];
    snprintf(text, sizeof text,
             WORLD "missions = ( { name = \"m\"; vehicles = \"%s\"; phases = ( %s ); %s } );",
             group, phases, more);
    fixture_open(&f, text);
}

static void run_s(double seconds)
{
    fixture_run(&f, (uint32_t)(seconds * HZ + 0.5));
}

static const struct battle_state *battle(void)
{
    return &fixture_state(&f).head->battle;
}

static const struct entities *now(void)
{
    static struct state state;
    state = fixture_state(&f);
    return &state.entities;
}

static void check_phase(uint32_t phase)
{
    assert_int_equal(battle()->mission[0].phase, phase);
}

/* The phase has not ended after `before` seconds, and has ended a second and a half later. */
static void check_ends_at(double before)
{
    run_s(before);
    check_phase(0);
    run_s(1.5);
    check_phase(1);
    fixture_close(&f);
}

#define HOLD_UNTIL(condition)                                                                      \
    "{ name = \"a\"; order = \"hold\"; " condition " }, { name = \"b\"; order = \"hold\"; }"

/* --- conditions --------------------------------------------------------------------------------*/

static void test_time_ends_a_phase(void **state)
{
    (void)state;
    open_mission("A", HOLD_UNTIL("for_s = 5.0;"), "");
    check_ends_at(4.5);
    open_mission("A", HOLD_UNTIL("until_s = 5.0;"), "");
    check_ends_at(4.5);
    open_mission("A", HOLD_UNTIL("for_s = 1.0; at_least_s = 5.0;"), "");
    check_ends_at(4.5);
}

static void test_arrival_ends_a_phase(void **state)
{
    (void)state;
    open_mission("A",
                 "{ name = \"a\"; order = \"move\"; to = [25100.0, 25000.0]; spread_m = 0.0; "
                 "arrived = 1.0; }, { name = \"b\"; order = \"hold\"; }",
                 "");
    run_s(3.0);
    check_phase(0);
    run_s(40.0);
    check_phase(1);
    fixture_close(&f);
}

static void test_objectives_end_a_phase(void **state)
{
    static const char *const conditions[] = {"taken = \"hill\";", "lost = \"hill\";"};
    (void)state;
    for (int lost = 0; lost < 2; lost++) {
        char phases[256];
        snprintf(phases, sizeof phases, HOLD_UNTIL("%s"), conditions[lost]);
        open_mission("A", phases, "");
        run_s(3.0);
        /* Red holds it, so blue has not taken it, and does not hold it. */
        check_phase((uint32_t)lost);
        steps_rows(&f).row[1].z = 25100.0; /* B is on the hill */
        run_s(3.0);
        check_phase(1);
        assert_int_equal(battle()->objective[0].owner, FORCE_BLUE);
        fixture_close(&f);
    }
}

static void test_an_equal_enemy_keeps_an_objective(void **state)
{
    (void)state;
    open_mission("A", HOLD_UNTIL("enemy_in = \"hill\";"), "");
    run_s(2.0);
    check_phase(0);
    const struct entities rows = steps_rows(&f);
    rows.row[2].x = rows.row[0].x = 25100.0;
    rows.row[2].z = 25050.0;
    rows.row[0].z = 25150.0;
    run_s(2.0);
    check_phase(1);
    assert_int_equal(battle()->objective[0].owner, FORCE_RED);
    assert_int_equal(battle()->objective[0].present[FORCE_BLUE], 1);
    assert_int_equal(battle()->objective[0].present[FORCE_RED], 1);
    fixture_close(&f);
}

/* The truck comes onto the hill a second and a half after its stretch of two seconds has begun; its
 * columns are those of the end. */
static void test_who_cruises_counts_where_it_is(void **state)
{
    (void)state;
    open_mission("A", HOLD_UNTIL("enemy_in = \"hill\";"), "");
    fixture_run(&f, 1); /* a body that is new goes by frames if spheres may be in each other */
    const struct entities rows = steps_rows(&f);
    rows.row[2].x = 25010.0;
    rows.row[2].z = 25100.0;
    rows.row[2].heading = HALF_PI;
    rows.row[2].vx = 20.0;
    rows.row[2].cruise_tick = (uint32_t)fixture_state(&f).head->tick + 2 * HZ;
    run_s(1.3);
    assert_true(now()->row[2].cruise_tick > fixture_state(&f).head->tick);
    assert_int_equal(battle()->objective[0].present[FORCE_RED], 0);
    fixture_continue(&f, 2 * HZ);
    assert_int_equal(battle()->objective[0].present[FORCE_RED], 1);
    fixture_close(&f);
}

/* Red holds the hill and nobody is on it. */
static void test_conditions_are_joined(void **state)
{
    static const struct {
        const char *conditions;
        uint32_t phase;
    } cases[] = {
        {"lost = \"hill\"; for_s = 100.0;", 1},
        {"lost = \"hill\"; for_s = 100.0; all = true;", 0},
        {"lost = \"hill\"; for_s = 1.0; all = true;", 1},
        {"lost = \"hill\"; not = \"lost\";", 0},
        {"lost = \"hill\"; for_s = 1.0; all = true; not = \"lost\";", 0},
        {"enemy_in = \"hill\"; not = \"enemy_in\";", 1},
        {"enemy_in = \"hill\"; for_s = 1.0; all = true; not = \"enemy_in\";", 1},
        {"enemy_in = \"hill\"; for_s = 1.0; all = true; not = \"for_s enemy_in\";", 1},
    };
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        char phases[256];
        snprintf(phases, sizeof phases, HOLD_UNTIL("%s"), cases[n].conditions);
        open_mission("A", phases, "");
        run_s(4.0);
        check_phase(cases[n].phase);
        fixture_close(&f);
    }
}

static void test_losses_end_a_phase(void **state)
{
    (void)state;
    fixture_open(&f, WORLD "missions = ( { name = \"m\"; vehicles = \"A\"; phases = ( { name = "
                           "\"a\"; order = \"hold\"; below = 0.6; }, { name = \"b\"; order = "
                           "\"hold\"; } ); } );");
    run_s(3.0);
    check_phase(0);
    steps_rows(&f).row[0].state = ENTITY_WRECK;
    run_s(1.5);
    check_phase(1);
    assert_int_equal(battle()->mission[0].able, 0);
    assert_int_equal(battle()->mission[0].begun, 1);
    fixture_close(&f);
}

static void test_another_mission_ends_a_phase(void **state)
{
    (void)state;
    fixture_open(
        &f,
        WORLD "missions = ( { name = \"m\"; vehicles = \"A\"; phases = ( { name = \"a\"; order = "
              "\"hold\"; after = \"n.x\"; }, { name = \"b\"; order = \"hold\"; } ); },"
              "{ name = \"n\"; vehicles = \"B\"; phases = ( { name = \"x\"; order = \"hold\"; "
              "for_s = 4.0; }, { name = \"y\"; order = \"hold\"; } ); } );");
    run_s(3.5);
    check_phase(0);
    run_s(3.0);
    check_phase(1);
    fixture_close(&f);
}

/* --- orders ------------------------------------------------------------------------------------*/

static void test_a_phase_says_whom_to_fire_at(void **state)
{
    (void)state;
    open_mission("A",
                 "{ name = \"a\"; order = \"hold\"; engage = \"hold\"; for_s = 2.0; }, { name = "
                 "\"b\"; order = \"hold\"; engage = \"free\"; for_s = 2.0; }, { name = \"c\"; "
                 "order = \"hold\"; }",
                 "");
    run_s(1.0);
    assert_int_equal(now()->row[0].flags, ENTITY_FLAG_HOLD_FIRE);
    assert_int_equal(now()->row[1].flags, 0); /* not of the mission */
    run_s(2.5);
    assert_int_equal(now()->row[0].flags, ENTITY_FLAG_FIRE_AT_WILL);
    run_s(3.0);
    assert_int_equal(now()->row[0].flags, 0);
    fixture_close(&f);
}

static void test_orders_that_go_somewhere(void **state)
{
    static const char *const orders[] = {"move", "attack", "defend", "withdraw", "resupply"};
    (void)state;
    for (int i = 0; i < 5; i++) {
        char phases[256];
        snprintf(phases, sizeof phases, "{ name = \"a\"; order = \"%s\"; objective = \"hill\"; }",
                 orders[i]);
        open_mission("A", phases, "");
        run_s(60.0);
        if (!(now()->row[0].x > 24970.0 && now()->row[0].x < 25230.0 && now()->row[0].z > 24970.0 &&
              now()->row[0].z < 25230.0))
            fail_msg("%s: it is at [%.0f, %.0f]", orders[i], now()->row[0].x, now()->row[0].z);
        assert_true(steps_speed(&f, 0) < 0.1);  /* and stays there */
        assert_true(now()->row[1].z > 25390.0); /* the other one has no order */
        fixture_close(&f);
    }
}

/* One of two goes while the other one stands. */
static void test_a_pair_bounds(void **state)
{
    (void)state;
    fixture_open(&f,
                 "vehicles = ( { name = \"T\"; kind = \"tank\"; count = 2; force = \"blue\"; area "
                 "= [25000.0, 25000.0, 25300.0, 25300.0]; } );"
                 "missions = ( { name = \"T\"; phases = ( { name = \"a\"; order = \"bound\"; to = "
                 "[25100.0, 20000.0]; bound_s = 10.0; } ); } );");
    uint32_t moved[2] = {0, 0}, both = 0;
    for (int bound = 0; bound < 4; bound++) {
        run_s(9.0); /* the one that has to stand brakes */
        bool first = steps_speed(&f, 0) > 3.0, second = steps_speed(&f, 1) > 3.0;
        moved[0] += first;
        moved[1] += second;
        both += first && second;
        run_s(1.0);
    }
    assert_int_equal(moved[0], 2);
    assert_int_equal(moved[1], 2);
    assert_int_equal(both, 0);
    fixture_close(&f);
}

static void test_a_patrol_and_a_strike_stay_in_their_area(void **state)
{
    static const char *const orders[] = {"patrol", "strike"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char phases[256];
        snprintf(phases, sizeof phases, "{ name = \"a\"; order = \"%s\"; objective = \"hill\"; }",
                 orders[i]);
        open_mission("A", phases, "");
        run_s(60.0);
        for (int n = 0; n < 20; n++) {
            run_s(2.0);
            assert_true(now()->row[0].z < 25260.0 && now()->row[0].z > 24940.0);
        }
        assert_int_equal(now()->row[0].order, BEHAVIOUR_PATROL);
        fixture_close(&f);
    }
}

/* The hill is 200 m wide; the rounds of a battery and their errors spread further. */
static void check_falls_on_the_hill(uint32_t first, uint32_t end)
{
    for (uint32_t n = first; n < end; n++) {
        const double *at = fixture_event(&f, EVENT_DETONATION, n)->detonation.point;
        double dx = at[0] - 25100.0, dz = at[2] - 25100.0;
        assert_true(dx * dx + dz * dz < 500.0 * 500.0);
    }
}

static void test_a_barrage_falls_on_its_area(void **state)
{
    (void)state;
    fixture_open(
        &f,
        WORLD "missions = ( { name = \"g\"; off_map = true; force = \"blue\"; phases = ( { name "
              "= \"a\"; order = \"barrage\"; objective = \"hill\"; munition = \"artillery\"; "
              "rounds_a_minute = 30.0; for_s = 59.0; }, { name = \"b\"; order = \"hold\"; } ); } "
              ");");
    run_s(20.0); /* volleys of six, one in 12 s */
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 12);
    run_s(50.0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 30);
    uint32_t fell = fixture_event_count(&f, EVENT_DETONATION);
    assert_int_equal(fell, 30);
    check_falls_on_the_hill(0, fell);
    run_s(30.0);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), fell);
    fixture_close(&f);
}

static void test_bombs_fall_one_by_one(void **state)
{
    (void)state;
    fixture_open(
        &f,
        WORLD "missions = ( { name = \"g\"; off_map = true; force = \"blue\"; phases = ( { name "
              "= \"a\"; order = \"barrage\"; objective = \"hill\"; munition = \"bomb\"; "
              "rounds_a_minute = 30.0; for_s = 59.0; }, { name = \"b\"; order = \"hold\"; } ); } "
              ");");
    run_s(29.5);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 15);
    fixture_close(&f);
}

static void test_own_guns_fire_a_barrage(void **state)
{
    (void)state;
    open_mission("A", "{ name = \"a\"; order = \"barrage\"; objective = \"hill\"; }", "");
    run_s(20.0);
    assert_true(fixture_event_count(&f, EVENT_FIRE) >= 2);
    assert_int_equal(fixture_event(&f, EVENT_FIRE, 0)->fire.shooter.id, 1);
    fixture_close(&f);
}

/* Three howitzers 5 km from the hill: a volley is two rounds of each. */
static void test_howitzers_fire_a_barrage_by_missions(void **state)
{
    (void)state;
    fixture_open(
        &f,
        WORLD_OF(
            "{ name = \"G\"; kind = \"howitzer\"; force = \"blue\"; count = 3; area = "
            "[25050.0, 30050.0, 25150.0, 30150.0]; },") "missions = ( { name = \"m\"; vehicles = "
                                                        "\"G\"; phases = ( { name = \"a\"; order "
                                                        "= \"barrage\"; objective = \"hill\"; "
                                                        "rounds_a_minute = 6.0; for_s = 59.0; }, { "
                                                        "name = \"b\"; order = \"hold\"; } ); } "
                                                        ");");
    run_s(5.0);
    assert_int_equal(fixture_state(&f).head->battery_count, 1);
    assert_int_equal(fixture_state(&f).head->battery[0].guns, 3);
    run_s(75.0);
    uint32_t shots = fixture_event_count(&f, EVENT_FIRE);
    assert_int_equal(shots, 6);
    for (uint32_t n = 0; n < shots; n++)
        assert_int_not_equal(fixture_event(&f, EVENT_FIRE, n)->fire.shooter.id, 0);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 6);
    check_falls_on_the_hill(0, 6);
    fixture_close(&f);
}

static void test_supplies_fill_up(void **state)
{
    (void)state;
    open_mission("A", "{ name = \"a\"; order = \"resupply\"; to = [25100.0, 25400.0]; }", "");
    const struct entities rows = steps_rows(&f);
    rows.row[0].rounds = rows.row[1].rounds = 1;
    rows.row[0].fuel_l = 100.0;
    run_s(25.0);
    assert_int_equal(now()->row[0].rounds, steps_kind(&f, "tank")->rounds);
    assert_true(now()->row[0].fuel_l > 0.99 * steps_kind(&f, "tank")->fuel_l);
    assert_int_equal(now()->row[1].rounds, 1);
    fixture_close(&f);
}

/* A vehicle that fights obeys an order to withdraw at once, and other orders afterwards. */
static void test_only_some_orders_end_a_fight(void **state)
{
    static const char *const orders[] = {"withdraw", "move"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char phases[256];
        snprintf(
            phases, sizeof phases,
            "{ name = \"a\"; order = \"hold\"; for_s = 3.0; }, { name = \"b\"; order = \"%s\"; "
            "to = [25100.0, 26000.0]; }",
            orders[i]);
        open_mission("A", phases, "");
        run_s(1.0);
        const struct entities rows = steps_rows(&f);
        rows.row[0].behaviour = BEHAVIOUR_ATTACK;
        rows.row[0].target_slot = 2;
        rows.row[0].target_id = 3;
        rows.row[0].until_tick = 100 * HZ;
        run_s(4.0);
        check_phase(1);
        assert_int_equal(now()->row[0].behaviour, i == 0 ? BEHAVIOUR_ROUTE : BEHAVIOUR_ATTACK);
        assert_int_equal(now()->row[0].order, BEHAVIOUR_ROUTE);
        fixture_close(&f);
    }
}

/* --- reactions and battles ---------------------------------------------------------------------*/

static void test_a_reaction_interrupts_and_resumes(void **state)
{
    (void)state;
    open_mission(
        "A",
        "{ name = \"a\"; order = \"hold\"; for_s = 30.0; }, { name = \"b\"; order = "
        "\"hold\"; }",
        "reactions = ( { name = \"r\"; order = \"move\"; to = [25100.0, 25600.0]; when_s = "
        "3.0; for_s = 5.0; } );");
    run_s(2.5);
    check_phase(0);
    run_s(2.0);
    check_phase(2);
    assert_int_equal(now()->row[0].order, BEHAVIOUR_ROUTE);
    run_s(6.0);
    check_phase(0);
    assert_int_equal(now()->row[0].order, BEHAVIOUR_IDLE);
    run_s(10.0);
    check_phase(0); /* it happens once */
    const struct event *event = fixture_event(&f, EVENT_MISSION, 2);
    assert_int_equal(event->mission.news, MISSION_NEWS_REACTION);
    assert_string_equal(event->mission.phase, "r");
    fixture_close(&f);
}

static void test_the_battle_ends_and_begins_again(void **state)
{
    (void)state;
    fixture_open(&f, "battle = { end_s = 10.0; again_s = 15.0; };" WORLD
                     "missions = ( { name = \"m\"; vehicles = \"A\"; phases = ( { name = \"a\"; "
                     "order = \"hold\"; for_s = 3.0; }, { name = \"b\"; order = \"attack\"; "
                     "objective = \"hill\"; } ); } );");
    run_s(5.0);
    check_phase(1);
    steps_rows(&f).row[1].z = 25100.0; /* B takes the hill */
    steps_rows(&f).row[2].state = ENTITY_WRECK;
    steps_rows(&f).row[0].rounds = steps_rows(&f).row[1].rounds = 2;
    run_s(4.5);
    assert_int_equal(battle()->ended_tick, 0);
    run_s(1.0);
    assert_int_not_equal(battle()->ended_tick, 0);
    assert_int_equal(battle()->winner, FORCE_BLUE);
    uint32_t told = fixture_event_count(&f, EVENT_MISSION);
    const struct event *event = fixture_event(&f, EVENT_MISSION, told - 1);
    assert_int_equal(event->mission.news, MISSION_NEWS_RESULT);
    assert_int_equal(event->mission.held[FORCE_BLUE], 1);
    assert_int_equal(event->mission.lost[FORCE_RED], 1);
    assert_int_equal(event->mission.lost[FORCE_BLUE], 0);
    run_s(5.0);
    assert_int_equal(battle()->round, 2);
    assert_int_equal(battle()->ended_tick, 0);
    assert_int_equal(battle()->begun[FORCE_RED], 0);
    assert_int_equal(now()->row[0].rounds, steps_kind(&f, "tank")->rounds);
    assert_int_equal(now()->row[1].rounds, 2); /* not of a mission */
    check_phase(0);
    fixture_close(&f);
}

static void test_a_world_without_missions_has_no_battle(void **state)
{
    static const struct battle_state none;
    (void)state;
    fixture_open(&f, WORLD);
    run_s(5.0);
    assert_memory_equal(battle(), &none, sizeof none);
    assert_int_equal(fixture_event_count(&f, EVENT_MISSION), 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_time_ends_a_phase),
        cmocka_unit_test(test_arrival_ends_a_phase),
        cmocka_unit_test(test_objectives_end_a_phase),
        cmocka_unit_test(test_an_equal_enemy_keeps_an_objective),
        cmocka_unit_test(test_who_cruises_counts_where_it_is),
        cmocka_unit_test(test_losses_end_a_phase),
        cmocka_unit_test(test_another_mission_ends_a_phase),
        cmocka_unit_test(test_a_phase_says_whom_to_fire_at),
        cmocka_unit_test(test_orders_that_go_somewhere),
        cmocka_unit_test(test_a_pair_bounds),
        cmocka_unit_test(test_a_patrol_and_a_strike_stay_in_their_area),
        cmocka_unit_test(test_a_barrage_falls_on_its_area),
        cmocka_unit_test(test_own_guns_fire_a_barrage),
        cmocka_unit_test(test_bombs_fall_one_by_one),
        cmocka_unit_test(test_howitzers_fire_a_barrage_by_missions),
        cmocka_unit_test(test_conditions_are_joined),
        cmocka_unit_test(test_supplies_fill_up),
        cmocka_unit_test(test_only_some_orders_end_a_fight),
        cmocka_unit_test(test_a_reaction_interrupts_and_resumes),
        cmocka_unit_test(test_the_battle_ends_and_begins_again),
        cmocka_unit_test(test_a_world_without_missions_has_no_battle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
