/* Firing tables: published figures, and rounds that pass through the point they were aimed at. */
#include "mover/weapon/firing_table.h"

#include "mover/motion/projectile.h"
#include "mover/weapon/turret.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint16_t kind_of(const char *name)
{
    return kind_find(f.view.world.kinds, f.view.world.counts.kinds, name);
}

static struct firing_data at_sea_level(const char *name, double range_m)
{
    return firing_table_at(&f.stepper.mover.firing_tables[kind_of(name)], range_m, 0.0);
}

/* A sabot round of 1,500 m/s, and 12.7 mm ball of 890 m/s. */
static void test_times_of_flight_are_the_published_ones(void **state)
{
    (void)state;
    assert_true(fabs(at_sea_level("shell", 2000.0).flight_s / 1.40 - 1.0) < 0.01);
    assert_true(fabs(at_sea_level("bullet", 1000.0).flight_s / 1.53 - 1.0) < 0.01);
    assert_true(at_sea_level("shell", 0.0).flight_s == 0.0);
}

/* Returns how far a round passes from the point `to` from its muzzle, when it is aimed there. */
static double miss_m(const char *name, double height_m, struct vec3 to)
{
    const struct step_context context = {.world = &f.view.world,
                                         .wind = projectile_wind(f.view.world.params),
                                         .firing_tables = f.stepper.mover.firing_tables};
    const struct vec3 muzzle = {25000.0, height_m, 25000.0}, point = vec3_add(muzzle, to);
    struct vec3 lead = turret_lead_point(&context, muzzle, kind_of(name), point);
    double speed = steps_kind(&f, name)->max_speed_mps, least = INFINITY;
    uint32_t row = fixture_put(
        &f,
        (struct fixture_entity){.kind = name, .at = muzzle, .velocity = vec3_scale(lead, speed)});
    struct vec3 before = muzzle;
    for (int frame = 0; frame < 600; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        if (e.row[row].state == ENTITY_FREE)
            break;
        struct vec3 now = entities_position(&e, row), way = vec3_sub(now, before);
        double share = vec3_dot(vec3_sub(point, before), way) / vec3_dot(way, way);
        struct vec3 near = vec3_add(before, vec3_scale(way, maths_clamp(share, 0.0, 1.0)));
        least = maths_min(least, vec3_length(vec3_sub(point, near)));
        before = now;
    }
    return least;
}

static void test_rounds_pass_through_the_point_at_any_height(void **state)
{
    static const struct {
        const char *kind;
        double range_m, most_m;
    } shot[] = {{"shell", 500.0, 0.01},  {"shell", 2500.0, 0.1}, {"bullet", 300.0, 0.01},
                {"bullet", 1500.0, 0.5}, {"burst", 2000.0, 0.5}, {"rocket", 2500.0, 1.0}};
    (void)state;
    for (size_t n = 0; n < sizeof shot / sizeof shot[0]; n++) {
        for (int high = 0; high < 2; high++) {
            double r = shot[n].range_m;
            const struct vec3 to = {0.6 * r, high ? 0.1 * r : -20.0, -0.8 * r};
            double miss = miss_m(shot[n].kind, high ? 2500.0 : 800.0, to);
            if (miss > shot[n].most_m)
                fail_msg("%s at %g m, %s: misses by %g m", shot[n].kind, r, high ? "high" : "low",
                         miss);
        }
    }
}

/* A wind of 10 m/s from the side and ahead carries a bullet 6 m aside on 1,500 m. */
static void test_gunners_allow_for_wind(void **state)
{
    static const struct {
        const char *kind;
        double range_m, most_m;
    } shot[] = {{"shell", 2500.0, 0.3}, {"heat", 2000.0, 0.5}, {"bullet", 1500.0, 1.0}};
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; wind_mps = 10; wind_from_deg = 250; };");
    for (size_t n = 0; n < sizeof shot / sizeof shot[0]; n++) {
        double r = shot[n].range_m;
        double miss = miss_m(shot[n].kind, 800.0, (struct vec3){0.6 * r, -20.0, -0.8 * r});
        if (miss > shot[n].most_m)
            fail_msg("%s at %g m: misses by %g m", shot[n].kind, r, miss);
    }
}

static void test_a_round_that_has_stopped_flies_no_farther(void **state)
{
    double drop = 0.0, flight = 0.0;
    (void)state;
    for (double range = 0.0; range < 30000.0; range += 333.0) {
        struct firing_data data = at_sea_level("bullet", range);
        assert_true(isfinite(data.flight_s) && isfinite(data.drop_m));
        assert_true(range == 0.0 || (data.flight_s > flight && data.drop_m > drop));
        flight = data.flight_s, drop = data.drop_m;
    }
}

static void test_what_has_no_drag_needs_no_table(void **state)
{
    struct kind *kind = steps_kind(&f, "shell");
    (void)state;
    kind->drag = DRAG_NONE;
    struct firing_data data = at_sea_level("shell", 3000.0);
    assert_true(data.flight_s == 2.0 && fabs(data.drop_m - 2.0 * GRAVITY_MPS2) < 1e-12);
    assert_true(at_sea_level("missile", 3000.0).drop_m == 0.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_times_of_flight_are_the_published_ones),
        TEST(test_rounds_pass_through_the_point_at_any_height),
        TEST(test_gunners_allow_for_wind),
        TEST(test_a_round_that_has_stopped_flies_no_farther),
        TEST(test_what_has_no_drag_needs_no_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
