/* Crowds that begin in each other part, no two of them get deeper into each other on the way, and
 * bodies that only make way for those go no farther than needed: what touches nobody that overlaps
 * has no longer way in a frame than its speed allows (thesis row 46). SEED=n draws other crowds. */
#include "collider/geometry/level_exit.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define MOST         100u
#define FRAMES       200u
#define PARTED_AFTER 150u /* frames: 2.5 s */
#define LARGE_AFTER  180u /* the same of 100 tanks within 4 m: 3 s */
#define PARTED_M     0.01 /* less counts as parted */
#define OVERLAP_M    2e-5 /* less is none */
#define JUMP_M       0.01 /* by so much a way is longer than the speed allows */
#define TOUCH_M      0.02 /* bodies nearer than this may push each other */
#define NEAR_M       0.3  /* gaps are measured up to this */
#define DEEPER_M     1e-3 /* a pair that gets deeper by more has grown */
#define SHALLOW_M    0.3  /* bodies that are deeper part as capsules, or spread */
#define GROWN_MOST   1u   /* pairs: 9 to 16 before the guard heeded them */
#define JUMPS_SHARE  3e-4 /* so many bodies jump in a frame: 2e-4 to 1e-3 did before */

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;

/* A body before the frame. */
struct looked {
    double x, z, speed_mps;
    uint32_t touches; /* union-find: those that touch it, directly or not */
};

static struct looked before[MOST];
static double gap[MOST][MOST], gap_before[MOST][MOST];
static uint32_t jumps, looks, grown;
static double worst_m, most_grown_m;
static struct level_exit way_out;

/* --- a frame -----------------------------------------------------------------------------------*/

static struct entities was; /* the rows before the frame */

/* Returns the length of the way of a body out of another in a table [m]. */
static double way_of(const struct entities *e, uint32_t i, uint32_t j)
{
    const struct body_motion *motion = &f.stepper.collider.motion;
    const struct swept_body a = body_motion_standing(motion, e, i);
    const struct swept_body b = body_motion_standing(motion, e, j);
    struct vec3 normal;
    double way_m = level_exit_of(&way_out, (struct exit_slope){0.0, 0.0}, &a, &b, &normal);
    return way_m < INFINITY ? way_m : 0.0;
}

/* Counts the pairs that are deeper than before the frame, by their pieces and by their ways out. */
static void count_grown(uint32_t count)
{
    const struct entities e = steps_rows(&f);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            double by_pieces = maths_min(gap_before[i][j], 0.0) - gap[i][j];
            if (gap[i][j] >= 0.0 || gap_before[i][j] < -SHALLOW_M || by_pieces <= DEEPER_M)
                continue;
            double longer_m = maths_min(by_pieces, way_of(&e, i, j) - way_of(&was, i, j));
            grown += longer_m > DEEPER_M;
            most_grown_m = maths_max(most_grown_m, longer_m);
        }
    }
}

/* Measures all gaps, and returns how deep the deepest overlap is [m]. */
static double measure_gaps(uint32_t count)
{
    const struct body_motion *motion = &f.stepper.collider.motion;
    const struct entities e = steps_rows(&f);
    struct swept_body body[MOST];
    double deepest = 0.0;
    for (uint32_t i = 0; i < count; i++)
        body[i] = body_motion_standing(motion, &e, i);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            double dx = e.row[j].x - e.row[i].x, dz = e.row[j].z - e.row[i].z;
            double reach = body[i].bound_m + body[j].bound_m + NEAR_M;
            gap_before[i][j] = gap[i][j];
            gap[i][j] = dx * dx + dz * dz > reach * reach
                            ? NEAR_M
                            : level_gap_least(&body[i], &body[j], 0.0, NEAR_M);
            deepest = maths_max(deepest, -gap[i][j]);
        }
    }
    return deepest;
}

static void look(uint32_t count)
{
    const struct entities e = steps_rows(&f);
    for (uint32_t i = 0; i < count; i++)
        before[i] = (struct looked){e.row[i].x, e.row[i].z, steps_speed(&f, i), i};
}

static uint32_t root_of(uint32_t i)
{
    while (before[i].touches != i)
        i = before[i].touches;
    return i;
}

/* Joins the bodies that touch before or after the frame, and marks those that touch a body that
 * overlaps another, directly or not. */
static void join(uint32_t count, bool *parts)
{
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            if (maths_min(gap[i][j], gap_before[i][j]) < TOUCH_M)
                before[root_of(j)].touches = root_of(i);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++)
            parts[root_of(i)] |= maths_min(gap[i][j], gap_before[i][j]) < -OVERLAP_M;
    }
}

/* Counts the bodies that have come farther than their speeds allow, and touch nobody that parts. */
static void count_jumps(uint32_t count)
{
    const struct entities e = steps_rows(&f);
    double dt_s = world_dt_s(&f.view.world);
    bool parts[MOST] = {false};
    join(count, parts);
    for (uint32_t i = 0; i < count; i++) {
        double dx = e.row[i].x - before[i].x, dz = e.row[i].z - before[i].z;
        double speed = maths_max(before[i].speed_mps, steps_speed(&f, i));
        double jump = sqrt(dx * dx + dz * dz) - speed * dt_s;
        looks++;
        if (jump <= JUMP_M || parts[root_of(i)])
            continue;
        jumps++;
        worst_m = maths_max(worst_m, jump);
    }
}

/* --- crowds ------------------------------------------------------------------------------------*/

static void put(uint32_t count, uint32_t kind_count, double reach_m, uint64_t *random)
{
    for (uint32_t i = 0; i < count; i++) {
        double x = 25000.0 + fixture_uniform(random, -reach_m, reach_m);
        double z = 25000.0 + fixture_uniform(random, -reach_m, reach_m);
        fixture_put(&f,
                    (struct fixture_entity){.kind = kinds[i % kind_count],
                                            .behaviour = BEHAVIOUR_HOLD,
                                            .at = {x, steps_ground_at(&f, x, z), z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
    }
}

/* Returns after how many frames nobody overlaps any more. */
static uint32_t run(uint32_t count, uint32_t kind_count, double reach_m, bool uneven,
                    uint64_t *random)
{
    uint32_t jumps_before = jumps, parted = 0;
    fixture_open(&f, "world = { seed = 1; capacity = 2048; };\n"
                     "collision = { shape = \"model\"; };\n");
    if (uneven)
        steps_ground(&f, steps_waves, NULL);
    put(count, kind_count, reach_m, random);
    fixture_continue(&f, 1); /* the ground turns them */
    double deepest = measure_gaps(count);
    for (uint32_t frame = 1; frame < FRAMES; frame++) {
        look(count);
        was = steps_rows(&f); /* the frame after the next overwrites them */
        fixture_continue(&f, 1);
        deepest = measure_gaps(count);
        count_grown(count);
        count_jumps(count);
        if (deepest >= PARTED_M)
            parted = frame;
    }
    print_message("%u within %g m%s: parted after %u frames, %u jumps, the worst so far %.1f mm\n",
                  count, reach_m, uneven ? ", uneven" : "", parted + 1, jumps - jumps_before,
                  1e3 * worst_m);
    assert_true(deepest < OVERLAP_M);
    fixture_close(&f);
    return parted + 1;
}

static void begin(void)
{
    jumps = looks = grown = 0;
    worst_m = most_grown_m = 0.0;
    assert_int_equal(level_exit_init(&way_out), 0);
}

static void test_row_46_who_makes_way_does_not_jump(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    begin();
    assert_true(run(50, 4, 0.0, false, &random) <= PARTED_AFTER);
    assert_true(run(40, 4, 10.0, false, &random) <= PARTED_AFTER);
    assert_true(run(40, 4, 10.0, true, &random) <= PARTED_AFTER);
    assert_true(run(25, 1, 6.0, false, &random) <= PARTED_AFTER);
    level_exit_free(&way_out);
    print_message("%u jumps and %u pairs that got deeper in %u looks, by %.1f mm at most\n", jumps,
                  grown, looks, 1e3 * most_grown_m);
    assert_true(jumps <= JUMPS_SHARE * looks);
    assert_true(grown <= GROWN_MOST);
}

/* One of them jumped by 79 mm while those who made way went back by quarters of their way. */
static void test_row_46_nobody_jumps_in_a_large_crowd(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    begin();
    assert_true(run(100, 4, 0.0, true, &random) <= PARTED_AFTER);
    level_exit_free(&way_out);
    assert_int_equal(jumps, 0);
}

/* Uneven crowds in which somebody leaned into a neighbour wherever he went: the first and the third
 * never parted, the second after 194 frames. A crowd that is locked becomes wider as a whole. */
static void test_row_46_no_crowd_locks(void **state)
{
    static const struct {
        uint64_t seed;
        double reach_m;
    } crowds[] = {{6, 10.0}, {18, 10.0}, {18, 5.0}};
    (void)state;
    begin();
    for (size_t i = 0; i < sizeof crowds / sizeof *crowds; i++) {
        uint64_t random = crowds[i].seed;
        assert_true(run(40, 4, crowds[i].reach_m, true, &random) <= PARTED_AFTER);
    }
    level_exit_free(&way_out);
    assert_true(grown <= GROWN_MOST);
}

/* They took 192 to 205 frames while those in the middle waited for those at the edge. */
static void test_row_46_a_hundred_tanks_part_in_3_s(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    begin();
    assert_true(run(100, 1, 4.0, false, &random) <= LARGE_AFTER);
    level_exit_free(&way_out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_who_makes_way_does_not_jump),
        cmocka_unit_test(test_row_46_nobody_jumps_in_a_large_crowd),
        cmocka_unit_test(test_row_46_no_crowd_locks),
        cmocka_unit_test(test_row_46_a_hundred_tanks_part_in_3_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
