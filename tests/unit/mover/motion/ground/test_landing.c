/* Aircraft on the ground: touch-down, rest, take-off, harm by the sink rate, belly landings. Kinds
 * have their own models. */
#include "tests/support/steps.h"
#include "world/body_points.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 30.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 30.0; };"
                     "collision = { shape = \"model\"; };");
    return 0;
}

static void seconds(double s)
{
    fixture_run(&f, (uint32_t)(s * HZ + 0.5));
}

/* height_m: of the lowest point over the ground. */
static uint32_t put(const char *kind, double height_m, struct vec3 velocity)
{
    double low = steps_kind(&f, kind)->low_m;
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind,
                                    .at = {25000.0, FIXTURE_GROUND_M + height_m - low, 25000.0},
                                    .velocity = velocity,
                                    .heading_rad = HALF_PI,
                                    .behaviour = BEHAVIOUR_PATROL});
}

static bool is_down(uint32_t row)
{
    struct entities e = steps_rows(&f);
    return e.row[row].state == ENTITY_ACTIVE && (e.row[row].flags & ENTITY_FLAG_LANDED) != 0;
}

static double clearance(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct body_points points;
    body_points_of(&f.view.world, e.row[row].kind, &points);
    return body_points_clearance(
        &f.view.world, NULL, &points, entities_position(&e, row),
        rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
}

static void test_with_collective_down_a_helicopter_lands_softly(void **state)
{
    uint32_t row = put("helicopter", 60.0, (struct vec3){0.0, 0.0, 0.0});
    double touched_mps = 0.0;
    (void)state;
    for (int frame = 0; frame < (int)(40.0 * HZ) && !is_down(row); frame++) {
        touched_mps = -steps_rows(&f).row[row].vy;
        steps_drive(&f, row, 0.0, 0.0, -1.0);
    }
    print_message("touches down with %.2f m/s\n", touched_mps);
    assert_true(is_down(row) && touched_mps > 0.3 && touched_mps < 2.5);
    seconds(4.0);
    struct entities e = steps_rows(&f);
    double x = e.row[row].x, y = e.row[row].y, z = e.row[row].z;
    seconds(60.0);
    assert_true(is_down(row) && e.row[row].x == x && e.row[row].y == y && e.row[row].z == z);
    assert_true(steps_speed(&f, row) == 0.0 && fabs(clearance(row)) < 0.02);
    assert_true(e.row[row].harm_j == 0.0 && e.row[row].damage == DAMAGE_NONE);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

static void test_it_takes_off_again(void **state)
{
    uint32_t row = put("helicopter", 5.0, (struct vec3){0.0, 0.0, 0.0});
    double hardest = 0.0, begun_s = 0.0;
    (void)state;
    steps_drive(&f, row, 0.0, 0.0, -1.0);
    seconds(20.0);
    assert_true(is_down(row));
    for (int frame = 0; frame < (int)(15.0 * HZ); frame++) {
        double before = steps_rows(&f).row[row].vy;
        steps_drive(&f, row, 0.0, 0.0, 0.5);
        hardest = maths_max(hardest, fabs(steps_rows(&f).row[row].vy - before) * HZ);
        begun_s += clearance(row) < 0.05 ? 1.0 / HZ : 0.0;
    }
    print_message("lifts off after %.1f s, hardest acceleration %.1f m/s2\n", begun_s, hardest);
    assert_false(is_down(row));
    assert_true(clearance(row) > 20.0 && hardest < 0.65 * GRAVITY_MPS2);
    assert_true(begun_s > 0.5 && begun_s < 3.0); /* the engine spools up */
    assert_true(steps_rows(&f).row[row].damage == DAMAGE_NONE);
}

static void test_the_sink_rate_decides_on_the_harm(void **state)
{
    static const struct {
        double sink_mps;
        enum damage damage;
    } fall[] = {{2.0, DAMAGE_NONE}, {3.5, DAMAGE_NONE},  {6.0, DAMAGE_LOW},
                {8.5, DAMAGE_MED},  {11.5, DAMAGE_HIGH}, {14.0, DAMAGE_DESTROYED}};
    (void)state;
    for (int n = 0; n < 6; n++) {
        steps_empty(&f);
        uint32_t row = put("helicopter", 0.02, (struct vec3){0.0, -fall[n].sink_mps, 0.0});
        struct entities e = steps_rows(&f);
        e.row[row].behaviour = BEHAVIOUR_DRIVEN;
        e.row[row].until_tick = UINT32_MAX;
        e.row[row].climb = -1.0f;
        seconds(10.0);
        e = steps_rows(&f);
        print_message("| sinks with %4.1f m/s: damage %d |\n", fall[n].sink_mps, e.row[row].damage);
        assert_int_equal(e.row[row].damage, fall[n].damage);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION) > 0, n > 1);
        assert_true(is_down(row) == (n < 5));
    }
}

static void test_an_agents_helicopter_takes_off_when_it_can(void **state)
{
    uint32_t row = put("helicopter", 0.02, (struct vec3){0.0, -1.0, 0.0});
    (void)state;
    steps_rows(&f).row[row].fuel_l = 0.0; /* it cannot climb */
    seconds(3.0);
    assert_true(is_down(row));
    steps_rows(&f).row[row].fuel_l = 1000.0; /* now its agent wants its usual height */
    seconds(20.0);
    assert_false(is_down(row));
    assert_true(clearance(row) > 20.0);
}

static void test_on_a_slope_it_rests_and_on_a_steep_one_it_does_not(void **state)
{
    static const double slopes[2] = {0.1, 0.9};
    (void)state;
    for (int n = 0; n < 2; n++) {
        steps_empty(&f);
        steps_plane(&f, slopes[n], 0.0);
        uint32_t row = put("helicopter", 15.0, (struct vec3){0.0, 0.0, 0.0});
        steps_drive(&f, row, 0.0, 0.0, -1.0);
        seconds(40.0);
        assert_true(is_down(row) == (n == 0));
        assert_true(n == 1 || (steps_speed(&f, row) == 0.0 && fabs(clearance(row)) < 0.02));
        assert_true(n == 0 || steps_rows(&f).row[row].state == ENTITY_WRECK);
    }
    steps_plane(&f, 0.0, 0.0);
}

/* A jet without wheels slides on its belly, and stops. */
static void test_a_jet_slides_on_its_belly(void **state)
{
    uint32_t row = put("jet", 1.0, (struct vec3){85.0, -1.0, 0.0});
    double hardest = 0.0;
    (void)state;
    for (int frame = 0; frame < (int)(60.0 * HZ); frame++) {
        struct entities e = steps_rows(&f);
        struct vec3 before = entities_velocity(&e, row);
        steps_drive(&f, row, 0.0, 0.0, 0.0);
        e = steps_rows(&f);
        struct vec3 change = vec3_sub(entities_velocity(&e, row), before);
        hardest = maths_max(hardest, vec3_length(change) * HZ / GRAVITY_MPS2);
    }
    double slid = steps_rows(&f).row[row].x - 25000.0;
    print_message("| belly landing with 85 m/s: slides %.0f m, hardest %.1f g |\n", slid, hardest);
    assert_true(is_down(row) && steps_speed(&f, row) == 0.0);
    assert_true(slid > 200.0 && slid < 900.0 && hardest < 8.0);
    assert_true(steps_rows(&f).row[row].damage >= DAMAGE_MED);
    steps_drive(&f, row, 1.0, 0.0, 1.0); /* it does not fly again */
    seconds(5.0);
    assert_true(steps_speed(&f, row) == 0.0);
}

static void test_water_is_no_place_to_land(void **state)
{
    uint32_t row = put("helicopter", 5.0, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    steps_cover(&f, COVER_LAKE, 24000.0, 24000.0, 26000.0, 26000.0);
    steps_drive(&f, row, 0.0, 0.0, -1.0);
    seconds(20.0);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_WRECK);
    steps_cover(&f, COVER_GRASS, 24000.0, 24000.0, 26000.0, 26000.0);
}

/* What is on the ground is pushed as a body, and rests again. */
static void test_a_truck_pushes_a_landed_helicopter(void **state)
{
    uint32_t row = put("helicopter", 0.5, (struct vec3){0.0, 0.0, 0.0});
    (void)state;
    steps_drive(&f, row, 0.0, 0.0, -1.0);
    seconds(5.0);
    assert_true(is_down(row));
    double x = steps_rows(&f).row[row].x;
    uint32_t truck =
        fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                .at = {24975.0, FIXTURE_GROUND_M, 25000.0},
                                                .velocity = {6.0, 0.0, 0.0},
                                                .behaviour = BEHAVIOUR_IDLE});
    seconds(1.0);
    for (int n = 0; n < 4; n++) {
        steps_drive(&f, truck, 0.5, 0.0, 0.0);
        seconds(1.0);
    }
    steps_drive(&f, truck, 0.0, 0.0, 0.0);
    seconds(10.0);
    struct entities e = steps_rows(&f);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) > 0);
    assert_true(fabs(e.row[row].x - x) > 0.01 && fabs(clearance(row)) < 0.05);
    assert_true(steps_speed(&f, row) < 0.05);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_with_collective_down_a_helicopter_lands_softly),
        TEST(test_it_takes_off_again),
        TEST(test_the_sink_rate_decides_on_the_harm),
        TEST(test_an_agents_helicopter_takes_off_when_it_can),
        TEST(test_on_a_slope_it_rests_and_on_a_steep_one_it_does_not),
        TEST(test_a_jet_slides_on_its_belly),
        TEST(test_water_is_no_place_to_land),
        TEST(test_a_truck_pushes_a_landed_helicopter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
