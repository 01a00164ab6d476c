/* How fast crews drive on slopes, over earthworks, in bends and when they are thrown about, and
 * that trucks come down a mountain on their wheels. */
#include "mover/agent/driving/driving_pace.h"

#include "tests/support/steps.h"
#include "world/entity/event.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 20

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    return 0;
}

/* Puts a vehicle that drives to the east on a plane. */
static uint32_t put(const char *kind, double speed_mps, double east, double south)
{
    steps_empty(&f);
    steps_plane(&f, east, south);
    fixture_threads(&f, 1); /* which finds the slopes anew */
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind,
                                    .at = {25000.0, steps_ground_at(&f, 25000.0, 25000.0), 25000.0},
                                    .velocity = {speed_mps, 0.0, 0.0}});
}

static double pace_on(const char *kind, double speed_mps, double east, double south)
{
    struct step_context step;
    struct serial_context context;
    uint32_t row = put(kind, speed_mps, east, south);
    steps_serial_context(&f, &step, &context);
    return driving_pace(&step, row, HALF_PI);
}

static void test_level_ground_limits_nobody(void **state)
{
    (void)state;
    assert_true(pace_on("truck", 20.0, 0.0, 0.0) == INFINITY);
    assert_true(pace_on("tank", 15.0, 0.0, 0.0) == INFINITY);
    assert_true(pace_on("truck", 10.0, 0.3, 0.0) == INFINITY); /* uphill */
}

static void test_a_side_slope_limits_the_tall_more(void **state)
{
    double before = INFINITY;
    (void)state;
    for (double slope = 0.1; slope < 0.6; slope += 0.1) {
        double truck = pace_on("truck", 10.0, 0.0, slope), jeep = pace_on("jeep", 10.0, 0.0, slope);
        print_message("side slope %2.0f %%: truck %4.1f, jeep %4.1f m/s\n", 100.0 * slope, truck,
                      jeep);
        assert_true(truck <= before && truck <= jeep && truck >= 2.5);
        assert_true(fabs(truck - pace_on("truck", 10.0, 0.0, -slope)) < 1e-9);
        before = truck;
    }
    assert_true(before < 14.0);
}

static void test_a_way_down_limits_by_the_brakes(void **state)
{
    (void)state;
    double gentle = pace_on("truck", 10.0, -0.1, 0.0), steep = pace_on("truck", 10.0, -0.4, 0.0);
    print_message("way down 10 %%: %.1f m/s, 40 %%: %.1f m/s\n", gentle, steep);
    assert_true(gentle > 18.0 && gentle < INFINITY);
    assert_true(steep > 8.0 && steep < 16.0);
}

static void test_who_is_thrown_about_brakes(void **state)
{
    struct step_context step;
    struct serial_context context;
    uint32_t row = put("truck", 20.0, 0.0, 0.0);
    (void)state;
    steps_rows(&f).row[row].spin_x = 0.5;
    steps_serial_context(&f, &step, &context);
    assert_true(fabs(driving_pace(&step, row, HALF_PI) - 12.0) < 1e-9);
}

/* Opens a world with a work across the way to the east, 60 m from vehicles that start there. */
static void open_work(const char *work, double hz)
{
    char text[400];
    snprintf(
        text, sizeof text,
        "world = { seed = 1; capacity = 64; hz = %.1f; };"
        "earthworks = ( { at = [25060.0, 25000.0]; heading_deg = 90.0; width_m = 900.0; %s } );",
        hz, work);
    fixture_close(&f);
    fixture_open(&f, text);
}

/* Returns the pace of a kind with so much of a way left to the work. */
static double pace_before(const char *kind, double left_m)
{
    struct step_context step;
    struct serial_context context;
    steps_empty(&f);
    fixture_threads(&f, 1);
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {25056.0 - left_m, FIXTURE_GROUND_M, 25000.0},
                                                .velocity = {12.0, 0.0, 0.0}});
    steps_serial_context(&f, &step, &context);
    return driving_pace(&step, row, HALF_PI);
}

static void test_a_face_limits_who_can_cross_it(void **state)
{
    static const char step[] = "shape = \"table\"; length_m = 8.0; height_m = 0.85; edge_m = 0.11;";
    (void)state;
    open_work(step, HZ);
    double far_off = pace_before("tank", 30.0), near = pace_before("tank", 5.0);
    assert_true(far_off > 8.0 && far_off < 9.0 && near == 2.5);
    assert_true(pace_before("tank", 100.0) == INFINITY);
    assert_true(pace_before("tank", -20.0) == INFINITY); /* behind it */
    assert_true(pace_before("jeep", 5.0) == INFINITY);   /* it goes around */
    open_work("shape = \"trench\"; length_m = 2.4; depth_m = 1.0; edge_m = 0.14;", HZ);
    assert_true(pace_before("tank", 5.0) == INFINITY); /* it spans it */
    open_work("shape = \"trench\"; length_m = 8.0; depth_m = 0.4; edge_m = 0.06;", HZ);
    assert_true(pace_before("tank", 5.0) == 2.5);
}

/* Sends one vehicle of each kind over the work, side by side. Returns how many are over it and
 * unhurt after 40 s. */
static int count_over(const char *const *kinds, int count, double hz)
{
    int over = 0;
    steps_empty(&f);
    fixture_threads(&f, 1);
    for (int n = 0; n < count; n++) {
        const struct vec3 at = {25000.0, FIXTURE_GROUND_M, 24850.0 + 50.0 * n};
        uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kinds[n],
                                                               .at = at,
                                                               .heading_rad = HALF_PI,
                                                               .behaviour = BEHAVIOUR_PATROL});
        struct entities e = steps_rows(&f);
        e.row[row].order = BEHAVIOUR_PATROL;
        e.row[row].goal_x = 25400.0;
        e.row[row].goal_z = at.z;
    }
    fixture_run(&f, (uint32_t)(40.0 * hz));
    for (int n = 0; n < count; n++) {
        struct entities e = steps_rows(&f);
        uint32_t row = (uint32_t)n;
        print_message("%s: x %.1f, damage %d\n", kinds[n], e.row[row].x, e.row[row].damage);
        over += e.row[row].x > 25100.0 && e.row[row].damage == DAMAGE_NONE;
    }
    return over;
}

/* Agents drove at 10 to 12 m/s into steps that their kinds can climb. Tanks and carriers stood
 * there with medium damage; what is high for its length turned over at the crest of a hill. */
static void test_they_get_over_steps_and_hills_unhurt(void **state)
{
    static const char *const tracked[] = {"tank", "carrier", "howitzer", "flak"};
    static const char *const tall[] = {"jeep", "truck", "hamburger", "attack-tomato"};
    (void)state;
    for (int n = 0; n < 2; n++) {
        const double hz = n == 0 ? 10.0 : 60.0;
        open_work("shape = \"table\"; length_m = 8.0; height_m = 0.85; edge_m = 0.11;", hz);
        assert_int_equal(count_over(tracked, 4, hz), 4);
        open_work("shape = \"table\"; length_m = 60.0; height_m = 6.0; grade_percent = 40.0;", hz);
        assert_int_equal(count_over(tall, 4, hz), 4);
    }
}

/* A truck drives to the east and then on to another point. Returns its lowest speed within 40 m of
 * the corner. */
static double slowest_in_bend(const char *corner_to)
{
    char text[512];
    double least = INFINITY;
    snprintf(text, sizeof text,
             "world = { seed = 1; capacity = 64; hz = 20.0; };"
             "vehicles = ( { kind = \"truck\"; at = [24300.0, 25000.0]; heading_deg = 90.0;"
             "  speed_mps = 17.0;"
             "  route = ([25000.0, 25000.0], %s, [24600.0, 24000.0]); } );",
             corner_to);
    fixture_close(&f);
    fixture_open(&f, text);
    for (int frame = 0; frame < 60 * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        double dx = e.row[0].x - 25000.0, dz = e.row[0].z - 25000.0;
        if (dx * dx + dz * dz < 40.0 * 40.0)
            least = maths_min(least, steps_speed(&f, 0));
    }
    return least;
}

static void test_it_brakes_before_a_bend(void **state)
{
    (void)state;
    double straight = slowest_in_bend("[25400.0, 25000.0]");
    double gentle = slowest_in_bend("[25350.0, 24800.0]");
    double square = slowest_in_bend("[25000.0, 24600.0]");
    print_message("straight on %.1f, bend of 30 degrees %.1f, square one %.1f m/s\n", straight,
                  gentle, square);
    assert_true(straight > 16.0 && gentle < straight && gentle > 12.0);
    assert_true(square < 10.0 && square > 5.0);
}

/* The convoy of the scenario mount-washington, from the summit back into the valley. Five of six
 * trucks turned over in the first three minutes when they braked for nothing but obstacles. A truck
 * may slide into the one before it that waits in a bend, no harder than a walk. */
static void test_trucks_come_down_a_mountain_on_their_wheels(void **state)
{
    static char text[1024];
    (void)state;
    snprintf(
        text, sizeof text,
        "world = { seed = 1917; capacity = 64; hz = 20.0; };"
        "terrain = { source = \"file\"; file = \"%s/grounds/white-mountains.ground\"; };"
        "collision = { shape = \"model\"; };"
        "vehicles = ( { kind = \"truck\"; count = 6; formation = \"column\"; roads = true;"
        "  route = ( \"44.2706N,71.3033W\", \"44.2882N,71.2258W\", \"44.3860N,71.1760W\" ); } );",
        fixture_shipped_dir());
    fixture_close(&f);
    fixture_open(&f, text);
    double top = steps_rows(&f).row[0].y, steepest = 0.0, fastest = 0.0;
    for (int frame = 0; frame < 900 * HZ; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        for (uint32_t i = 0; i < 6; i++) {
            assert_int_equal(e.row[i].state, ENTITY_ACTIVE);
            assert_in_range(e.row[i].damage, DAMAGE_NONE, DAMAGE_LOW);
            steepest = maths_max(steepest, fabs(e.row[i].roll));
            fastest = maths_max(fastest, steps_speed(&f, i));
        }
    }
    double down = top - steps_rows(&f).row[0].y;
    print_message("%.0f m down in 15 minutes, roll up to %.0f degrees, up to %.1f m/s\n", down,
                  steepest / RAD_PER_DEG, fastest);
    assert_true(down > 1000.0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_level_ground_limits_nobody),
        TEST(test_a_side_slope_limits_the_tall_more),
        TEST(test_a_way_down_limits_by_the_brakes),
        TEST(test_a_face_limits_who_can_cross_it),
        TEST(test_they_get_over_steps_and_hills_unhurt),
        TEST(test_who_is_thrown_about_brakes),
        TEST(test_it_brakes_before_a_bend),
        TEST(test_trucks_come_down_a_mountain_on_their_wheels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
