/* Where a vehicle is on its stretch. */
#include "world/entity/cruise.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define DT_S    (1.0 / 60.0)
#define ENDS    130u /* the tick at which the stretch ends */
#define EXACT_M 1e-9

static struct entities e;
static void *memory;

static int make_row(void **state)
{
    (void)state;
    memory = aligned_alloc(TABLE_ALIGN, entities_bytes(CAPACITY_MIN));
    assert_non_null(memory);
    entities_bind(&e, CAPACITY_MIN, memory);
    entities_clear(&e, 0);
    return 0;
}

static int free_row(void **state)
{
    (void)state;
    free(memory);
    return 0;
}

/* A stretch of 30 frames that ends at (1000, 50, 2000), 12 m/s, towards the east. */
static void set_stretch(double rps, double mps2)
{
    entities_set_position(&e, 0, (struct vec3){1000.0, 50.0, 2000.0});
    entities_set_velocity(&e, 0, (struct vec3){12.0, 0.5, 0.0});
    e.row[0].heading = HALF_PI;
    e.row[0].cruise_rps = rps;
    e.row[0].cruise_mps2 = mps2;
    e.row[0].cruise_tick = ENDS;
}

static void test_a_stretch_has_half_a_second(void **state)
{
    (void)state;
    assert_int_equal(cruise_frames(1.0 / 60.0), 30);
    assert_int_equal(cruise_frames(0.1), 5);
    assert_int_equal(cruise_frames(1.0 / 240.0), 120);
    assert_int_equal(cruise_frames(0.5), 1);
    assert_int_equal(cruise_frames(1.0), 1);
}

static void test_the_columns_hold_the_end(void **state)
{
    (void)state;
    set_stretch(0.3, 1.0);
    for (uint64_t tick = ENDS; tick < ENDS + 3; tick++) {
        struct vec3 at = cruise_position(&e, 0, tick, DT_S);
        assert_false(cruise_goes(&e, 0, tick));
        assert_true(at.x == 1000.0 && at.y == 50.0 && at.z == 2000.0);
        assert_true(cruise_heading(&e, 0, tick, DT_S) == HALF_PI);
        assert_true(cruise_velocity(&e, 0, tick, DT_S).x == 12.0);
    }
    assert_true(cruise_goes(&e, 0, ENDS - 1));
}

static void test_straight_on_at_one_speed(void **state)
{
    (void)state;
    set_stretch(0.0, 0.0);
    struct vec3 at = cruise_position(&e, 0, ENDS - 30, DT_S);
    assert_true(fabs(at.x - 994.0) < EXACT_M && fabs(at.y - 49.75) < EXACT_M);
    assert_true(fabs(at.z - 2000.0) < EXACT_M);
}

/* Goes forwards from a tick by steps so small that their errors do not matter. */
static struct vec3 go_on(uint64_t tick)
{
    struct vec3 at = cruise_position(&e, 0, tick, DT_S);
    double heading = cruise_heading(&e, 0, tick, DT_S);
    double left_s = cruise_left_s(&e, 0, tick, DT_S), speed = 12.0 - e.row[0].cruise_mps2 * left_s;
    const uint32_t steps = 20000;
    double dt = left_s / steps;
    for (uint32_t i = 0; i < steps; i++) {
        double middle = heading + 0.5 * e.row[0].cruise_rps * dt;
        double way = (speed + 0.5 * e.row[0].cruise_mps2 * dt) * dt;
        at.x += way * maths_sin(middle);
        at.z -= way * maths_cos(middle);
        heading += e.row[0].cruise_rps * dt;
        speed += e.row[0].cruise_mps2 * dt;
    }
    return at;
}

/* With a constant speed the arc is a circle, and exact. A change of speed on it moves its end by a
 * share of the way that is small: half of the turn times the change. */
static void test_it_turns_evenly_and_gains_speed(void **state)
{
    static const double turns[] = {0.6, -1.0, 0.0}, gains[] = {0.0, 2.5, -3.0};
    (void)state;
    for (int t = 0; t < 3; t++) {
        for (int g = 0; g < 3; g++) {
            set_stretch(turns[t], gains[g]);
            for (uint64_t tick = ENDS - 30; tick < ENDS; tick += 7) {
                struct vec3 at = go_on(tick);
                double left_s = cruise_left_s(&e, 0, tick, DT_S);
                double slack = fabs(turns[t] * gains[g]) * left_s * left_s * left_s / 12.0 + 2e-6;
                assert_true(fabs(at.x - 1000.0) <= slack && fabs(at.z - 2000.0) <= slack);
            }
        }
    }
}

/* A climb that changes evenly: its height is that of the mean climb of what is left. */
static void test_an_aircraft_climbs_ever_faster(void **state)
{
    (void)state;
    set_stretch(0.0, 0.0);
    e.row[0].cruise_climb_mps2 = 4.0f;
    for (uint64_t tick = ENDS - 30; tick < ENDS; tick += 5) {
        double left_s = cruise_left_s(&e, 0, tick, DT_S);
        double climb = cruise_velocity(&e, 0, tick, DT_S).y;
        assert_true(fabs(climb - (0.5 - 4.0 * left_s)) < EXACT_M);
        assert_true(fabs(cruise_position(&e, 0, tick, DT_S).y -
                         (50.0 - 0.5 * (climb + 0.5) * left_s)) < EXACT_M);
    }
}

static void test_velocity_and_heading_on_the_way(void **state)
{
    (void)state;
    set_stretch(0.4, 2.0);
    double heading = cruise_heading(&e, 0, ENDS - 30, DT_S);
    struct vec3 velocity = cruise_velocity(&e, 0, ENDS - 30, DT_S);
    assert_true(fabs(heading - (HALF_PI - 0.2)) < 1e-12);
    assert_true(fabs(velocity.x - 11.0 * maths_sin(heading)) < 1e-12);
    assert_true(fabs(velocity.z + 11.0 * maths_cos(heading)) < 1e-12);
}

static void test_chord(void **state)
{
    (void)state;
    for (double half = -1.0; half <= 1.0; half += 0.125) {
        double wanted = half == 0.0 ? 10.0 : 10.0 * maths_sin(half) / half;
        assert_true(fabs(cruise_chord(10.0, half) - wanted) < 1e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_stretch_has_half_a_second),
        cmocka_unit_test_setup_teardown(test_the_columns_hold_the_end, make_row, free_row),
        cmocka_unit_test_setup_teardown(test_straight_on_at_one_speed, make_row, free_row),
        cmocka_unit_test_setup_teardown(test_it_turns_evenly_and_gains_speed, make_row, free_row),
        cmocka_unit_test_setup_teardown(test_an_aircraft_climbs_ever_faster, make_row, free_row),
        cmocka_unit_test_setup_teardown(test_velocity_and_heading_on_the_way, make_row, free_row),
        cmocka_unit_test(test_chord),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
