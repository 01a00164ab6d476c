/* The search for targets: how long it takes, and which target a crew takes. */
#include "mover/agent/target_search.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ    20
#define CREWS 49u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 256; hz = 20.0; };");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, enum force force,
                    enum behaviour behaviour)
{
    uint32_t row = steps_put(&f, kind, (struct vec3){x, FIXTURE_GROUND_M, z}, force, behaviour);
    struct entities e = steps_rows(&f);
    e.row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
    e.row[row].reload_tick = UINT32_MAX;
    return row;
}

/* The mean time until a tank finds another that stands at this distance [s]. */
static double mean_s(double distance)
{
    double sum = 0.0;
    steps_empty(&f);
    for (uint32_t n = 0; n < CREWS; n++) {
        double x = 4000.0 + 6000.0 * (n % 7), z = 4000.0 + 6000.0 * (double)(n / 7);
        put("tank", x, z, FORCE_BLUE, BEHAVIOUR_IDLE);
        put("truck", x + distance, z, FORCE_RED, BEHAVIOUR_HOLD);
    }
    for (int frame = 0; frame < 120 * HZ; frame++) {
        fixture_run(&f, 1);
        for (uint32_t n = 0; n < CREWS; n++)
            sum += steps_rows(&f).row[2 * n].behaviour == BEHAVIOUR_IDLE ? 1.0 / HZ : 0.0;
    }
    return sum / CREWS;
}

static void test_the_time_to_find_a_target_grows_with_the_distance(void **state)
{
    double sight = steps_kind(&f, "tank")->sight_m;
    (void)state;
    double far_s = mean_s(0.8 * sight), near_s = mean_s(0.2 * sight);
    if (far_s < 16.0 || far_s > 32.0 || near_s < 4.0 || near_s > 9.0)
        fail_msg("%g s at 0.8 of the sight (24), %g s at 0.2 (6)", far_s, near_s);
}

static void test_crews_side_by_side_take_different_targets(void **state)
{
    uint32_t taken[8] = {0}, targets = 0, most = 0;
    (void)state;
    for (uint32_t n = 0; n < 8; n++)
        put("tank", 25000.0 + 20.0 * n, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    for (uint32_t n = 0; n < 8; n++)
        put("truck", 25000.0 + 20.0 * n, 24400.0, FORCE_RED, BEHAVIOUR_HOLD);
    fixture_run(&f, 120 * HZ);
    for (uint32_t n = 0; n < 8; n++) {
        assert_int_equal(steps_rows(&f).row[n].behaviour, BEHAVIOUR_ATTACK);
        taken[steps_rows(&f).row[n].target_slot - 8]++;
    }
    for (uint32_t n = 0; n < 8; n++) {
        targets += taken[n] > 0;
        most = taken[n] > most ? taken[n] : most;
    }
    assert_true(targets >= 4 && most <= 4);
}

/* Jeeps that may not flee see tanks near by, which their bullets do not harm, and a jeep further
 * on.
 */
static void test_a_crew_that_stands_looks_past_what_it_cannot_harm(void **state)
{
    uint32_t fight = 0;
    (void)state;
    for (uint32_t n = 0; n < CREWS; n++) {
        double x = 4000.0 + 6000.0 * (n % 7), z = 4000.0 + 6000.0 * (double)(n / 7);
        uint32_t row = put("jeep", x, z, FORCE_BLUE, BEHAVIOUR_IDLE);
        steps_rows(&f).row[row].flags |= ENTITY_FLAG_STAND;
        for (int tank = 0; tank < 3; tank++)
            put("tank", x + 20.0, z + 12.0 * tank, FORCE_RED, BEHAVIOUR_HOLD);
        put("jeep", x + 300.0, z - 60.0, FORCE_RED, BEHAVIOUR_HOLD);
    }
    fixture_run(&f, 20 * HZ);
    struct entities e = steps_rows(&f);
    for (uint32_t n = 0; n < CREWS; n++) {
        fight += e.row[5 * n].behaviour == BEHAVIOUR_ATTACK;
        assert_true(e.row[5 * n].behaviour == BEHAVIOUR_IDLE ||
                    e.row[5 * n].target_slot == 5 * n + 4);
    }
    if (fight < CREWS * 3 / 4)
        fail_msg("%u of %u jeeps fight", fight, CREWS);
}

/* Of a gun and three trucks that are nearer. */
static void test_helicopters_take_air_defence_first(void **state)
{
    uint32_t first = 0;
    (void)state;
    for (uint32_t n = 0; n < CREWS; n++) {
        double x = 4000.0 + 6000.0 * (n % 7), z = 4000.0 + 6000.0 * (double)(n / 7);
        put("helicopter", x, z, FORCE_BLUE, BEHAVIOUR_IDLE);
        put("flak", x, z - 2000.0, FORCE_RED, BEHAVIOUR_HOLD);
        for (int truck = 0; truck < 3; truck++)
            put("truck", x + 30.0 * truck, z - 1500.0, FORCE_RED, BEHAVIOUR_HOLD);
    }
    struct entities e = steps_rows(&f);
    for (uint32_t n = 0; n < CREWS; n++) {
        e.row[5 * n].y += 45.0;
        e.row[5 * n].behaviour = BEHAVIOUR_ATTACK; /* a crew at ease finds what is near first */
        steps_target(&f, 5 * n, 5 * n + 2);
        e.row[5 * n + 2].state = ENTITY_WRECK;
    }
    fixture_run(&f, 2 * HZ);
    e = steps_rows(&f);
    for (uint32_t n = 0; n < CREWS; n++)
        first +=
            e.row[5 * n].behaviour == BEHAVIOUR_ATTACK && e.row[5 * n].target_slot == 5 * n + 1;
    assert_int_equal(first, CREWS);
}

static void test_no_crew_takes_a_wreck_or_what_is_out_of_reach(void **state)
{
    struct step_context step;
    struct serial_context context;
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    uint32_t wreck = put("tank", 25000.0, 24700.0, FORCE_RED, BEHAVIOUR_HOLD);
    (void)state;
    steps_rows(&f).row[wreck].state = ENTITY_WRECK;
    steps_kind(&f, "tank")->sight_m = 5000.0;
    put("tank", 25000.0, 22000.0, FORCE_RED, BEHAVIOUR_HOLD);
    fixture_run(&f, 60 * HZ);
    assert_int_equal(steps_rows(&f).row[row].behaviour, BEHAVIOUR_IDLE);
    steps_serial_context(&f, &step, &context);
    assert_int_equal(target_search(&step, row, TARGET_SEARCH_ALERT), SLOT_NONE);
    uint32_t near = put("tank", 25000.0, 24000.0, FORCE_RED, BEHAVIOUR_HOLD);
    fixture_run(&f, 60 * HZ);
    assert_int_equal(steps_rows(&f).row[row].target_slot, near);
}

/* An agent that may begin to cruise looks ahead of its turn, and again in each of the next tries if
 * the stretch is refused. It finds in all of them what it finds in its turn, so that such agents
 * find no enemy sooner than others. */
static void test_looks_ahead_of_a_turn_are_one_look(void **state)
{
    struct step_context step;
    struct serial_context context;
    uint32_t found = 0, looks = 0;
    uint32_t row = put("tank", 25000.0, 25000.0, FORCE_BLUE, BEHAVIOUR_IDLE);
    put("tank", 25000.0, 24000.0, FORCE_RED, BEHAVIOUR_HOLD);
    (void)state;
    fixture_run(&f, 1);
    steps_serial_context(&f, &step, &context);
    for (uint64_t look = 100; look < 200; look++) {
        uint64_t turn = look * step.look_frames - steps_rows(&f).row[row].id;
        step.tick = turn;
        uint32_t target = target_search(&step, row, TARGET_SEARCH_CALM);
        for (uint32_t ahead = 1; ahead < step.look_frames; ahead++) {
            step.tick = turn - ahead;
            assert_int_equal(target_search(&step, row, TARGET_SEARCH_CALM), target);
        }
        found += target != SLOT_NONE;
        looks++;
    }
    print_message("%u of %u looks find the enemy\n", found, looks);
    assert_true(found > looks / 20 && found < looks / 2);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_the_time_to_find_a_target_grows_with_the_distance),
        TEST(test_crews_side_by_side_take_different_targets),
        TEST(test_a_crew_that_stands_looks_past_what_it_cannot_harm),
        TEST(test_helicopters_take_air_defence_first),
        TEST(test_no_crew_takes_a_wreck_or_what_is_out_of_reach),
        TEST(test_looks_ahead_of_a_turn_are_one_look),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
