/* The rows of blows of the acceptance table: what explosions and a crossing do to vehicles. Prints
 * quantity, real, ours. The values of blasts follow from the reflected impulse of Kingery and
 * Bulmash (Swisdak 1994) on the side that faces the charge. */
#include "tests/support/steps.h"
#include "world/entity/event.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define X 26000.0
#define Z 26000.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { capacity = 64; };\ncollision = { shape = \"model\"; };\n");
    return 0;
}

static void row(const char *what, const char *real, double ours, const char *unit)
{
    print_message("acceptance: | %-44s | %-12s | %6.2f %s |\n", what, real, ours, unit);
}

/* Explodes a round on the ground beside a vehicle that heads north and bears any energy, so far
 * from the middle of its right side. Returns the vehicle's row after the frame. */
static uint32_t burst_beside(const char *kind, const char *round, double away_m)
{
    steps_empty(&f);
    const struct kind *vehicle = steps_kind(&f, kind);
    steps_kind(&f, kind)->resistance_j = 1e12;
    steps_kind(&f, round)->guidance = GUIDANCE_HOMING; /* it does not fall */
    uint32_t struck =
        fixture_put(&f, (struct fixture_entity){.kind = kind, .at = {X, FIXTURE_GROUND_M, Z}});
    double x = X + 0.5 * vehicle->width_m + away_m;
    uint32_t charge =
        fixture_put(&f, (struct fixture_entity){.kind = round,
                                                .behaviour = BEHAVIOUR_FLIGHT,
                                                .at = {x, FIXTURE_GROUND_M + 0.1, Z}});
    steps_rows(&f).row[charge].until_tick = 0;
    fixture_run(&f, 1);
    assert_int_equal(fixture_state(&f).head->tally.detonations, 1);
    return struck;
}

static void test_a_shell_beside_a_jeep_pushes_it(void **state)
{
    (void)state;
    uint32_t jeep = burst_beside("jeep", "artillery", 3.0);
    double speed = steps_speed(&f, jeep);
    row("155 mm at 3 m: speed of a jeep", "2 to 3.5", speed, "m/s");
    assert_true(speed >= 2.0 && speed <= 3.5);
}

static void test_a_bomb_tips_jeep_and_truck_and_no_tank(void **state)
{
    static const char *const light[] = {"jeep", "truck"};
    (void)state;
    for (size_t n = 0; n < 2; n++) {
        uint32_t struck = burst_beside(light[n], "bomb", 5.0);
        char what[64];
        snprintf(what, sizeof what, "Mk 82 at 5 m: %s tips", light[n]);
        row(what, "yes", steps_rows(&f).row[struck].state == ENTITY_WRECK, "");
        assert_int_equal(steps_rows(&f).row[struck].state, ENTITY_WRECK);
    }
    uint32_t tank = burst_beside("tank", "bomb", 5.0);
    double speed = steps_speed(&f, tank);
    row("Mk 82 at 5 m: speed of a tank", "< 1", speed, "m/s");
    assert_int_equal(steps_rows(&f).row[tank].state, ENTITY_ACTIVE);
    assert_true(speed < 1.0);
}

/* Two tanks meet at right angles with 20 mph each (thesis, page 14). */
static void test_two_tanks_that_cross_are_highly_damaged(void **state)
{
    const double speed = 8.94, away = 12.0;
    (void)state;
    uint32_t tanks[2] = {
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {X - away, FIXTURE_GROUND_M, Z},
                                                .velocity = {speed, 0.0, 0.0}}),
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {X, FIXTURE_GROUND_M, Z + away},
                                                .velocity = {0.0, 0.0, -speed}})};
    fixture_run(&f, 180);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
    for (int n = 0; n < 2; n++) {
        row("two tanks that cross at 8.94 m/s: damage", "3 (high)",
            (double)steps_rows(&f).row[tanks[n]].damage, "");
        assert_int_equal(steps_rows(&f).row[tanks[n]].damage, DAMAGE_HIGH);
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_shell_beside_a_jeep_pushes_it),
        TEST(test_a_bomb_tips_jeep_and_truck_and_no_tank),
        TEST(test_two_tanks_that_cross_are_highly_damaged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
