/* Heaps of vehicles that press on each other: they do not interpenetrate, they stay on the ground,
 * and a contact is reported when it begins and when it ends (thesis rows 36, 39, 46). SEED=n turns
 * the rings. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define SPACING_M    9.0
#define OVERLAP_M    2e-5 /* at most, at a frame's end */
#define HELD_M       0.02 /* off the ground at most: they are on their springs */
#define TOLD_MOST    1.75 /* collisions told for a pair in contact ... */
#define TOLD_MOST_90 1.25 /* ... and in a heap of 90, in which few bounce apart */

static struct fixture f;

static void open_world(double hz)
{
    char text[128];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 1024; };\n"
             "collision = { shape = \"model\"; };\n",
             hz);
    fixture_open(&f, text);
}

/* --- rings -------------------------------------------------------------------------------------*/

/* Puts tanks in rings around a place, all driving inwards. */
static void put_rings(uint32_t count, double turned)
{
    uint32_t placed = 0;
    for (uint32_t ring = 1; placed < count; ring++) {
        uint32_t here = (uint32_t)(TWO_PI * ring);
        for (uint32_t i = 0; i < here && placed < count; i++, placed++) {
            double sine, cosine, radius = SPACING_M * ring;
            maths_sincos(turned + TWO_PI * i / here, &sine, &cosine);
            fixture_put(&f,
                        (struct fixture_entity){.kind = "tank",
                                                .at = {25000.0 + radius * sine, FIXTURE_GROUND_M,
                                                       25000.0 - radius * cosine},
                                                .velocity = {-10.0 * sine, 0.0, 10.0 * cosine}});
        }
    }
}

/* Lets their engines push at full throttle. They cannot be destroyed. */
static void let_push(uint32_t count)
{
    struct entities e = steps_rows(&f);
    steps_kind(&f, "tank")->resistance_j = 1e12;
    for (uint32_t i = 0; i < count; i++) {
        e.row[i].behaviour = BEHAVIOUR_DRIVEN;
        e.row[i].until_tick = UINT32_MAX;
        e.row[i].throttle = 1.0f;
    }
    fixture_forget_copies(&f);
}

static void push_rings(uint32_t count, double hz, double seconds, uint64_t seed)
{
    open_world(hz);
    put_rings(count, fixture_uniform(&seed, 0.0, 1.0));
    let_push(count);
    double overlap = 0.0, height = 0.0;
    for (uint32_t frame = 0; frame < (uint32_t)(seconds * hz); frame++) {
        fixture_continue(&f, 1);
        overlap = maths_max(overlap, steps_deepest(&f, count));
        height = maths_max(height, steps_off_the_ground(&f, count));
    }
    struct state now = fixture_state(&f);
    double told = (double)now.head->tally.collisions / now.head->contact_count;
    print_message("%u tanks at %g Hz: overlap %.3f mm, off the ground %.1e m, %u in contact, "
                  "%.1f collisions a pair\n",
                  count, hz, 1e3 * overlap, height, now.head->contact_count, told);
    assert_true(overlap <= OVERLAP_M);
    assert_true(height <= HELD_M);
    assert_true(now.head->contact_count >= count / 2);
    assert_true(told <= (count < 90 ? TOLD_MOST : TOLD_MOST_90));
    fixture_close(&f);
}

static void test_rows_36_46_rings_press_without_overlap(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(36);
    push_rings(24, 60.0, 6.0, seed);
    push_rings(24, 10.0, 6.0, seed);
    push_rings(90, 60.0, 4.0, seed);
}

/* --- threads -----------------------------------------------------------------------------------*/

#define THREAD_FRAMES 150

/* Runs a heap that strikes together, and keeps the digest of each frame. */
static void run_on_threads(uint32_t threads, uint64_t seed, uint64_t digest[THREAD_FRAMES])
{
    open_world(60.0);
    put_rings(90, fixture_uniform(&seed, 0.0, 1.0));
    fixture_threads(&f, threads);
    let_push(90);
    for (uint32_t frame = 0; frame < THREAD_FRAMES; frame++) {
        fixture_continue(&f, 1);
        digest[frame] = fixture_digest(&f);
    }
    assert_true(fixture_state(&f).head->contact_count >= 60);
    fixture_close(&f);
}

/* Pairs of contacts that last, of impacts and of the guard are measured on all threads. */
static void test_a_heap_goes_the_same_way_on_any_number_of_threads(void **state)
{
    static uint64_t digest[2][THREAD_FRAMES];
    (void)state;
    uint64_t seed = fixture_seed(37);
    run_on_threads(1, seed, digest[0]);
    for (uint32_t threads = 2; threads <= 4; threads++) {
        run_on_threads(threads, seed, digest[1]);
        for (uint32_t frame = 0; frame < THREAD_FRAMES; frame++) {
            if (digest[0][frame] != digest[1][frame])
                fail_msg("frame %u differs on %u threads", frame + 1, threads);
        }
    }
}

/* --- rest --------------------------------------------------------------------------------------*/

#define RESTING_TANKS 24u
#define WORLDS        4u

static void set_throttle(uint32_t row, float throttle)
{
    steps_rows(&f).row[row].throttle = throttle;
    fixture_forget_copies(&f);
}

/* Returns a row that a contact holds off its springs, or SLOT_NONE. */
static uint32_t find_pinned(void)
{
    const struct entities e = steps_rows(&f);
    for (uint32_t row = 0; row < RESTING_TANKS; row++) {
        if (e.row[row].flags & ENTITY_FLAG_CHASSIS && e.row[row].jolt_tick == ENTITY_PINNED)
            return row;
    }
    return SLOT_NONE;
}

/* Tanks that stop pushing sleep, also where they hold each other off their springs. A pinned one
 * drives off when its driver wants to, and all others that it held move freely again. */
static void test_tanks_that_hold_each_other_off_their_springs_sleep(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(38);
    uint32_t pinned = 0;
    for (uint32_t world = 0; world < WORLDS; world++) {
        open_world(60.0);
        put_rings(RESTING_TANKS, fixture_uniform(&seed, 0.0, 1.0));
        let_push(RESTING_TANKS);
        fixture_continue(&f, 300);
        for (uint32_t row = 0; row < RESTING_TANKS; row++)
            set_throttle(row, 0.0f);
        fixture_continue(&f, 300);
        assert_true(f.stepper.collider.slept);
        uint64_t before = fixture_digest(&f);
        fixture_continue(&f, 1);
        assert_true(f.stepper.collider.slept && fixture_digest(&f) != before);
        for (uint32_t row = find_pinned(); row != SLOT_NONE; row = find_pinned()) {
            pinned++;
            for (uint32_t i = 0; i < RESTING_TANKS; i++)
                set_throttle(i, i % 2 ? 1.0f : -1.0f);
            fixture_continue(&f, 60);
            assert_true(steps_rows(&f).row[row].jolt_tick != ENTITY_PINNED);
        }
        assert_true(steps_deepest(&f, RESTING_TANKS) <= OVERLAP_M);
        fixture_close(&f);
    }
    print_message("%u tanks were pinned\n", pinned);
    assert_true(pinned > 0);
}

/* --- ends --------------------------------------------------------------------------------------*/

/* A tank runs into another, pushes it and drives back: one contact ends. */
static void test_the_end_of_a_contact_is_told(void **state)
{
    (void)state;
    open_world(60.0);
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                            .velocity = {0.0, 0.0, -3.0}});
    fixture_put(
        &f, (struct fixture_entity){.kind = "tank", .at = {25000.0, FIXTURE_GROUND_M, 24990.0}});
    let_push(1);
    fixture_continue(&f, 180);
    struct state now = fixture_state(&f);
    uint32_t ended = fixture_event_count(&f, EVENT_CONTACT_END); /* after a bounce */
    assert_int_equal(now.head->contact_count, 1);
    steps_rows(&f).row[0].throttle = -1.0f;
    fixture_forget_copies(&f);
    fixture_continue(&f, 180);
    now = fixture_state(&f);
    assert_int_equal(now.head->contact_count, 0);
    assert_int_equal(fixture_event_count(&f, EVENT_CONTACT_END), ended + 1);
    assert_true(fixture_event(&f, EVENT_CONTACT_END, ended)->contact_end.lasted_s > 1.0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_36_46_rings_press_without_overlap),
        cmocka_unit_test(test_a_heap_goes_the_same_way_on_any_number_of_threads),
        cmocka_unit_test(test_tanks_that_hold_each_other_off_their_springs_sleep),
        cmocka_unit_test(test_the_end_of_a_contact_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
