/* The response "impulse" with the shipped kinds and models: the damage that the thesis names on
 * p. 14. */
#include "tests/support/steps.h"
#include "world/entity/dent.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define MPS_PER_MPH 0.44704

/* Of 312 tanks that strike each other severely, so many are highly damaged by the second impact: a
 * corner of theirs scrapes along the other tank first. */
#define TWO_IMPACTS_MOST 44u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    assert_int_equal(steps_params(&f)->collision.response, MODEL_IMPULSE);
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double heading_deg, double mph)
{
    double heading = heading_deg * RAD_PER_DEG, mps = mph * MPS_PER_MPH;
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {25000.0 + x, 100.0, 25000.0 + z},
                                                   .velocity = {mps * maths_sin(heading), 0.0,
                                                                -mps * maths_cos(heading)},
                                                   .heading_rad = heading});
}

static enum damage damage_of(uint32_t row)
{
    return (enum damage)steps_rows(&f).row[row].damage;
}

/* Two tanks whose paths cross at this angle; off_m: how much later the second is there. */
static void cross(double mph, double angle_deg, double off_m, uint32_t row[2])
{
    double heading = angle_deg * RAD_PER_DEG;
    steps_empty(&f);
    row[0] = put("tank", -12.0, 0.0, 90.0, mph);
    row[1] = put("tank", -(12.0 + off_m) * maths_sin(heading + HALF_PI),
                 (12.0 + off_m) * maths_cos(heading + HALF_PI), 90.0 + angle_deg, mph);
    fixture_run(&f, (uint32_t)(3000.0 / mph)); /* 22 m */
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
}

/* Returns how many of the world's first collisions damage a tank highly, counted from the first. */
static uint32_t impacts_to_high(uint32_t row)
{
    uint32_t id = steps_rows(&f).row[row].id;
    for (uint32_t n = 0; n < fixture_event_count(&f, EVENT_COLLISION); n++) {
        const struct event_collision *told = &fixture_event(&f, EVENT_COLLISION, n)->collision;
        if ((told->a.id == id && told->a.damage == DAMAGE_HIGH) ||
            (told->b.id == id && told->b.damage == DAMAGE_HIGH))
            return n + 1;
    }
    return UINT32_MAX;
}

/* "If the angle of impact was severe, then both tanks would sustain a large amount of damage."
 * Figure 8 says which angles are severe: right angles and head on, to within 5 degrees. */
static void test_two_tanks_at_20_mph_and_a_severe_angle_are_highly_damaged(void **state)
{
    uint32_t tanks = 0, by_two = 0;
    static const double angles[] = {85.0,  88.0,  89.0,  90.0,  91.0,  95.0,
                                    175.0, 178.0, 180.0, 265.0, 270.0, 275.0};
    (void)state;
    for (size_t a = 0; a < sizeof angles / sizeof angles[0]; a++) {
        for (double off = -3.0; off <= 3.0; off += 0.5) {
            uint32_t row[2];
            cross(20.0, angles[a], off, row);
            const struct event *first = fixture_event(&f, EVENT_COLLISION, 0);
            if (off == 0.0) /* their fronts meet; else a corner scrapes along the other first */
                assert_int_equal(first->collision.a.damage, DAMAGE_HIGH);
            for (int n = 0; n < 2; n++) {
                assert_int_equal(damage_of(row[n]), DAMAGE_HIGH);
                assert_int_equal(steps_rows(&f).row[row[n]].state, ENTITY_ACTIVE);
                uint32_t impacts = impacts_to_high(row[n]);
                tanks++;
                by_two += impacts == 2;
                if (impacts == 2)
                    print_message("tank %d at %g degrees, %g m late: by two impacts\n", n + 1,
                                  angles[a], off);
                assert_true(impacts <= 2);
            }
        }
    }
    print_message("%u of %u tanks are highly damaged by two impacts\n", by_two, tanks);
    assert_true(by_two <= TWO_IMPACTS_MOST);
}

static double deepest_dent(uint32_t row)
{
    struct state now = fixture_state(&f);
    double deepest = 0.0;
    for (uint32_t n = 0; n < now.head->dent_count; n++) {
        if (now.dents[n].id == now.entities.row[row].id)
            deepest = maths_max(deepest, (double)now.dents[n].plastic_m);
    }
    return deepest;
}

/* "There would probably be a large dent in both along with a severe bouncing effect if the angle of
 * impact was small." */
static void test_two_tanks_at_20_mph_and_a_smaller_angle_are_dented_and_bounce(void **state)
{
    (void)state;
    for (double off = -3.0; off <= 3.0; off += 0.5) {
        uint32_t row[2];
        cross(20.0, 45.0, off, row);
        assert_int_equal(fixture_event(&f, EVENT_COLLISION, 0)->collision.response,
                         RESPONSE_BOUNCE);
        for (int n = 0; n < 2; n++) {
            assert_in_range(damage_of(row[n]), DAMAGE_LOW, DAMAGE_MED);
            assert_true(deepest_dent(row[n]) > 0.02);
        }
    }
}

/* "Two tanks colliding, each going five miles per hour, would have a much smaller impact than a
 * tank going 40 miles per hour hitting a stopped jeep." */
static void test_two_tanks_at_5_mph_are_hardly_damaged(void **state)
{
    (void)state;
    for (double angle = 90.0; angle <= 180.0; angle += 90.0) {
        uint32_t row[2];
        cross(5.0, angle, 0.0, row);
        assert_in_range(damage_of(row[0]), DAMAGE_NONE, DAMAGE_LOW);
        assert_in_range(damage_of(row[1]), DAMAGE_NONE, DAMAGE_LOW);
    }
}

static void test_a_tank_at_40_mph_destroys_a_stopped_jeep(void **state)
{
    (void)state;
    for (double heading = 0.0; heading < 360.0; heading += 45.0) {
        steps_empty(&f);
        uint32_t tank = put("tank", -12.0, 0.0, 90.0, 40.0);
        uint32_t jeep = put("jeep", 0.0, 0.0, heading, 0.0);
        fixture_run(&f, 60);
        assert_int_equal(steps_rows(&f).row[jeep].state, ENTITY_WRECK);
        assert_int_equal(steps_rows(&f).row[tank].state, ENTITY_ACTIVE);
        assert_in_range(damage_of(tank), DAMAGE_NONE, DAMAGE_LOW);
    }
}

/* "If a tank runs directly over a tree quickly, there should only be a stump remaining." */
static void test_a_fast_tank_leaves_a_stump_and_goes_on(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "collision = { shape = \"model\"; };\n"
                     "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );\n");
    uint32_t tank = put("tank", -12.0, 0.0, 90.0, 35.0);
    fixture_run(&f, 120);
    assert_int_equal(fallen_damage(fixture_state(&f).fixed_damage[0]), DAMAGE_HIGH);
    assert_true(steps_rows(&f).row[tank].vx > 10.0);
    assert_in_range(damage_of(tank), DAMAGE_NONE, DAMAGE_LOW);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_two_tanks_at_20_mph_and_a_severe_angle_are_highly_damaged),
        TEST(test_two_tanks_at_20_mph_and_a_smaller_angle_are_dented_and_bounce),
        TEST(test_two_tanks_at_5_mph_are_hardly_damaged),
        TEST(test_a_tank_at_40_mph_destroys_a_stopped_jeep),
        TEST(test_a_fast_tank_leaves_a_stump_and_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
