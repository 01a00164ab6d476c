/* The guard at the end of a frame: which bodies it sends back, and how far. */
#include "collider/guard/end_guard.h"

#include "collider/geometry/level_gap.h"
#include "tests/support/steps.h"
#include "world/vehicle_shell.h"

#include <string.h>

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS    4u
#define WEST_M  25000.0
#define BANK_M  25035.0 /* the foot of its western face */
#define SLACK_M 1.1e-5

static struct fixture f;
static struct response_context context;
static double side_by_side; /* [m] between the positions of tanks that touch */

/* Tanks that head north in a row from west to east, with 5 cm between their tracks. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"building\"; at = [24986.0, 25000.0]; } );"
                     "earthworks = ( { shape = \"table\"; at = [25040.0, 25000.0]; length_m = 12.0;"
                     " width_m = 10.0; height_m = 2.0; edge_m = 0.25; } );"
                     "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f, (struct fixture_entity){
                            .kind = "tank", .at = {WEST_M + 4.5 * i, FIXTURE_GROUND_M, 25000.0}});
    for (uint32_t i = 0; i < ROWS; i++)
        steps_rows(&f).row[i].behaviour = BEHAVIOUR_IDLE;
    steps_respond(&f, &context);
    side_by_side = 4.5 - steps_gap(&f, &context.next->entities, 0, 1);
    steps_respond_end(&context);
    for (uint32_t i = 0; i < ROWS; i++)
        steps_rows(&f).row[i].x = WEST_M + (side_by_side + 0.05) * i;
    fixture_state(&f).head->tick = 10;
    steps_respond(&f, &context);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static struct entities *next(void)
{
    return &context.next->entities;
}

static const struct entities *committed(void)
{
    return &context.motion->committed->entities;
}

static void move(uint32_t row, double east_m)
{
    next()->row[row].x += east_m;
    next()->row[row].vx = 60.0 * east_m;
    body_motion_compute(context.motion, row);
}

static void pair(uint32_t a, uint32_t b)
{
    contact_queue_pair(context.contacts, &(struct pair){a, b});
}

/* Runs the guard after the resting contacts have moved these rows. */
static void run(uint32_t count, const uint32_t *rows)
{
    uint32_t moved[ROWS];
    memcpy(moved, rows, count * sizeof *rows);
    end_guard_run(&f.stepper.collider.guard,
                  &(struct resting){.moved = moved, .moved_count = count}, &f.stepper.collider.free,
                  &context);
}

/* --- what goes back ----------------------------------------------------------------------------*/

static void test_bodies_that_do_not_meet_are_left_alone(void **state)
{
    (void)state;
    pair(0, 1);
    pair(1, 2);
    move(0, 0.04);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M + 0.04 && next()->row[0].vx == 60.0 * 0.04);
    assert_true(next()->row[1].x == committed()->row[1].x);
}

static void test_a_body_that_ends_in_another_goes_back_by_half(void **state)
{
    (void)state;
    pair(0, 1);
    pair(1, 2);
    move(0, 0.08);
    run(1, (uint32_t[]){0});
    assert_true(fabs(next()->row[0].x - WEST_M - 0.04) < 1e-9); /* both went back once */
    assert_true(fabs(next()->row[0].vx - 30.0 * 0.08) < 1e-9);
    assert_true(next()->row[1].x == committed()->row[1].x &&
                next()->row[2].x == committed()->row[2].x);
    assert_true(steps_gap(&f, next(), 0, 1) > 0.0);
}

static void test_at_last_it_goes_back_all_the_way(void **state)
{
    (void)state;
    pair(0, 1);
    move(0, 1.5); /* an eighth of it is still too far */
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M && next()->row[0].vx == 0.0);
}

/* Two tanks move east, the one behind faster. */
static void follow(double behind_m, double before_m)
{
    uint32_t rests = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    contact_queue_rested(context.contacts, rests)->normal_x = 1.0;
    move(0, behind_m);
    move(1, before_m);
    run(2, (uint32_t[]){0, 1});
    assert_true(steps_gap(&f, next(), 0, 1) > -SLACK_M);
}

static void test_the_body_that_follows_goes_back_before_the_other(void **state)
{
    (void)state;
    follow(0.2, 0.1);
    assert_true(fabs(next()->row[0].x - WEST_M - 0.1) < 1e-9);
    assert_true(next()->row[1].x == committed()->row[1].x + 0.1 && next()->row[1].vx == 60.0 * 0.1);
}

/* One that leaves goes back, too, if the follower alone is not enough: it turned into him. */
static void test_the_other_goes_back_when_the_follower_is_back(void **state)
{
    (void)state;
    next()->row[1].heading = 0.5;
    follow(0.001, 0.001);
    assert_true(next()->row[0].x == WEST_M && next()->row[1].x < committed()->row[1].x + 0.001);
    assert_true(next()->row[1].heading < 0.5);
}

/* Two bodies that stand still because the guard has put one back hold each other. */
static void test_the_contact_that_keeps_a_body_in_its_place_is_marked(void **state)
{
    uint32_t rests = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    (void)state;
    context.contacts->marks[rests] |= CONTACT_RESTS;
    move(0, 1.5);
    run(1, (uint32_t[]){0});
    assert_true(context.contacts->marks[rests] & CONTACT_HOLDS);
}

static void test_a_contact_of_a_body_that_keeps_a_part_of_its_way_is_not_marked(void **state)
{
    uint32_t rests = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    (void)state;
    context.contacts->marks[rests] |= CONTACT_RESTS;
    move(0, 0.08);
    run(1, (uint32_t[]){0});
    assert_false(context.contacts->marks[rests] & CONTACT_HOLDS);
}

/* Nothing has moved the first tank but its driver. */
static void assert_looked_at(void)
{
    move(0, 0.08);
    run(0, (uint32_t[]){0});
    assert_true(fabs(next()->row[0].x - WEST_M - 0.04) < 1e-9);
    assert_true(steps_gap(&f, next(), 0, 1) > 0.0);
}

/* Resting pairs are not swept, so the guard looks at them even if no contact has moved them. */
static void test_bodies_of_resting_pairs_are_looked_at(void **state)
{
    uint32_t rests = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    (void)state;
    context.contacts->marks[rests] |= CONTACT_RESTS;
    assert_looked_at();
}

/* An impact that gives no impulse changes no path, and is the last of its pair in the frame. */
static void test_bodies_that_have_met_are_looked_at(void **state)
{
    uint32_t met = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    (void)state;
    context.contacts->met[met] = 1;
    assert_looked_at();
}

/* A wreck that rolls over into its neighbour stops with its whole pose and motion. */
static void test_a_wreck_goes_back_in_its_whole_pose(void **state)
{
    struct entities *e = next();
    (void)state;
    pair(0, 1);
    e->row[0].state = ENTITY_WRECK;
    e->row[0].roll = 0.3;
    e->row[0].y += 0.02;
    e->row[0].vy = 0.6;
    e->row[0].spin_z = 0.9;
    body_motion_compute(context.motion, 0);
    run(1, (uint32_t[]){0});
    assert_true(e->row[0].roll == committed()->row[0].roll || fabs(e->row[0].roll) < 0.16);
    assert_true(fabs(e->row[0].y - committed()->row[0].y) < 0.011);
    assert_true(e->row[0].vy <= 0.3 && e->row[0].spin_z <= 0.45);
}

/* A tank on its springs leaves its neighbour and turns into it, by more than an eighth of it
 * allows.
 */
static void leave_and_turn(double throttle)
{
    pair(0, 1);
    next()->row[0].flags |= ENTITY_FLAG_CHASSIS;
    next()->row[0].throttle = (float)throttle;
    next()->row[0].heading = 0.4;
    next()->row[0].spin_y = 24.0;
    move(0, -0.08);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].heading == committed()->row[0].heading);
    assert_true(next()->row[0].spin_y == 0.0);
}

static void test_a_vehicle_that_drives_goes_back_by_its_turn_alone(void **state)
{
    (void)state;
    leave_and_turn(-0.5);
    assert_true(fabs(next()->row[0].x - WEST_M + 0.01) < 1e-9);
    assert_true(fabs(next()->row[0].vx + 7.5 * 0.08) < 1e-9);
}

static void test_a_vehicle_that_does_not_drive_goes_back_all_the_way(void **state)
{
    (void)state;
    leave_and_turn(0.0);
    assert_true(next()->row[0].x == WEST_M && next()->row[0].vx == 0.0);
}

/* One that drives into its neighbour is put back, as any other. */
static void test_a_vehicle_that_drives_ends_no_deeper(void **state)
{
    (void)state;
    pair(0, 1);
    next()->row[0].flags |= ENTITY_FLAG_CHASSIS;
    next()->row[0].throttle = 1.0F;
    move(0, 1.5);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M && next()->row[0].vx == 0.0);
}

/* The third tank follows the second, which has to go back; the fourth is out of it. */
static void test_a_body_that_went_back_can_send_back_the_next(void **state)
{
    (void)state;
    pair(0, 1);
    pair(1, 2);
    pair(2, 3);
    move(0, 1.5);
    move(2, -0.04);
    move(1, -0.04);
    run(3, (uint32_t[]){0, 1, 2});
    for (uint32_t i = 0; i + 1 < ROWS; i++)
        assert_true(steps_gap(&f, next(), i, i + 1) >= -SLACK_M);
    assert_true(next()->row[0].x == WEST_M && next()->row[3].x == committed()->row[3].x);
}

static void test_a_driver_who_holds_the_course_keeps_its_speed(void **state)
{
    (void)state;
    next()->row[0].behaviour = BEHAVIOUR_HOLD;
    pair(0, 1);
    move(0, 1.5);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M && next()->row[0].vx == 90.0);
}

/* An impact in the frame in which it appears has pressed it down. */
static void test_a_new_vehicle_stands_on_the_ground(void **state)
{
    (void)state;
    steps_replace(&f, &context, 2, 99);
    next()->row[2].y -= 0.03;
    run(1, (uint32_t[]){2});
    assert_true(next()->row[2].y == FIXTURE_GROUND_M);
}

/* Puts the last tank beside the bank, on its springs, and moves it to the east in the frame. */
static void move_beside_bank(double gap_m, double east_m)
{
    struct entities w = steps_rows(&f);
    w.row[3].x = next()->row[3].x = BANK_M - 0.5 * steps_kind(&f, "tank")->width_m - gap_m;
    w.row[3].flags = next()->row[3].flags = next()->row[3].flags | ENTITY_FLAG_CHASSIS;
    body_motion_compute(context.motion, 3);
    move(3, east_m);
    run(1, (uint32_t[]){3});
}

static double depth_in_bank(const struct entities *e)
{
    const struct mat3 turn =
        rotation_matrix(rotation_of(e->row[3].heading, e->row[3].pitch, e->row[3].roll));
    return vehicle_shell_depth(&f.view.world.terrain, NULL, steps_kind(&f, "tank"),
                               VEHICLE_SHELL_POINTS, entities_position(e, 3), &turn);
}

/* Other bodies push a vehicle on its springs against a wall of the ground. */
static void test_no_vehicle_ends_deeper_in_a_bank(void **state)
{
    (void)state;
    move_beside_bank(0.05, 0.03);
    assert_true(next()->row[3].x == committed()->row[3].x + 0.03); /* not as far as the bank */
    move_beside_bank(0.05, 0.3);
    assert_true(next()->row[3].x > committed()->row[3].x &&
                next()->row[3].x < committed()->row[3].x + 0.1);
    assert_true(depth_in_bank(next()) < 0.0101);
}

/* What is deep in a bank, because a bomb has thrown it there, may leave it. */
static void test_a_vehicle_may_leave_a_bank(void **state)
{
    (void)state;
    move_beside_bank(-0.15, 0.02);
    assert_true(depth_in_bank(committed()) > 0.05);
    assert_true(next()->row[3].x == committed()->row[3].x);
    move_beside_bank(-0.15, -0.02);
    assert_true(next()->row[3].x == committed()->row[3].x - 0.02);
}

/* --- what stays --------------------------------------------------------------------------------*/

static void overlap(double depth_m)
{
    struct entities w = steps_rows(&f);
    w.row[1].x = next()->row[1].x = WEST_M + side_by_side - depth_m;
    body_motion_compute(context.motion, 1);
    pair(0, 1);
}

static void test_an_overlap_may_last_but_not_grow(void **state)
{
    (void)state;
    overlap(0.01);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M);
    move(0, 0.005);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M); /* no half of it is allowed */
    move(0, -0.005);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M - 0.005);
}

/* Level normals overstate how deep a slanted gun is: a pair that does not part is held. Bodies that
 * part get no deeper, either, unless they are so deep that only their capsules say where they go.
 */
static void test_deep_overlaps_have_to_part_first(void **state)
{
    (void)state;
    overlap(2.0 * RESTING_PARTS_M);
    move(0, 0.005);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M);
    context.contacts->marks[0] |= CONTACT_PARTS;
    move(0, 0.005);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M);
    context.contacts->marks[0] |= CONTACT_CAPSULES;
    move(0, 0.005);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M + 0.005);
}

/* A tank leaves its springs: it loses the pitch that they gave it, and drives into its neighbour.
 * The guard puts it back onto them. */
static void test_a_vehicle_that_goes_back_stays_on_its_springs(void **state)
{
    struct entities before = steps_rows(&f);
    (void)state;
    pair(0, 1);
    before.row[0].flags |= ENTITY_FLAG_CHASSIS;
    before.row[0].pitch = 0.0004;
    move(0, 1.5);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].flags & ENTITY_FLAG_CHASSIS);
    assert_true(next()->row[0].x == WEST_M && next()->row[0].pitch == 0.0004);
}

/* The second tank is deep in the first, which gives way, but not into the house. */
static void test_a_body_that_parts_from_another_is_stopped_by_a_wall(void **state)
{
    double free_m = steps_gap(&f, next(), 0, PAIR_FIXED);
    (void)state;
    assert_true(free_m > 0.1 && free_m < 8.0);
    overlap(2.0 * RESTING_PARTS_M);
    context.contacts->marks[0] |= CONTACT_PARTS;
    pair(0, PAIR_FIXED);
    move(0, -free_m - 0.1);
    run(1, (uint32_t[]){0});
    assert_true(fabs(next()->row[0].x - (WEST_M - 0.5 * (free_m + 0.1))) < 1e-9);
}

static void test_a_new_body_is_not_sent_back(void **state)
{
    (void)state;
    pair(0, 1);
    next()->row[0].id = 80;
    move(0, 0.2);
    run(1, (uint32_t[]){0});
    assert_true(next()->row[0].x == WEST_M + 0.2);
}

/* --- order -------------------------------------------------------------------------------------*/

static void test_the_order_of_rows_and_pairs_does_not_matter(void **state)
{
    static const uint32_t rows[3][ROWS] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
    static const uint32_t pairs[3][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
    double x[3][ROWS], vx[3][ROWS];
    (void)state;
    for (int order = 0; order < 3; order++) {
        steps_respond_end(&context);
        steps_respond(&f, &context);
        for (int i = 0; i < 3; i++)
            pair(pairs[order][i], pairs[order][i] + 1);
        move(0, 0.3);
        move(1, -0.2);
        move(2, 0.11);
        move(3, -0.4);
        run(ROWS, rows[order]);
        for (uint32_t i = 0; i < ROWS; i++) {
            x[order][i] = next()->row[i].x;
            vx[order][i] = next()->row[i].vx;
        }
        assert_memory_equal(x[order], x[0], sizeof x[0]);
        assert_memory_equal(vx[order], vx[0], sizeof vx[0]);
        for (uint32_t i = 0; i + 1 < ROWS; i++)
            assert_true(steps_gap(&f, next(), i, i + 1) >= -SLACK_M);
    }
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_bodies_that_do_not_meet_are_left_alone),
        TEST(test_a_body_that_ends_in_another_goes_back_by_half),
        TEST(test_at_last_it_goes_back_all_the_way),
        TEST(test_the_body_that_follows_goes_back_before_the_other),
        TEST(test_the_other_goes_back_when_the_follower_is_back),
        TEST(test_the_contact_that_keeps_a_body_in_its_place_is_marked),
        TEST(test_a_contact_of_a_body_that_keeps_a_part_of_its_way_is_not_marked),
        TEST(test_bodies_of_resting_pairs_are_looked_at),
        TEST(test_bodies_that_have_met_are_looked_at),
        TEST(test_a_wreck_goes_back_in_its_whole_pose),
        TEST(test_a_vehicle_that_drives_goes_back_by_its_turn_alone),
        TEST(test_a_vehicle_that_does_not_drive_goes_back_all_the_way),
        TEST(test_a_vehicle_that_drives_ends_no_deeper),
        TEST(test_a_body_that_went_back_can_send_back_the_next),
        TEST(test_a_new_vehicle_stands_on_the_ground),
        TEST(test_no_vehicle_ends_deeper_in_a_bank),
        TEST(test_a_vehicle_may_leave_a_bank),
        TEST(test_a_driver_who_holds_the_course_keeps_its_speed),
        TEST(test_an_overlap_may_last_but_not_grow),
        TEST(test_deep_overlaps_have_to_part_first),
        TEST(test_a_vehicle_that_goes_back_stays_on_its_springs),
        TEST(test_a_body_that_parts_from_another_is_stopped_by_a_wall),
        TEST(test_a_new_body_is_not_sent_back),
        TEST(test_the_order_of_rows_and_pairs_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
