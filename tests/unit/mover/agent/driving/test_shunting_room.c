/* Arcs and strokes between obstacles, of a vehicle as long as a truck. */
#include "mover/agent/driving/shunting_room.h"

#include "tests/support/fixture.h"
#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define CIRCLE_M 11.0

static const struct shunting_stroke ahead = {.ahead = 1.0}, back = {.ahead = -1.0};

static struct shunting_room empty_room(void)
{
    return (struct shunting_room){
        .front_m = 3.4, .rear_m = 3.4, .left_m = 1.25, .right_m = 1.25, .circle_m = CIRCLE_M};
}

static void add_wall(struct shunting_room *room, double x, double z, double half_m, double half_w)
{
    shunting_room_add(room,
                      &(struct shunting_obstacle){
                          .x = x, .z = z, .uz = -1.0, .half_m = half_m, .half_width = half_w});
}

/* A street to the north and south, of this width. */
static struct shunting_room street(double width_m)
{
    struct shunting_room room = empty_room();
    add_wall(&room, -6.0 - 0.5 * width_m, 0.0, 100.0, 6.0);
    add_wall(&room, 6.0 + 0.5 * width_m, 0.0, 100.0, 6.0);
    return room;
}

static void test_it_stops_before_a_wall(void **state)
{
    struct shunting_room room = empty_room();
    const struct shunting_pose pose = {0.0, 0.0, 0.0};
    (void)state;
    assert_true(shunting_room_free(&room, &pose, ahead, 30.0, 0.3) == 30.0);
    add_wall(&room, 0.0, -14.4, 1.0, 20.0); /* 10 m before its nose */
    const double free_m = shunting_room_free(&room, &pose, ahead, 30.0, 0.3);
    assert_true(free_m > 9.4 && free_m <= 9.7);
    assert_true(shunting_room_free(&room, &pose, back, 30.0, 0.3) == 30.0);
}

static void test_a_disc_is_round(void **state)
{
    struct shunting_room room = empty_room();
    const struct shunting_pose pose = {0.0, 0.0, 0.0};
    (void)state;
    shunting_room_add(&room,
                      &(struct shunting_obstacle){.x = 3.0, .z = 10.0, .ux = 1.0, .border_m = 1.4});
    assert_true(shunting_room_free(&room, &pose, back, 30.0, 0.3) == 30.0);
    assert_true(shunting_room_free(&room, &pose, back, 30.0, 0.4) < 6.0);
}

/* What touches a wall may go along it and away from it, and no further in. */
static void test_it_gets_away_from_what_it_touches(void **state)
{
    struct shunting_room room = street(2.5);
    const struct shunting_pose pose = {0.0, 0.0, 0.0};
    const struct shunting_stroke turn = {.ahead = 1.0, .side = 1.0};
    (void)state;
    assert_true(shunting_room_free(&room, &pose, ahead, 20.0, 0.3) == 20.0);
    assert_true(shunting_room_free(&room, &pose, turn, 20.0, 0.3) < 0.5);
}

/* Carries out the plan, each time with the first stroke of a new one. Returns the strokes; 0: it
 * does not get there. */
static int turn_about(const struct shunting_room *room, double heading_rad)
{
    struct shunting_pose pose = {0.0, 0.0, 0.0};
    struct shunting_stroke stroke;
    for (int n = 1; n < 20; n++) {
        if (!shunting_room_plan(room, &pose, heading_rad, 0.02, PI * CIRCLE_M, &stroke))
            return 0;
        const double left = maths_wrap_turn(stroke.side * (heading_rad - pose.heading_rad));
        const double way_m = shunting_room_free(room, &pose, stroke, left * CIRCLE_M, 0.4),
                     turn = way_m / CIRCLE_M;
        double sine, cosine;
        maths_sincos(pose.heading_rad + 0.5 * stroke.side * turn, &sine, &cosine);
        pose.x += stroke.ahead * 2.0 * CIRCLE_M * maths_sin(0.5 * turn) * sine;
        pose.z -= stroke.ahead * 2.0 * CIRCLE_M * maths_sin(0.5 * turn) * cosine;
        pose.heading_rad += stroke.side * turn;
        if (fabs(maths_wrap_half(pose.heading_rad - heading_rad)) < 0.02)
            return n;
    }
    return 0;
}

static void test_a_street_is_wide_enough_or_not(void **state)
{
    static const double wide[] = {60.0, 14.0, 10.0, 6.0};
    int strokes[4];
    (void)state;
    for (int n = 0; n < 4; n++) {
        const struct shunting_room room = street(wide[n]);
        strokes[n] = turn_about(&room, PI);
        print_message("# figures: %.0f m wide, %d strokes\n", wide[n], strokes[n]);
    }
    assert_int_equal(strokes[0], 1);
    assert_true(strokes[1] > 1 && strokes[2] > strokes[1]);
    assert_int_equal(strokes[3], 0);
}

static void test_the_farthest_of_many_is_left_out(void **state)
{
    struct shunting_room room = empty_room();
    const struct shunting_pose pose = {0.0, 0.0, 0.0};
    (void)state;
    for (int n = 0; n < SHUNTING_ROOM_MOST; n++)
        add_wall(&room, 100.0 + n, 0.0, 1.0, 1.0);
    add_wall(&room, 0.0, -14.4, 1.0, 1.0);
    assert_int_equal(room.count, SHUNTING_ROOM_MOST);
    assert_true(shunting_room_free(&room, &pose, ahead, 30.0, 0.3) < 10.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_stops_before_a_wall),
        cmocka_unit_test(test_a_disc_is_round),
        cmocka_unit_test(test_it_gets_away_from_what_it_touches),
        cmocka_unit_test(test_a_street_is_wide_enough_or_not),
        cmocka_unit_test(test_the_farthest_of_many_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
