/* Crowds that begin in each other part, and bodies that only make way for those go no farther than
 * needed: what touches nobody that overlaps has no longer way in a frame than its speed allows
 * (thesis row 46). SEED=n draws other crowds. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define MOST         50u
#define FRAMES       200u
#define PARTED_AFTER 150u  /* frames: 2.5 s */
#define PARTED_M     0.01  /* less counts as parted */
#define OVERLAP_M    2e-5  /* less is none */
#define JUMP_M       0.01  /* by so much a way is longer than the speed allows */
#define TOUCH_M      0.02  /* bodies nearer than this may push each other */
#define NEAR_M       0.3   /* gaps are measured up to this */
#define JUMPS_SHARE  0.002 /* so many bodies jump in a frame: 0.005 to 0.007 did before */

static const char *const kinds[] = {"tank", "truck", "jeep", "carrier"};

static struct fixture f;

/* A body before the frame. */
struct looked {
    double x, z, speed_mps;
    uint32_t touches; /* union-find: those that touch it, directly or not */
};

static struct looked before[MOST];
static double gap[MOST][MOST], gap_before[MOST][MOST];
static uint32_t jumps, looks;
static double worst_m;

/* --- a frame -----------------------------------------------------------------------------------*/

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
            double dx = e.x[j] - e.x[i], dz = e.z[j] - e.z[i];
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
        before[i] = (struct looked){e.x[i], e.z[i], steps_speed(&f, i), i};
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
        double dx = e.x[i] - before[i].x, dz = e.z[i] - before[i].z;
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

static void run(uint32_t count, uint32_t kind_count, double reach_m, bool uneven, uint64_t *random)
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
        fixture_continue(&f, 1);
        deepest = measure_gaps(count);
        count_jumps(count);
        if (deepest >= PARTED_M)
            parted = frame;
    }
    print_message("%u within %g m%s: parted after %u frames, %u jumps, the worst so far %.1f mm\n",
                  count, reach_m, uneven ? ", uneven" : "", parted + 1, jumps - jumps_before,
                  1e3 * worst_m);
    assert_true(parted < PARTED_AFTER && deepest < OVERLAP_M);
    fixture_close(&f);
}

static void test_row_46_who_makes_way_does_not_jump(void **state)
{
    uint64_t random = fixture_seed(1);
    (void)state;
    run(50, 4, 0.0, false, &random);
    run(40, 4, 10.0, false, &random);
    run(40, 4, 10.0, true, &random);
    run(25, 1, 6.0, false, &random);
    print_message("%u jumps in %u looks\n", jumps, looks);
    assert_true(jumps <= JUMPS_SHARE * looks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_who_makes_way_does_not_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
