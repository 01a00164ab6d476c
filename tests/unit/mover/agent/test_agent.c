/* Agents: when an autonomous vehicle changes its behaviour, and where it then goes. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 20.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; cruise = false; };");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, enum force force,
                    enum behaviour behaviour)
{
    return steps_put(&f, kind, (struct vec3){x, FIXTURE_GROUND_M, z}, force, behaviour);
}

static enum behaviour behaviour_of(uint32_t row)
{
    return (enum behaviour)steps_rows(&f).row[row].behaviour;
}

static void attack(uint32_t row, uint32_t target, double seconds)
{
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_ATTACK;
    steps_target(&f, row, target);
    e.row[row].until_tick = (uint32_t)(fixture_state(&f).head->tick + (uint64_t)(seconds * HZ));
    e.row[row].reload_tick = UINT32_MAX; /* it holds its fire */
}

/* The only agent event so far is this one. */
static void told(uint32_t row, enum behaviour from, enum behaviour to, enum agent_reason because)
{
    const struct event *event = fixture_event(&f, EVENT_AGENT, 0);
    assert_non_null(event);
    assert_int_equal(event->agent.agent.id, row + 1);
    assert_int_equal(event->agent.from, from);
    assert_int_equal(event->agent.to, to);
    assert_int_equal(event->agent.because, because);
}

/* --- row 9 -------------------------------------------------------------------------------------*/

static void test_row_9_a_shot_at_agent_reacts_within_two_frames(void **state)
{
    static const char *const targets[] = {"tank", "jeep", "truck", "carrier", "helicopter"};
    (void)state;
    for (size_t n = 0; n < sizeof targets / sizeof targets[0]; n++) {
        fixture_close(&f);
        open_world(NULL);
        uint32_t shooter = put("tank", 25000.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
        uint32_t target = put(targets[n], 25000.0, 26000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
        uint32_t beside = put(targets[n], 25060.0, 26000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
        steps_aim(&f, shooter, target);
        struct event_command answer =
            steps_command(&f, (struct command){.type = COMMAND_FIRE,
                                               .entity = steps_rows(&f).row[shooter].id,
                                               .target = steps_rows(&f).row[target].id});
        assert_int_equal(answer.result, COMMAND_DONE);
        fixture_run(&f, 1); /* the second frame */
        assert_true(behaviour_of(target) == BEHAVIOUR_ATTACK ||
                    behaviour_of(target) == BEHAVIOUR_FLEE);
        assert_int_equal(steps_rows(&f).row[target].target_id, steps_rows(&f).row[shooter].id);
        assert_int_equal(behaviour_of(beside), BEHAVIOUR_PATROL);
        assert_int_equal(behaviour_of(shooter), BEHAVIOUR_HOLD);
    }
}

static void test_row_9_courage_says_whether_it_fights_or_flees(void **state)
{
    (void)state;
    for (int brave = 0; brave < 2; brave++) {
        fixture_close(&f);
        open_world(NULL);
        steps_kind(&f, "tank")->courage = brave ? 1.0 : 0.0;
        uint32_t enemy = put("jeep", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
        uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
        steps_threaten(&f, row, enemy);
        fixture_run(&f, 1);
        enum behaviour to = brave ? BEHAVIOUR_ATTACK : BEHAVIOUR_FLEE;
        assert_int_equal(behaviour_of(row), to);
        told(row, BEHAVIOUR_PATROL, to, REASON_FIRED_UPON);
    }
}

static void test_row_9_some_of_the_half_brave_fight_and_some_flee(void **state)
{
    uint32_t enemy = put("truck", 25000.0, 23000.0, FORCE_RED, BEHAVIOUR_HOLD), row[50];
    int fights = 0;
    (void)state;
    steps_kind(&f, "jeep")->courage = 0.5;
    for (uint32_t n = 0; n < 50; n++) {
        row[n] = put("jeep", 24000.0 + 40.0 * n, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
        steps_threaten(&f, row[n], enemy);
    }
    fixture_run(&f, 1);
    for (uint32_t n = 0; n < 50; n++) {
        assert_int_not_equal(behaviour_of(row[n]), BEHAVIOUR_IDLE);
        fights += behaviour_of(row[n]) == BEHAVIOUR_ATTACK;
    }
    assert_in_range(fights, 10, 40);
}

static void test_row_9_an_unarmed_agent_flees_and_gets_away(void **state)
{
    uint32_t enemy = put("tank", 25000.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t unarmed = put("truck", 25300.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t held = put("tank", 25000.0, 25300.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    steps_kind(&f, "tank")->courage = 1.0;
    steps_rows(&f).row[held].flags = ENTITY_FLAG_HOLD_FIRE;
    steps_threaten(&f, unarmed, enemy);
    steps_threaten(&f, held, enemy);
    fixture_run(&f, (uint32_t)(25.0 * HZ));
    assert_int_equal(behaviour_of(unarmed), BEHAVIOUR_FLEE);
    assert_int_equal(behaviour_of(held), BEHAVIOUR_FLEE);
    assert_true(steps_rows(&f).row[unarmed].x > 25500.0 && steps_rows(&f).row[held].z > 25500.0);
    fixture_run(&f, (uint32_t)(6.0 * HZ)); /* it flees for half a minute */
    assert_int_equal(behaviour_of(unarmed), BEHAVIOUR_IDLE);
    assert_int_equal(behaviour_of(held), BEHAVIOUR_IDLE);
}

static void test_a_threat_from_the_dead_is_not_heard(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    steps_threaten(&f, row, enemy);
    steps_rows(&f).row[enemy].state = ENTITY_WRECK;
    fixture_run(&f, 2);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_IDLE);
    steps_rows(&f).row[row].threat_slot = enemy;
    steps_rows(&f).row[row].threat_id = 77; /* the slot's last owner */
    fixture_run(&f, 2);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_IDLE);
    assert_int_equal(steps_rows(&f).row[row].threat_id, 0);
}

/* --- an attack's ends --------------------------------------------------------------------------*/

static void test_an_attack_ends_when_the_target_is_gone(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
    (void)state;
    attack(row, enemy, 1000.0);
    fixture_run(&f, 3);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    steps_rows(&f).row[enemy].state = ENTITY_WRECK;
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_PATROL);
    assert_int_equal(steps_rows(&f).row[row].target_id, 0);
    told(row, BEHAVIOUR_ATTACK, BEHAVIOUR_PATROL, REASON_TARGET_GONE);
}

/* Its order is to engage whom it sees: it goes over to the next without a word. */
static void test_an_attack_goes_on_with_the_next_enemy_in_sight(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t next = put("tank", 25400.0, 25200.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
    (void)state;
    steps_rows(&f).row[row].heading = HALF_PI;
    steps_rows(&f).row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
    attack(row, enemy, 1000.0);
    fixture_run(&f, 3);
    uint64_t changes = fixture_state(&f).head->tally.agent_changes;
    steps_rows(&f).row[enemy].state = ENTITY_WRECK;
    fixture_run(&f, 2);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    assert_int_equal(steps_rows(&f).row[row].target_slot, next);
    assert_int_equal(fixture_state(&f).head->tally.agent_changes, changes);
    steps_rows(&f).row[next].state = ENTITY_WRECK;
    fixture_run(&f, 2);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_PATROL);
}

static void test_an_attack_ends_when_the_target_is_out_of_sight_for_long(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    steps_kind(&f, "tank")->sight_m = 100.0;
    attack(row, enemy, 2.0);
    fixture_run(&f, (uint32_t)(2.0 * HZ) - 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_IDLE);
    told(row, BEHAVIOUR_ATTACK, BEHAVIOUR_IDLE, REASON_LOST_SIGHT);
}

static void test_an_attack_goes_on_while_the_target_is_seen(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    attack(row, enemy, 2.0);
    fixture_run(&f, (uint32_t)(60.0 * HZ));
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
}

static void test_another_shot_makes_the_fight_last_longer(void **state)
{
    uint32_t enemy = put("tank", 25500.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    attack(row, enemy, 2.0);
    fixture_run(&f, (uint32_t)HZ);
    steps_threaten(&f, row, enemy);
    fixture_run(&f, (uint32_t)(3.0 * HZ));
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
}

static void test_an_attacker_closes_in_to_its_stand_off_and_fires(void **state)
{
    const struct kind *kind = steps_kind(&f, "tank");
    uint32_t enemy = put("ship", 28000.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t row = put("tank", 24500.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    (void)state;
    steps_kind(&f, "ship")->resistance_j = 1e12;
    steps_kind(&f, "ship")->mass_kg = 1e12; /* the shells' blasts do not push it along */
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_STAND; /* it does not leave to be supplied */
    attack(row, enemy, 1000.0);
    steps_rows(&f).row[row].reload_tick = 0;
    fixture_run(&f, (uint32_t)(20.0 * HZ)); /* 330 m: still out of range */
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    fixture_run(&f, (uint32_t)(300.0 * HZ));
    double distance = 28000.0 - steps_rows(&f).row[row].x;
    assert_true(distance < 0.55 * kind->range_m && distance > 0.4 * kind->range_m);
    assert_int_equal(steps_rows(&f).row[row].rounds,
                     kind->rounds - fixture_event_count(&f, EVENT_FIRE));
    /* It keeps 35 of its 55 rounds for nearer targets (fire_control.h). */
    assert_in_range(fixture_event_count(&f, EVENT_FIRE), 18, 20);
}

/* --- other reasons -----------------------------------------------------------------------------*/

static void test_an_empty_tank_leaves_it_idle(void **state)
{
    uint32_t row = put("jeep", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
    (void)state;
    fixture_run(&f, (uint32_t)(5.0 * HZ));
    assert_true(steps_speed(&f, row) > 5.0);
    steps_rows(&f).row[row].fuel_l = 0.0;
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_IDLE);
    told(row, BEHAVIOUR_PATROL, BEHAVIOUR_IDLE, REASON_OUT_OF_FUEL);
    fixture_run(&f, (uint32_t)(10.0 * HZ));
    assert_true(steps_speed(&f, row) == 0.0);
    assert_int_equal(fixture_event_count(&f, EVENT_AGENT), 1); /* said once */
}

static void test_after_a_bump_it_backs_off_and_then_goes_on(void **state)
{
    uint32_t row = put("jeep", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].bumped = 1;
    e.row[row].bump_heading = (float)PI; /* away is south */
    fixture_run(&f, 1);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_BACK_OFF);
    told(row, BEHAVIOUR_PATROL, BEHAVIOUR_BACK_OFF, REASON_COLLISION);
    assert_int_equal(steps_rows(&f).row[row].bumped, 0);
    fixture_run(&f, (uint32_t)(2.0 * HZ));
    assert_int_equal(behaviour_of(row), BEHAVIOUR_BACK_OFF);
    assert_true(steps_rows(&f).row[row].z > 25001.0);
    fixture_run(&f, (uint32_t)HZ);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_PATROL);
}

/* --- seeing ------------------------------------------------------------------------------------*/

/* Does a tank that fires at will attack another of this force at this distance, within five
 * minutes?
 */
static bool engages(double distance, enum force force, bool at_will)
{
    fixture_close(&f);
    open_world(NULL);
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t other =
        put("tank", 25000.0 + 0.6 * distance, 25000.0 - 0.8 * distance, force, BEHAVIOUR_HOLD);
    struct entities e = steps_rows(&f);
    e.row[row].flags = at_will ? ENTITY_FLAG_FIRE_AT_WILL : 0;
    e.row[row].reload_tick = UINT32_MAX;
    for (int second = 0; second < 300 && behaviour_of(row) != BEHAVIOUR_ATTACK; second++)
        fixture_run(&f, (uint32_t)HZ);
    if (behaviour_of(row) != BEHAVIOUR_ATTACK)
        return false;
    told(row, BEHAVIOUR_IDLE, BEHAVIOUR_ATTACK, REASON_ENEMY_SEEN);
    assert_int_equal(steps_rows(&f).row[row].target_slot, other);
    return true;
}

static void test_fire_at_will_sees_an_enemy_in_range_and_none_beyond(void **state)
{
    double range = steps_kind(&f, "tank")->range_m;
    (void)state;
    assert_true(engages(0.99 * range, FORCE_RED, true));
    assert_true(engages(100.0, FORCE_RED, true));
    assert_false(engages(1.01 * range, FORCE_RED, true));
    assert_false(engages(100.0, FORCE_BLUE, true));
    assert_false(engages(100.0, FORCE_NEUTRAL, true));
    assert_false(engages(100.0, FORCE_RED, false));
}

static void test_fire_at_will_takes_the_nearest_living_enemy(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t wreck = put("tank", 25100.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    uint32_t nearest = put("tank", 25000.0, 24900.0, FORCE_RED, BEHAVIOUR_HOLD);
    put("tank", 26800.0, 25000.0, FORCE_RED, BEHAVIOUR_HOLD);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
    e.row[row].reload_tick = UINT32_MAX;
    e.row[wreck].state = ENTITY_WRECK;
    for (int second = 0; second < 60 && behaviour_of(row) != BEHAVIOUR_ATTACK; second++)
        fixture_run(&f, (uint32_t)HZ);
    assert_int_equal(behaviour_of(row), BEHAVIOUR_ATTACK);
    assert_int_equal(steps_rows(&f).row[row].target_slot, nearest);
}

/* --- orders ------------------------------------------------------------------------------------*/

static const char patrol_text[] =
    "world = { seed = 1; capacity = 64; hz = 20.0; };\n"
    "vehicles = (\n"
    "  { kind = \"jeep\"; count = 6; area = [24000.0, 24000.0, 24600.0, 24800.0]; },\n"
    "  { kind = \"tank\"; count = 6; area = [26000.0, 25000.0, 26500.0, 25500.0]; } );\n";

static void test_a_patrol_stays_in_its_area(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, patrol_text);
    double way = 0.0;
    for (int frame = 0; frame < (int)(240.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t i = 0; i < 12; i++) {
            const struct area *area = &f.view.world.areas[e.row[i].order_arg];
            assert_true(e.row[i].goal_x >= area->x0 && e.row[i].goal_x <= area->x1);
            assert_true(e.row[i].goal_z >= area->z0 && e.row[i].goal_z <= area->z1);
            /* A goal at the border is passed by a turn's width at most. */
            assert_true(e.row[i].x > area->x0 - 60.0 && e.row[i].x < area->x1 + 60.0);
            assert_true(e.row[i].z > area->z0 - 60.0 && e.row[i].z < area->z1 + 60.0);
            way += steps_speed(&f, i) / HZ;
        }
    }
    assert_true(way > 12 * 1000.0);
}

/* A tank and a jeep drive to goals that are far from their headings. */
static void test_a_decision_that_confirms_the_course_leaves_the_controls(void **state)
{
    static const char *const kinds[] = {"tank", "jeep"};
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        double from_z = 25000.0 + 500.0 * (double)n;
        uint32_t row = put(kinds[n], 25000.0, from_z, FORCE_BLUE, BEHAVIOUR_PATROL);
        struct entities e = steps_rows(&f);
        e.row[row].goal_x = 27000.0;
        e.row[row].goal_z = from_z + 1000.0;
        fixture_run(&f, (uint32_t)(15.0 * HZ)); /* it turns */
        e = steps_rows(&f);
        const float throttle = e.row[row].throttle;
        const double heading = e.row[row].heading;
        assert_true(throttle > 0.7f);
        for (uint32_t frame = 0; frame < (uint32_t)(30.0 * HZ); frame++) {
            fixture_run(&f, 1);
            e = steps_rows(&f);
            assert_true(e.row[row].steer == 0.0f && e.row[row].throttle == throttle);
            assert_true(e.row[row].heading == heading);
        }
        double beside = 0.5 * (e.row[row].x - 25000.0) - (e.row[row].z - from_z);
        assert_true(fabs(beside) < 10.0);
        for (uint32_t frame = 0; e.row[row].goal_x == 27000.0; frame++) { /* and it arrives */
            assert_true(frame < (uint32_t)(200.0 * HZ));
            fixture_run(&f, 1);
            e = steps_rows(&f);
        }
    }
}

static const char route_text[] = "world = { seed = 1; capacity = 64; hz = 20.0; };\n"
                                 "vehicles = ( { kind = \"jeep\"; at = [25000.0, 25000.0];\n"
                                 "  route = ( [25200.0, 25000.0], [25200.0, 25200.0], [25000.0, "
                                 "25300.0], [24900.0, 25100.0] );\n"
                                 "} );\n";

static const double route[4][2] = {
    {25200.0, 25000.0}, {25200.0, 25200.0}, {25000.0, 25300.0}, {24900.0, 25100.0}};

static void test_a_route_is_driven_in_its_order_again_and_again(void **state)
{
    int passed = 0;
    (void)state;
    fixture_close(&f);
    fixture_open(&f, route_text);
    for (int frame = 0; frame < (int)(200.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        const double *next = route[passed % 4], *after = route[(passed + 1) % 4];
        if (frame == 0) /* it thinks at ten hertz */
            continue;
        if (e.row[0].goal_x == after[0] && e.row[0].goal_z == after[1]) {
            assert_true(hypot(e.row[0].x - next[0], e.row[0].z - next[1]) < 25.0 + 1.6);
            passed++;
        } else {
            assert_true(e.row[0].goal_x == next[0] && e.row[0].goal_z == next[1]);
        }
    }
    assert_true(passed > 8);
}

static void test_an_interrupted_route_goes_on_to_the_point_it_was_heading_for(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, route_text);
    fixture_run(&f, (uint32_t)(3.0 * HZ)); /* on its way to the first */
    struct entities e = steps_rows(&f);
    assert_true(e.row[0].goal_x == route[0][0] && e.row[0].goal_z == route[0][1]);
    e.row[0].bumped = 1;
    e.row[0].bump_heading = (float)(1.5 * PI);
    fixture_run(&f, (uint32_t)(4.0 * HZ));
    e = steps_rows(&f);
    assert_int_equal(e.row[0].behaviour, BEHAVIOUR_ROUTE);
    assert_true(e.row[0].goal_x == route[0][0] && e.row[0].goal_z == route[0][1]);
}

/* Each has its orders within 25 m. The last two have no way to drive. */
static const char *const little_text =
    "world = { seed = 1; capacity = 64; hz = 20.0; };"
    "vehicles = ("
    "{ kind = \"jeep\"; at = [25000.0, 25000.0]; route = ( [25000.0, 25000.0], [25010.0, 25004.0],"
    " [25004.0, 25010.0] ); },"
    "{ kind = \"truck\"; at = [25200.0, 25000.0]; route = ( [25200.0, 25000.0], [25212.0, 25000.0],"
    " [25212.0, 25016.0], [25200.0, 25016.0] ); },"
    "{ kind = \"tank\"; at = [25400.0, 25000.0]; route = ( [25400.0, 25000.0], [25409.0, 25003.0],"
    " [25403.0, 25009.0] ); },"
    "{ kind = \"jeep\"; at = [25650.0, 25000.0]; behaviour = \"patrol\";"
    " area = [25600.0, 25000.0, 25612.0, 25012.0]; },"
    "{ kind = \"jeep\"; at = [25800.0, 25000.0]; route = ( [25801.0, 25000.0], [25800.0, 25001.0]"
    " ); },"
    "{ kind = \"tank\"; at = [26000.0, 25000.0]; route = ( [26050.0, 25000.0], [26051.0, 25001.0]"
    " ); } );";

static void test_orders_in_little_room_are_driven_without_a_twitch(void **state)
{
    enum { ROWS = 6, DRIVE = 4 };
    int turned[ROWS] = {0}, before[ROWS] = {0};
    double way_m[ROWS] = {0.0};
    (void)state;
    fixture_close(&f);
    fixture_open(&f, little_text);
    fixture_run(&f, (uint32_t)(20.0 * HZ));
    for (int frame = 0; frame < (int)(60.0 * HZ); frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t row = 0; row < ROWS; row++) {
            double sine, cosine;
            maths_sincos(e.row[row].heading, &sine, &cosine);
            double ahead_mps = e.row[row].vx * sine - e.row[row].vz * cosine;
            int sign = ahead_mps > 0.05 ? 1 : ahead_mps < -0.05 ? -1 : before[row];
            turned[row] += sign * before[row] < 0;
            before[row] = sign;
            way_m[row] += steps_speed(&f, row) / HZ;
        }
    }
    for (uint32_t row = 0; row < ROWS; row++) {
        printf("row %u: %.0f m, %d times the other way in a minute\n", row, way_m[row],
               turned[row]);
        assert_true(turned[row] < 40);
        assert_true(row < DRIVE ? way_m[row] > 70.0 : way_m[row] < 0.5);
    }
    assert_true(fabs(steps_position(&f, ROWS - 1).x - 26050.0) < 5.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_9_a_shot_at_agent_reacts_within_two_frames),
        TEST(test_row_9_courage_says_whether_it_fights_or_flees),
        TEST(test_row_9_some_of_the_half_brave_fight_and_some_flee),
        TEST(test_row_9_an_unarmed_agent_flees_and_gets_away),
        TEST(test_a_threat_from_the_dead_is_not_heard),
        TEST(test_an_attack_ends_when_the_target_is_gone),
        TEST(test_an_attack_goes_on_with_the_next_enemy_in_sight),
        TEST(test_an_attack_ends_when_the_target_is_out_of_sight_for_long),
        TEST(test_an_attack_goes_on_while_the_target_is_seen),
        TEST(test_another_shot_makes_the_fight_last_longer),
        TEST(test_an_attacker_closes_in_to_its_stand_off_and_fires),
        TEST(test_an_empty_tank_leaves_it_idle),
        TEST(test_after_a_bump_it_backs_off_and_then_goes_on),
        TEST(test_fire_at_will_sees_an_enemy_in_range_and_none_beyond),
        TEST(test_fire_at_will_takes_the_nearest_living_enemy),
        TEST(test_a_patrol_stays_in_its_area),
        TEST(test_a_decision_that_confirms_the_course_leaves_the_controls),
        TEST(test_a_route_is_driven_in_its_order_again_and_again),
        TEST(test_orders_in_little_room_are_driven_without_a_twitch),
        TEST(test_an_interrupted_route_goes_on_to_the_point_it_was_heading_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
