/* Bodies that begin in each other part: soon, without energy, on the ground, and without pushing
 * any other two into each other (thesis row 46). SEED=n turns the vehicles. */
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define START_M      0.5  /* of overlap */
#define PARTED_M     0.01 /* less counts as parted */
#define PART_FRAMES  12
#define OVERLAP_M    2e-5 /* of bodies that did not begin in each other */
#define HELD_M       1e-6 /* off the ground at most */
#define CROWD        100
#define CROWD_FRAMES 180 /* 3 s */
#define PILE         25

#define SLEEP_FRAMES 300

#define INSIDE_FRAMES  150
#define FRAMES_A_METRE 6.0 /* 10 m/s at 60 Hz */

static struct fixture f;

static void open_world(const char *objects)
{
    char text[256];
    snprintf(text, sizeof text,
             "world = { seed = 1; capacity = 2048; };\n"
             "collision = { shape = \"model\"; };\n%s",
             objects);
    fixture_open(&f, text);
}

static uint32_t put(const char *kind, double x, double z, double vx, double vz)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {x, FIXTURE_GROUND_M, z},
                                                   .velocity = {vx, 0.0, vz}});
}

/* Lets bodies be measured before the first frame. */
static void look(void)
{
    struct response_context context;
    steps_respond(&f, &context);
    steps_respond_end(&context);
}

/* --- what is measured --------------------------------------------------------------------------*/

/* Returns the gap between a row and the other side of a pair, below 0 for an overlap [m]. */
static double gap_of(uint32_t a, uint32_t b)
{
    const struct body_motion *motion = &f.stepper.collider.motion;
    const struct entities e = steps_rows(&f);
    struct swept_body body_a = body_motion_standing(motion, &e, a);
    struct swept_body body_b = body_motion_standing(motion, &e, b);
    return level_gap_least(&body_a, &body_b, 0.0, 9.0);
}

/* Moves row a along (x, z), a unit vector, until its gap to the other is this. */
static void place_at_gap(uint32_t a, uint32_t b, double gap_m, double x, double z)
{
    struct entities e = steps_rows(&f);
    look();
    for (int n = 0; n < 200; n++) {
        double more = gap_m - gap_of(a, b);
        e.row[a].x += 0.5 * more * x;
        e.row[a].z += 0.5 * more * z;
    }
    assert_true(fabs(gap_of(a, b) - gap_m) < 1e-4);
}

static double energy_of(uint32_t count)
{
    const struct entities e = steps_rows(&f);
    double energy = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const struct kind *kind = &f.view.world.kinds[e.row[i].kind];
        double speed = steps_speed(&f, i);
        energy += 0.5 * kind->mass_kg * speed * speed +
                  0.5 * mass_properties_of(kind).moment.y * e.row[i].spin_y * e.row[i].spin_y;
    }
    return energy;
}

/* --- few bodies --------------------------------------------------------------------------------*/

/* Runs until bodies that begin START_M in each other must have parted: the energy never grows. */
static void part(const char *what, uint32_t count, uint32_t pairs, const struct pair *pair)
{
    double energy = energy_of(count), deepest = 0.0;
    uint32_t frame = 0, parted = 0;
    for (frame = 1; frame <= PART_FRAMES; frame++) {
        fixture_continue(&f, 1);
        deepest = 0.0;
        for (uint32_t i = 0; i < pairs; i++)
            deepest = maths_max(deepest, -gap_of(pair[i].a, pair[i].b));
        if (deepest >= PARTED_M)
            parted = frame;
        assert_true(energy_of(count) <= energy * (1.0 + 1e-9) + 1e-9);
    }
    print_message("%s: %.2f mm deep after %d frames, %u to part\n", what, 1e3 * deepest,
                  PART_FRAMES, parted + 1);
    assert_true(deepest < PARTED_M);
    assert_true(steps_off_the_ground(&f, count) <= HELD_M);
}

static void run_two(const char *first, const char *second, double x, double z, double speed_mps)
{
    char what[64];
    const struct pair pair = {0, 1};
    open_world("");
    put(first, 25000.0, 25000.0, 0.0, -speed_mps);
    put(second, 25000.0 + 3.0 * x, 25000.0 + 3.0 * z, 0.0, -speed_mps);
    place_at_gap(1, 0, -START_M, x, z);
    snprintf(what, sizeof what, "%s and %s at %g m/s", first, second, speed_mps);
    part(what, 2, 1, &pair);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    fixture_close(&f);
}

static void test_row_46_two_that_overlap_part(void **state)
{
    (void)state;
    run_two("tank", "tank", 1.0, 0.0, 0.0);
    run_two("tank", "tank", 0.0, 1.0, 0.0);
    run_two("tank", "tank", 1.0, 0.0, 5.0);
    run_two("tank", "jeep", 1.0, 0.0, 0.0);
    run_two("tank", "jeep", 0.0, 1.0, 0.0);
    run_two("jeep", "jeep", 0.6, 0.8, 0.0);
}

/* Two at one place part on one line, the shortest way. */
static void run_at_one_place(const char *first, const char *second, double way_m)
{
    double x = 0.0, z = 0.0, way = 0.0;
    open_world("");
    put(first, 25000.0, 25000.0, 0.0, 0.0);
    put(second, 25000.0, 25000.0, 0.0, 0.0);
    look();
    for (uint32_t frame = 0; frame < 60; frame++) {
        fixture_continue(&f, 1);
        struct entities e = steps_rows(&f);
        double dx = e.row[1].x - e.row[0].x - x, dz = e.row[1].z - e.row[0].z - z;
        way += sqrt(dx * dx + dz * dz);
        x += dx, z += dz;
    }
    print_message("%s and %s at one place: %.3f m, a way of %.3f m\n", first, second,
                  sqrt(x * x + z * z), way);
    assert_true(-gap_of(0, 1) < PARTED_M);
    assert_true(way <= way_m && way <= sqrt(x * x + z * z) * 1.01);
    fixture_close(&f);
}

static void test_row_46_two_at_one_place_part_the_shortest_way(void **state)
{
    (void)state;
    run_at_one_place("tank", "tank", 3.7);
    run_at_one_place("tank", "jeep", 3.0);
    run_at_one_place("truck", "carrier", 3.0);
}

static void test_row_46_three_in_a_row_part(void **state)
{
    const struct pair pair[] = {{0, 1}, {1, 2}};
    (void)state;
    open_world("");
    put("tank", 25000.0, 25000.0, 0.0, 0.0);
    put("tank", 25003.0, 25000.0, 0.0, 0.0);
    put("tank", 25006.0, 25000.0, 0.0, 0.0);
    place_at_gap(1, 0, -START_M, 1.0, 0.0);
    place_at_gap(2, 1, -START_M, 1.0, 0.0);
    part("three tanks", 3, 2, pair);
    fixture_close(&f);
}

static void run_object(const char *vehicle, const char *object)
{
    char text[128];
    const struct pair pair = {0, PAIR_FIXED};
    snprintf(text, sizeof text, "objects = ( { kind = \"%s\"; at = [25000.0, 25000.0]; } );\n",
             object);
    open_world(text);
    put(vehicle, 25006.0, 25000.0, 0.0, 0.0);
    place_at_gap(0, PAIR_FIXED, -START_M, 1.0, 0.0);
    part(object, 1, 1, &pair);
    fixture_close(&f);
}

static void test_row_46_a_vehicle_parts_from_an_object(void **state)
{
    (void)state;
    run_object("jeep", "tree");
    run_object("tank", "building");
}

/* A vehicle that begins anywhere within an object of several hulls leaves it on one line, at the
 * parting speed, and then stands. */
static void run_inside(const char *vehicle, const char *object, uint64_t *random)
{
    char text[128];
    double x = 25000.0 + fixture_uniform(random, -4.0, 4.0);
    double z = 25000.0 + fixture_uniform(random, -4.0, 4.0), far = 0.0, way = 0.0;
    uint32_t frames = 0;
    snprintf(text, sizeof text, "objects = ( { kind = \"%s\"; at = [25000.0, 25000.0]; } );\n",
             object);
    open_world(text);
    fixture_put(&f, (struct fixture_entity){.kind = vehicle,
                                            .at = {x, FIXTURE_GROUND_M, z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
    look();
    for (uint32_t frame = 1; frame <= INSIDE_FRAMES; frame++) {
        struct entities e = steps_rows(&f);
        double at_x = e.row[0].x, at_z = e.row[0].z;
        fixture_continue(&f, 1);
        e = steps_rows(&f);
        double moved = sqrt((e.row[0].x - at_x) * (e.row[0].x - at_x) +
                            (e.row[0].z - at_z) * (e.row[0].z - at_z));
        double now =
            sqrt((e.row[0].x - x) * (e.row[0].x - x) + (e.row[0].z - z) * (e.row[0].z - z));
        assert_true(now >= far - 1e-6);
        far = now;
        way += moved;
        if (moved > 0.0)
            frames = frame;
    }
    print_message("%s in a %s: %.2f m to leave it, %u frames\n", vehicle, object, far, frames);
    assert_true(-gap_of(0, PAIR_FIXED) < OVERLAP_M);
    assert_true(way <= far * 1.05 + 1e-3);
    assert_true(frames <= PART_FRAMES + (uint32_t)(far * FRAMES_A_METRE));
    fixture_close(&f);
}

static void test_row_46_a_vehicle_leaves_an_object_of_several_hulls(void **state)
{
    static const char *const object[] = {"building", "watertower", "bunker", "tree", "rock"};
    uint64_t random = fixture_seed(10);
    (void)state;
    for (uint32_t i = 0; i < 20; i++) {
        run_inside("jeep", object[i % 5], &random);
        run_inside("tank", object[i % 5], &random);
    }
}

/* Walls that stand in each other are one obstacle: the way leads out of both. */
static void test_row_46_a_vehicle_leaves_walls_that_are_joined(void **state)
{
    (void)state;
    open_world("objects = ( { kind = \"building\"; at = [25000.0, 25000.0]; },\n"
               "            { kind = \"building\"; at = [25010.0, 25000.0]; } );\n");
    put("jeep", 25005.0, 25001.0, 0.0, 0.0);
    look();
    fixture_continue(&f, INSIDE_FRAMES);
    assert_true(-gap_of(0, PAIR_FIXED) < OVERLAP_M && -gap_of(0, PAIR_FIXED | 1) < OVERLAP_M);
    fixture_close(&f);
}

/* --- neighbours --------------------------------------------------------------------------------*/

/* The gaps of all pairs at the start: those that overlap have to part; no other may overlap. */
struct starts {
    uint32_t count;
    double gap[CROWD][CROWD];
};

static struct starts starts;

static void note_starts(uint32_t count)
{
    look();
    starts.count = count;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++)
            starts.gap[i][j] = gap_of(i, j);
    }
}

/* Returns how deep those are in each other that did not overlap at first [m]. */
static double pushed_in(void)
{
    double deepest = 0.0;
    for (uint32_t i = 0; i < starts.count; i++) {
        for (uint32_t j = i + 1; j < starts.count; j++) {
            if (starts.gap[i][j] >= 0.0)
                deepest = maths_max(deepest, -gap_of(i, j));
        }
    }
    return deepest;
}

/* Two that overlap stand between two others that they touch; the last may stand at a wall. */
static void run_between(bool wall)
{
    double pushed = 0.0, in_wall = 0.0;
    open_world(wall ? "objects = ( { kind = \"building\"; at = [25040.0, 25000.0]; } );\n" : "");
    for (uint32_t i = 0; i < 4; i++)
        put("tank", 25000.0 + 4.0 * i, 25000.0, 0.0, 0.0);
    if (wall)
        place_at_gap(3, PAIR_FIXED, 0.003, -1.0, 0.0);
    place_at_gap(2, 3, 0.003, -1.0, 0.0);
    place_at_gap(1, 2, -START_M, -1.0, 0.0);
    place_at_gap(0, 1, 0.003, -1.0, 0.0);
    note_starts(4);
    for (uint32_t frame = 0; frame < 60; frame++) {
        fixture_continue(&f, 1);
        pushed = maths_max(pushed, pushed_in());
        in_wall = wall ? maths_max(in_wall, -gap_of(3, PAIR_FIXED)) : 0.0;
    }
    print_message(
        "between two%s: others %.3f mm in each other, %.3f mm in the wall, %.2f mm left\n",
        wall ? " and a wall" : "", 1e3 * pushed, 1e3 * in_wall, -1e3 * gap_of(1, 2));
    assert_true(pushed <= OVERLAP_M && in_wall <= OVERLAP_M);
    assert_true(-gap_of(1, 2) < PARTED_M);
    fixture_close(&f);
}

static void test_row_46_neighbours_are_pushed_aside_not_into_each_other(void **state)
{
    (void)state;
    run_between(false);
    run_between(true);
}

/* Tanks that begin within 24 m of each other push their neighbours aside, but not into others. */
static void test_row_46_a_pile_pushes_nobody_into_others(void **state)
{
    uint64_t random = fixture_seed(13);
    double pushed = 0.0, height = 0.0;
    (void)state;
    open_world("");
    for (uint32_t i = 0; i < PILE; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank",
                                            .at = {25000.0 + fixture_uniform(&random, -12.0, 12.0),
                                                   FIXTURE_GROUND_M,
                                                   25000.0 + fixture_uniform(&random, -12.0, 12.0)},
                                            .heading_rad = fixture_uniform(&random, 0.0, TWO_PI)});
    note_starts(PILE);
    for (uint32_t frame = 0; frame < CROWD_FRAMES; frame++) {
        fixture_continue(&f, 1);
        pushed = maths_max(pushed, pushed_in());
        height = maths_max(height, steps_off_the_ground(&f, PILE));
    }
    print_message("pile of %d: others %.3f mm in each other, %.2f mm left\n", PILE, 1e3 * pushed,
                  1e3 * steps_deepest(&f, PILE));
    assert_true(pushed <= OVERLAP_M);
    assert_true(steps_deepest(&f, PILE) < PARTED_M);
    assert_true(height <= HELD_M && energy_of(PILE) < 1e-9);
    fixture_close(&f);
}

static void run_crowd(bool uneven)
{
    uint64_t random = fixture_seed(46);
    double height = 0.0, fast = 0.0;
    open_world("");
    if (uneven)
        steps_ground(&f, steps_waves, NULL);
    const struct vec3 at = {25000.0, steps_ground_at(&f, 25000.0, 25000.0), 25000.0};
    for (uint32_t i = 0; i < CROWD; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = i % 3 == 0 ? "tank" : "jeep",
                                            .at = at,
                                            .heading_rad = fixture_uniform(&random, 0.0, TWO_PI)});
    for (uint32_t frame = 0; frame < CROWD_FRAMES; frame++) {
        fixture_continue(&f, 1);
        height = maths_max(height, steps_off_the_ground(&f, CROWD));
        for (uint32_t i = 0; i < CROWD; i++)
            fast = maths_max(fast, steps_speed(&f, i));
        if ((frame + 1) % 30 == 0)
            print_message("%d at one place: %.3f m deep after %u frames\n", CROWD,
                          steps_deepest(&f, CROWD), frame + 1);
    }
    assert_true(steps_deepest(&f, CROWD) < PARTED_M);
    assert_true(height <= HELD_M && fast < 1e-9);
    fixture_close(&f);
}

static void test_row_46_a_crowd_at_one_place_parts_in_3_s(void **state)
{
    (void)state;
    run_crowd(false);
    run_crowd(true);
}

/* A contact that overlapped in one frame, and was apart by more than the bodies touch in the next,
 * kept its group awake for ever. */
static void test_row_46_bodies_that_have_parted_sleep(void **state)
{
    (void)state;
    open_world("");
    for (uint32_t i = 0; i < PILE; i++)
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                .heading_rad = 3.0 * i * RAD_PER_DEG});
    fixture_continue(&f, SLEEP_FRAMES);
    print_message("%d at one place: %u contacts are solved after %d frames\n", PILE,
                  f.stepper.collider.resting.pairs, SLEEP_FRAMES);
    assert_int_equal(f.stepper.collider.resting.pairs, 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_two_that_overlap_part),
        cmocka_unit_test(test_row_46_two_at_one_place_part_the_shortest_way),
        cmocka_unit_test(test_row_46_three_in_a_row_part),
        cmocka_unit_test(test_row_46_a_vehicle_parts_from_an_object),
        cmocka_unit_test(test_row_46_a_vehicle_leaves_an_object_of_several_hulls),
        cmocka_unit_test(test_row_46_a_vehicle_leaves_walls_that_are_joined),
        cmocka_unit_test(test_row_46_neighbours_are_pushed_aside_not_into_each_other),
        cmocka_unit_test(test_row_46_a_pile_pushes_nobody_into_others),
        cmocka_unit_test(test_row_46_bodies_that_have_parted_sleep),
        cmocka_unit_test(test_row_46_a_crowd_at_one_place_parts_in_3_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
