/* Which stretches are made shorter. */
#include "collider/narrow_phase/cruise_rows.h"
#include "tests/support/steps.h"
#include "world/entity/cruise.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define WHOLE 60u /* frames of a stretch */
#define MPS   10.0

static struct fixture f;
static uint32_t tank, truck;
static struct response_context context;

static int open_with(const char *text)
{
    fixture_open(&f, text);
    tank = fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 0.0, 25000.0}});
    truck =
        fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {26000.0, 0.0, 25000.0}});
    fixture_run(&f, 1);
    steps_respond(&f, &context);
    return 0;
}

static int open_world(void **state)
{
    (void)state;
    return open_with("world = { cruise = true; };");
}

static int open_models(void **state)
{
    (void)state;
    return open_with("world = { cruise = true; }; collision = { shape = \"model\"; };");
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* Makes a row cruise from this frame on for so many frames, to a place to which it heads. turns:
 * [rad/s], gains: [m/s2]. */
static void make_cruise(uint32_t row, struct vec3 to, double heading_rad, double turns,
                        double gains)
{
    const struct entities *e = &context.next->entities;
    entities_set_position(e, row, to);
    entities_set_velocity(e, row,
                          (struct vec3){MPS * sin(heading_rad), 0.0, -MPS * cos(heading_rad)});
    e->row[row].heading = heading_rad;
    e->row[row].cruise_rps = turns;
    e->row[row].cruise_mps2 = gains;
    e->row[row].cruise_tick = (uint32_t)context.next->head->tick + WHOLE;
}

/* Returns how many frames of its stretch a row has left. */
static uint32_t left_of(uint32_t row)
{
    const uint32_t end = context.next->entities.row[row].cruise_tick;
    const uint32_t tick = (uint32_t)context.next->head->tick;
    return end > tick ? end - tick : 0;
}

/* Takes the tank and the truck as a pair. Returns true if they are one for the narrow phase. */
static bool take_pair(void)
{
    struct pair_list pairs, ends;
    assert_int_equal(pair_list_init(&pairs, 16), 0);
    assert_int_equal(pair_list_init(&ends, 16), 0);
    pair_list_add(&pairs, tank, truck);
    cruise_rows_take_pairs(&context.input, &pairs, &ends);
    bool left = pairs.count > 0;
    pair_list_free(&pairs);
    pair_list_free(&ends);
    return left;
}

/* The tank goes north and the truck west, for a second, and the truck ends its stretch so far east
 * of the middle of the tank's way. */
static void put_across(double east_m, double turns, double gains)
{
    make_cruise(tank, (struct vec3){25000.0, 0.0, 25000.0}, 0.0, turns, gains);
    make_cruise(truck, (struct vec3){25000.0 + east_m, 0.0, 25005.0}, -0.5 * M_PI, 0.0, 0.0);
}

static bool cross(double east_m, double turns, double gains)
{
    put_across(east_m, turns, gains);
    return take_pair();
}

/* While their ways are apart both go on to their ends. Of two ways that meet that of the truck,
 * which comes there last, is made shorter, the less the later that is. */
static void test_of_two_whose_ways_meet_one_goes_on(void **state)
{
    uint32_t before = WHOLE, shorter = 0;
    (void)state;
    for (double east_m = 9.0; east_m > 0.0; east_m -= 0.5) {
        assert_false(cross(east_m, 0.0, 0.0));
        assert_int_equal(left_of(tank), WHOLE);
        assert_in_range(left_of(truck), WHOLE / 4, before);
        before = left_of(truck);
        shorter += before < WHOLE;
    }
    assert_in_range(shorter, 2, 16);
}

/* What is left is not less than seven eighths of the time for which the ways are apart. */
static void test_a_stretch_goes_on_for_as_long_as_it_may(void **state)
{
    (void)state;
    assert_false(cross(4.0, 0.0, 0.0));
    const uint32_t found = left_of(truck);
    assert_true(found < WHOLE);
    uint32_t frames = found;
    for (uint32_t more = found; more <= WHOLE; more++) { /* the same way, but ended so late */
        const double back_m = MPS * (double)(WHOLE - more) / 60.0;
        put_across(4.0 + back_m, 0.0, 0.0);
        context.next->entities.row[truck].cruise_tick -= WHOLE - more;
        (void)take_pair();
        if (left_of(truck) == more)
            frames = more;
    }
    assert_in_range(found, frames - frames / 8 - 1, frames);
}

/* One that turns and gains speed would go another way if its stretch were shorter, so the other one
 * gives way. */
static void test_one_that_cannot_be_made_shorter_goes_on(void **state)
{
    (void)state;
    assert_false(cross(4.0, 0.3, 1.0));
    assert_int_equal(left_of(tank), WHOLE);
    assert_in_range(left_of(truck), WHOLE / 4, WHOLE - 1);
}

/* Where they are near already both end, and the narrow phase looks at them. */
static void test_two_that_are_near_both_end(void **state)
{
    (void)state;
    const double way_m = MPS * (double)WHOLE / 60.0;
    assert_true(cross(4.0 - way_m, 0.0, 0.0));
    assert_int_equal(left_of(tank), 0);
    assert_int_equal(left_of(truck), 0);
}

/* Two rows that have not changed since the last frame: what they meet was found before. Only a
 * process that wrote one of them then finds them as a pair once more. */
static void test_two_that_stay_are_no_pair(void **state)
{
    const struct entities *before = &context.motion->committed->entities;
    (void)state;
    put_across(4.0, 0.0, 0.0);
    entities_copy(before, &context.next->entities, tank, 1);
    entities_copy(before, &context.next->entities, truck, 1);
    assert_false(take_pair());
    assert_int_equal(left_of(tank), WHOLE);
    assert_int_equal(left_of(truck), WHOLE);
}

/* Keeps the box of a row's stretch. */
static void hold(uint32_t row)
{
    const struct path stretch = body_motion_stretch(context.motion, row);
    const struct kind *kind = &f.view.world.kinds[context.next->entities.row[row].kind];
    const struct path_box box =
        pair_filter_path_box(&stretch, pair_filter_margin(&f.view.world, kind));
    cruise_index_add(&f.stepper.collider.broad.cruise, row, &box);
}

static void meet_written(void)
{
    struct pair_list found;
    assert_int_equal(pair_list_init(&found, 16), 0);
    cruise_rows_meet_written(&context.input, &found);
    pair_list_free(&found);
}

/* A stretch that is made shorter has been written, and is not in its own way. */
static void test_a_stretch_that_is_made_shorter_goes_on(void **state)
{
    (void)state;
    put_across(4.0, 0.0, 0.0);
    hold(tank);
    hold(truck);
    assert_false(take_pair());
    const uint32_t left = left_of(truck);
    assert_in_range(left, WHOLE / 4, WHOLE - 1);
    meet_written();
    assert_int_equal(left_of(truck), left);
    assert_int_equal(left_of(tank), WHOLE);
}

/* The tank goes north for a second. The truck is so far east of the middle of that way, heads
 * there, and comes there in this frame by driving ahead. */
static void put_beside(double east_m, double heading_rad)
{
    const struct entities *before = &context.motion->committed->entities;
    const struct entities *e = &context.next->entities;
    const double way_m = 0.2;
    make_cruise(tank, (struct vec3){25000.0, 0.0, 25000.0}, 0.0, 0.0, 0.0);
    entities_set_position(e, truck, (struct vec3){25000.0 + east_m, 0.0, 25005.0});
    e->row[truck].heading = heading_rad;
    entities_copy(before, e, truck, 1);
    before->row[truck].x -= way_m * sin(heading_rad);
    before->row[truck].z += way_m * cos(heading_rad);
}

/* What moves by a frame is as narrow as what cruises, but not when it heads for it, turns its body
 * or will be turned by a collision. */
static void test_what_drives_beside_a_stretch_leaves_it(void **state)
{
    uint8_t *wider = context.broad->wider;
    (void)state;
    put_beside(5.8, 0.0);
    assert_false(take_pair());
    assert_int_equal(left_of(tank), WHOLE);
    put_beside(5.8, M_PI);
    assert_false(take_pair());
    assert_int_equal(left_of(tank), WHOLE);
    put_beside(5.8, -0.5 * M_PI);
    (void)take_pair();
    assert_in_range(left_of(tank), 0, WHOLE - 1);
    put_beside(5.8, 0.0);
    wider[truck] = 1;
    (void)take_pair();
    wider[truck] = 0;
    assert_in_range(left_of(tank), 0, WHOLE - 1);
}

/* What collisions have put beside a stretch leaves it, and what they have put into its way ends it.
 */
static void test_what_was_written_ends_what_it_is_in_the_way_of(void **state)
{
    (void)state;
    put_beside(5.8, 0.0);
    hold(tank);
    table_note(&context.writer, truck);
    meet_written();
    assert_int_equal(left_of(tank), WHOLE);
    context.next->entities.row[truck].x -= 0.6;
    meet_written();
    assert_int_equal(left_of(tank), 0);
}

#define IN_WORLD(test)    cmocka_unit_test_setup_teardown(test, open_world, close_world)
#define WITH_MODELS(test) cmocka_unit_test_setup_teardown(test, open_models, close_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_WORLD(test_of_two_whose_ways_meet_one_goes_on),
        IN_WORLD(test_a_stretch_goes_on_for_as_long_as_it_may),
        IN_WORLD(test_one_that_cannot_be_made_shorter_goes_on),
        IN_WORLD(test_two_that_are_near_both_end),
        IN_WORLD(test_two_that_stay_are_no_pair),
        IN_WORLD(test_a_stretch_that_is_made_shorter_goes_on),
        WITH_MODELS(test_what_drives_beside_a_stretch_leaves_it),
        WITH_MODELS(test_what_was_written_ends_what_it_is_in_the_way_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
