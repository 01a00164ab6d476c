/* Fire control: what suits a gun, and how long crews need before their first shot. */
#include "mover/agent/fire_control.h"

#include "mover/step.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define HZ    60.0
#define CREWS 60u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 256; };");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* --- targets -----------------------------------------------------------------------------------*/

/* Puts a shooter and a target that is so far above and behind it, and asks about them. */
static bool ask(bool (*question)(const struct step_context *, uint32_t, uint32_t),
                const char *shooter, const char *target, double above_m, double behind_m)
{
    const struct vec3 at = {25000.0, 100.0 + above_m, 25000.0 + behind_m};
    uint32_t a =
        steps_put(&f, shooter, (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t b = steps_put(&f, target, at, FORCE_RED, BEHAVIOUR_IDLE);
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    bool does = question(&step, a, b);
    steps_empty(&f);
    return does;
}

static bool suits(const char *shooter, const char *target)
{
    return ask(fire_control_suits, shooter, target, 300.0, 1000.0);
}

static bool outranges(const struct step_context *step, uint32_t shooter, uint32_t target)
{
    return fire_control_outranges_m(step, shooter, target) > 0.0;
}

static void test_helicopters_outrange_air_defence_unless_it_reaches_further(void **state)
{
    struct kind *flak = steps_kind(&f, "flak");
    const double range_m = flak->range_m;
    (void)state;
    assert_true(ask(outranges, "helicopter", "flak", 0.0, 2000.0));
    assert_false(ask(outranges, "helicopter", "tank", 0.0, 2000.0));
    assert_false(ask(outranges, "jet", "flak", 0.0, 2000.0));
    flak->range_m = 2400.0; /* beyond it rockets would fly too far */
    assert_false(ask(outranges, "helicopter", "flak", 0.0, 2000.0));
    flak->range_m = range_m;
}

static void test_no_tank_gun_suits_a_jet(void **state)
{
    (void)state;
    assert_false(suits("tank", "jet"));
    assert_true(suits("tank", "helicopter"));
    assert_true(suits("tank", "jeep"));
    assert_false(suits("helicopter", "jet"));
    assert_true(suits("jeep", "jet"));
    assert_true(suits("jet", "jet"));
    assert_true(suits("truck", "jet")); /* unarmed: it still sees the jet */
    steps_kind(&f, "shell")->air_targets = AIR_TARGETS_NONE;
    assert_false(suits("tank", "helicopter"));
}

/* A jet circles over a tank that fires at will, and even fires at it. */
static void test_a_tank_fires_no_round_at_a_jet(void **state)
{
    uint32_t tank =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t jet =
        steps_put(&f, "jet", (struct vec3){25000.0, 300.0, 26000.0}, FORCE_RED, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[tank].flags |= ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND;
    e.row[jet].flags |= ENTITY_FLAG_HOLD_FIRE;
    for (int second = 0; second < 30; second++) {
        e = steps_rows(&f);
        e.row[tank].threat_slot = jet, e.row[tank].threat_id = e.row[jet].id;
        fixture_run(&f, 60);
        assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_IDLE);
    }
    print_message("acceptance: | %-32s | %-12s | %6u |\n", "rounds of a tank's gun at jets", "0",
                  steps_kind(&f, "tank")->rounds - steps_rows(&f).row[tank].rounds);
    assert_int_equal(steps_rows(&f).row[tank].rounds, steps_kind(&f, "tank")->rounds);
}

static void test_a_fast_helicopter_is_no_target_for_a_tank_gun(void **state)
{
    (void)state;
    uint32_t a =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t b = steps_put(&f, "helicopter", (struct vec3){25000.0, 150.0, 25500.0}, FORCE_RED,
                           BEHAVIOUR_HOLD);
    struct step_context step;
    struct serial_context context;
    steps_rows(&f).row[b].vx = 50.0;
    steps_serial_context(&f, &step, &context);
    assert_false(fire_control_suits(&step, a, b));
    steps_rows(&f).row[b].vx = 5.0;
    assert_true(fire_control_suits(&step, a, b));
}

/* --- armour ------------------------------------------------------------------------------------*/

static bool harms(const char *shooter, const char *target)
{
    return ask(fire_control_harms, shooter, target, 0.0, 500.0);
}

static void test_a_round_harms_what_it_may_penetrate(void **state)
{
    (void)state;
    assert_false(harms("jeep", "tank") || harms("jeep", "carrier") || harms("flak", "tank"));
    assert_false(harms("wishbone", "tank") || harms("attack-tomato", "tank"));
    assert_true(harms("jeep", "jeep") && harms("jeep", "truck") && harms("jeep", "helicopter"));
    assert_true(harms("wishbone", "carrier")); /* through its roof */
    assert_true(harms("tank", "tank") && harms("carrier", "tank") && harms("helicopter", "tank"));
    assert_true(harms("missile-carrier", "tank") && harms("jet", "tank"));
    assert_true(harms("truck", "tank")); /* unarmed */
}

/* A vehicle meets a tank that holds its fire, 600 m away. Returns the rounds that it fires in a
 * minute. behaviour: its first after it has seen the tank or was shot at. */
static uint32_t rounds_at_a_tank(const char *kind, bool shot, uint8_t flags,
                                 enum behaviour *behaviour)
{
    uint32_t row =
        steps_put(&f, kind, (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t tank =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 24400.0}, FORCE_RED, BEHAVIOUR_HOLD);
    struct entities e = steps_rows(&f);
    uint32_t before = e.row[row].rounds;
    if (steps_kind(&f, kind)->domain == DOMAIN_AIR)
        e.row[row].y = 125.0;
    e.row[row].flags |= flags;
    *behaviour = BEHAVIOUR_IDLE;
    for (int frame = 0; frame < (int)(60.0 * HZ); frame++) {
        e = steps_rows(&f);
        if (shot && frame % 120 == 60)
            e.row[row].threat_slot = tank, e.row[row].threat_id = e.row[tank].id;
        fixture_run(&f, 1);
        if (*behaviour == BEHAVIOUR_IDLE)
            *behaviour = (enum behaviour)steps_rows(&f).row[row].behaviour;
        if (shot && frame == 61)
            assert_true((flags & ENTITY_FLAG_STAND) || *behaviour != BEHAVIOUR_IDLE);
    }
    uint32_t fired = before - steps_rows(&f).row[row].rounds;
    steps_empty(&f);
    return fired;
}

static void test_row_9_who_cannot_harm_a_tank_takes_cover_and_does_not_fire(void **state)
{
    static const char *const kinds[] = {"jeep", "wishbone", "flak"};
    enum behaviour behaviour;
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
        for (int shot = 0; shot < 2; shot++) {
            assert_int_equal(rounds_at_a_tank(kinds[n], shot, ENTITY_FLAG_FIRE_AT_WILL, &behaviour),
                             0);
            assert_int_equal(behaviour, BEHAVIOUR_FLEE);
        }
        assert_int_equal(rounds_at_a_tank(kinds[n], true, 0, &behaviour), 0);
        assert_int_equal(behaviour, BEHAVIOUR_FLEE);
        assert_int_equal(rounds_at_a_tank(kinds[n], true,
                                          ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND, &behaviour),
                         0);
        assert_int_equal(behaviour, BEHAVIOUR_IDLE);
    }
}

/* A tomato rams the tank, and keeps its rounds. */
static void test_a_tomato_charges_at_a_tank_without_a_shot(void **state)
{
    enum behaviour behaviour;
    (void)state;
    assert_int_equal(rounds_at_a_tank("attack-tomato", true, ENTITY_FLAG_FIRE_AT_WILL, &behaviour),
                     0);
    assert_int_equal(behaviour, BEHAVIOUR_ATTACK);
}

/* Returns the reach over the range of the gun. */
static double reach(const char *shooter, const char *target, double rounds_left)
{
    steps_empty(&f);
    uint32_t a =
        steps_put(&f, shooter, (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t b =
        steps_put(&f, target, (struct vec3){25000.0, 400.0, 26000.0}, FORCE_RED, BEHAVIOUR_IDLE);
    struct step_context step;
    struct serial_context context;
    steps_serial_context(&f, &step, &context);
    const struct kind *kind = steps_kind(&f, shooter);
    step.m->row[a].rounds = (uint32_t)(rounds_left * kind->rounds);
    return fire_control_reach_m(&step, a, b) / kind->range_m;
}

static void test_rounds_are_kept_for_targets_that_can_be_hit(void **state)
{
    (void)state;
    assert_true(reach("tank", "tank", 1.0) == 1.0 && reach("tank", "tank", 0.7) == 1.0);
    assert_true(reach("tank", "tank", 0.6) < 0.35);
    assert_true(reach("carrier", "jet", 1.0) < 0.35);
    assert_true(reach("carrier", "helicopter", 1.0) < 0.55);
    assert_true(reach("flak", "jet", 1.0) == 1.0 && reach("flak", "jet", 0.2) == 1.0);
    assert_true(reach("flak", "tank", 1.0) < 0.5);
    assert_true(reach("ship", "jet", 1.0) == 1.0); /* its missiles home */
}

/* A carrier's burst penetrates 75 mm less 15 a kilometre, a tank has 70 at its sides: 63 of its 70
 * are certain to hold no longer from 800 m on. A tank's shaped charge penetrates everything
 * anywhere, and a jeep's bullets only what has no armour. */
static void test_a_gun_fires_from_where_its_rounds_penetrate(void **state)
{
    (void)state;
    assert_true(fabs(2000.0 * reach("carrier", "tank", 1.0) - 800.0) < 1.0);
    assert_true(fabs(2000.0 * reach("carrier", "carrier", 1.0) - 1514.0) <
                5.0); /* it sees 2.84 m */
    assert_true(reach("carrier", "truck", 1.0) > 0.65);
    assert_true(reach("tank", "carrier", 1.0) == 1.0);
    assert_true(reach("jeep", "jeep", 1.0) == 1.0);
}

/* A jeep is 1.6 m wide and 1.7 m high, and the shaped charge of a tank that drives errs by 1.1
 * mrad: at 1.2 km that is 0.8 of the jeep. From 2 km 8 of 100 rounds hit jeeps in battles. */
static void test_a_tank_fires_at_a_jeep_from_where_it_can_hit_it(void **state)
{
    (void)state;
    assert_true(fabs(2000.0 * reach("tank", "jeep", 1.0) - 1200.0) < 5.0);
    assert_true(reach("tank", "carrier", 1.0) == 1.0 && reach("tank", "tank", 1.0) == 1.0);
    assert_true(fabs(2000.0 * reach("carrier", "jeep", 1.0) - 880.0) < 5.0);
    assert_true(reach("jeep", "jeep", 1.0) == 1.0); /* a machine gun spreads over it */
}

/* A tank with 30 of its 55 rounds, which it keeps for targets within 600 m, has seen another one
 * that far away. It must not stay before it without a shot. Returns its behaviour after a minute.
 */
static enum behaviour with_kept_rounds(double away_m, uint8_t flags, uint32_t *fired)
{
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0 - away_m}, FORCE_RED,
              BEHAVIOUR_HOLD);
    struct entities e = steps_rows(&f);
    enum behaviour behaviour = BEHAVIOUR_IDLE;
    e.row[row].rounds = 30;
    e.row[row].flags |= flags | ENTITY_FLAG_FIRE_AT_WILL;
    for (int frame = 0; frame < (int)(60.0 * HZ) && behaviour != BEHAVIOUR_WITHDRAW; frame++) {
        fixture_run(&f, 1);
        behaviour = (enum behaviour)steps_rows(&f).row[row].behaviour;
    }
    *fired = 30 - steps_rows(&f).row[row].rounds;
    steps_empty(&f);
    return behaviour;
}

static void test_who_spares_its_last_rounds_goes_for_more(void **state)
{
    uint32_t fired;
    (void)state;
    assert_int_equal(with_kept_rounds(850.0, 0, &fired), BEHAVIOUR_WITHDRAW);
    assert_int_equal(fired, 0);
    with_kept_rounds(450.0, 0, &fired);
    assert_true(fired > 0);
    assert_true(with_kept_rounds(850.0, ENTITY_FLAG_STAND, &fired) != BEHAVIOUR_WITHDRAW);
    assert_int_equal(fired, 0);
}

/* --- reactions ---------------------------------------------------------------------------------*/

static int ascending(const void *p, const void *q)
{
    double a = *(const double *)p, b = *(const double *)q;
    return a < b ? -1 : a > b;
}

static void test_the_reaction_has_a_least_time_and_the_kinds_median(void **state)
{
    enum { DRAWS = 4000 };
    static double time_s[DRAWS];
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    struct step_context step;
    struct serial_context context;
    (void)state;
    steps_serial_context(&f, &step, &context);
    for (int n = 0; n < DRAWS; n++) {
        step.tick = 100 + (uint64_t)n;
        step.m->row[row].reload_tick = 0;
        fire_control_acquire(&step, row);
        time_s[n] = (double)(step.m->row[row].reload_tick - step.tick) / HZ;
    }
    qsort(time_s, DRAWS, sizeof time_s[0], ascending);
    assert_true(time_s[0] >= FIRE_CONTROL_LEAST_S);
    assert_true(fabs(time_s[DRAWS / 2] - steps_kind(&f, "tank")->reaction_s) < 0.2);
    assert_true(time_s[DRAWS * 9 / 10] > 6.0 && time_s[DRAWS - 1] < 25.0);
}

static void test_a_gun_that_loads_for_longer_is_not_loaded_sooner(void **state)
{
    uint32_t row =
        steps_put(&f, "tank", (struct vec3){25000.0, 100.0, 25000.0}, FORCE_BLUE, BEHAVIOUR_IDLE);
    struct step_context step;
    struct serial_context context;
    (void)state;
    steps_serial_context(&f, &step, &context);
    step.m->row[row].reload_tick = 1000000;
    fire_control_acquire(&step, row);
    assert_int_equal(step.m->row[row].reload_tick, 1000000);
}

/* Many pairs far apart: a red tank is hit at by a blue one at frame 0. Returns when it replied. */
static void test_crews_reply_after_a_human_time(void **state)
{
    double reply_s[CREWS];
    uint32_t count = 0;
    (void)state;
    steps_kind(&f, "tank")->courage = 1.0;
    steps_kind(&f, "tank")->reload_s = 1000.0; /* each crew fires once */
    for (uint32_t n = 0; n < CREWS; n++) {
        double x = 4000.0 + 6000.0 * (n % 8), z = 4000.0 + 6000.0 * (double)(n / 8);
        uint32_t red = steps_put(&f, "tank", (struct vec3){x, 100.0, z}, FORCE_RED, BEHAVIOUR_IDLE);
        uint32_t blue = steps_put(&f, "tank", (struct vec3){x + 900.0, 100.0, z + 300.0},
                                  FORCE_BLUE, BEHAVIOUR_HOLD);
        struct entities e = steps_rows(&f);
        e.row[red].threat_slot = blue, e.row[red].threat_id = e.row[blue].id;
    }
    for (int frame = 0; frame < 30 * 60; frame++) {
        fixture_run(&f, 1);
        while (fixture_event(&f, EVENT_FIRE, count) != NULL)
            reply_s[count++] = frame / HZ;
        if (count == CREWS)
            break;
    }
    assert_int_equal(count, CREWS);
    print_message("acceptance: | %-32s | %-12s | %6.2f |\n", "flash to reply, the soonest, s",
                  "0.7 or more", reply_s[0]);
    print_message("acceptance: | %-32s | %-12s | %6.2f |\n", "  half of the crews, s", "3 to 8",
                  reply_s[CREWS / 2]);
    assert_true(reply_s[0] >= FIRE_CONTROL_LEAST_S);
    if (reply_s[CREWS / 2] < 3.0 || reply_s[CREWS / 2] > 8.0)
        fail_msg("half of the crews need more than %g s", reply_s[CREWS / 2]);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_helicopters_outrange_air_defence_unless_it_reaches_further),
        TEST(test_no_tank_gun_suits_a_jet),
        TEST(test_a_round_harms_what_it_may_penetrate),
        TEST(test_row_9_who_cannot_harm_a_tank_takes_cover_and_does_not_fire),
        TEST(test_a_tomato_charges_at_a_tank_without_a_shot),
        TEST(test_a_tank_fires_no_round_at_a_jet),
        TEST(test_a_fast_helicopter_is_no_target_for_a_tank_gun),
        TEST(test_rounds_are_kept_for_targets_that_can_be_hit),
        TEST(test_a_gun_fires_from_where_its_rounds_penetrate),
        TEST(test_a_tank_fires_at_a_jeep_from_where_it_can_hit_it),
        TEST(test_who_spares_its_last_rounds_goes_for_more),
        TEST(test_the_reaction_has_a_least_time_and_the_kinds_median),
        TEST(test_a_gun_that_loads_for_longer_is_not_loaded_sooner),
        TEST(test_crews_reply_after_a_human_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
