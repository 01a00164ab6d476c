/* A driver who pulls up two seconds after the word does not strike the ground, and one who flies
 * level, or touches down gently, hears no word. */
#include "world/pull_up.h"

#include "tests/support/steps.h"
#include "world/entity/kind.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ      20
#define REACT   (3 * HZ / 2) /* frames from the word until the stick moves */
#define RIDGE_M 300.0

static struct fixture f;

static double ridge(double x, double z, const void *context)
{
    (void)z;
    return 100.0 + maths_clamp(*(const double *)context * (x - 25000.0), 0.0, RIDGE_M);
}

/* Puts an aircraft that is driven to the east at a height over the foot of the ridge. */
static uint32_t fly(const char *kind, double from_m, double height_m, double speed_mps,
                    double up_mps)
{
    steps_empty(&f);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {25000.0 - from_m, 100.0 + height_m, 25000.0},
                                                .velocity = {speed_mps, up_mps, 0.0},
                                                .heading_rad = HALF_PI});
    steps_rows(&f).row[row].behaviour = BEHAVIOUR_DRIVEN;
    return row;
}

static bool told(uint32_t row)
{
    struct state state = fixture_state(&f);
    return pull_up_of(&f.stepper.view->world, &state.entities, row);
}

static double throttle_of(const char *kind, double speed)
{
    const struct kind *k = steps_kind(&f, kind);
    return (speed - k->min_speed_mps) / (k->max_speed_mps - k->min_speed_mps);
}

/* Returns the seconds from the first word to when it would have struck, of one whose driver does
 * nothing; and fails if one who pulls up strikes. */
static void escapes(const char *kind, double from_m, double height_m, double speed, double up_mps)
{
    const struct kind *k = steps_kind(&f, kind);
    uint32_t row = fly(kind, from_m, height_m, speed, up_mps), frame = 0, word = 0;
    double stick = up_mps / k->climb_rate_mps;
    bool hovers = kind_hovers(k);
    assert_false(told(row));
    for (; frame < 40 * HZ && (word == 0 || frame < word + 12 * HZ); frame++) {
        bool pulls = word != 0 && frame >= word + REACT;
        steps_drive(&f, row, pulls && hovers ? 0.0 : throttle_of(kind, speed), 0.0,
                    pulls ? 1.0 : stick);
        if (word == 0 && told(row))
            word = frame;
        struct entities e = steps_rows(&f);
        if (e.row[row].damage != DAMAGE_NONE || e.row[row].state != ENTITY_ACTIVE)
            fail_msg("the %s strikes %.1f s after the word", kind, (frame - word) / (double)HZ);
    }
    assert_true(word > 0);
    print_message("%s: the word after %.1f s\n", kind, word / (double)HZ);
    row = fly(kind, from_m, height_m, speed, up_mps);
    for (frame = 0; frame < 60 * HZ && steps_rows(&f).row[row].damage == DAMAGE_NONE; frame++)
        steps_drive(&f, row, throttle_of(kind, speed), 0.0, stick);
    print_message("    strikes %.1f s after it\n", (frame - word) / (double)HZ);
    assert_true(frame > word + REACT && frame < word + 12 * HZ);
}

static void test_who_pulls_up_at_the_word_is_safe(void **state)
{
    double slope = 1.0;
    (void)state;
    steps_ground(&f, ridge, &slope);
    escapes("helicopter", 1500.0, 30.0, 60.0, 0.0);
    escapes("helicopter", 600.0, 30.0, 20.0, 0.0);
    slope = 0.3;
    steps_ground(&f, ridge, &slope);
    escapes("jet", 5000.0, 60.0, 200.0, 0.0);
    slope = 0.0;
    steps_ground(&f, ridge, &slope);
    escapes("jet", 5000.0, 1500.0, 200.0, -70.0);
    escapes("helicopter", 5000.0, 400.0, 40.0, -11.0);
}

static void test_level_flight_and_gentle_landings_need_no_word(void **state)
{
    double slope = 0.0;
    (void)state;
    steps_ground(&f, ridge, &slope);
    uint32_t row = fly("jet", 5000.0, 30.0, 250.0, 0.0);
    for (int frame = 0; frame < 10 * HZ; frame++) {
        steps_drive(&f, row, throttle_of("jet", 250.0), 0.0, 0.0);
        assert_false(told(row));
    }
    row = fly("helicopter", 5000.0, 40.0, 0.0, 0.0);
    for (int frame = 0; frame < 40 * HZ; frame++) {
        steps_drive(&f, row, 0.0, 0.0, -0.25);
        assert_false(told(row));
    }
    assert_true(steps_rows(&f).row[row].flags & ENTITY_FLAG_LANDED);
}

/* A jet that banks towards a ridge beside it, and one that banks away. */
static void test_the_present_turn_counts(void **state)
{
    double slope = 1.0;
    (void)state;
    steps_ground(&f, ridge, &slope);
    for (int side = -1; side <= 1; side += 2) {
        uint32_t row = fly("jet", 700.0, 60.0, 200.0, 0.0);
        struct entities e = steps_rows(&f);
        e.row[row].heading = 0.0;
        e.row[row].vx = 0.0;
        e.row[row].vz = -200.0;
        e.row[row].roll = 1.3 * side;
        assert_true(told(row) == (side > 0));
        e.row[row].behaviour = BEHAVIOUR_PATROL; /* an agent hears nothing */
        assert_false(told(row));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_who_pulls_up_at_the_word_is_safe),
        cmocka_unit_test(test_level_flight_and_gentle_landings_need_no_word),
        cmocka_unit_test(test_the_present_turn_counts),
    };
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };"
                     "collision = { shape = \"model\"; };");
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    fixture_close(&f);
    return failed;
}
