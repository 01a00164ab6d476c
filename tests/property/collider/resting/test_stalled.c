/* Heaps that press and do not move on stand still to the bit, and what the collider remembers of
 * bodies that stand changes no result (thesis row 36). SEED=n turns the rings. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define TANKS_MOST 24u
#define HZ         60.0
#define SPACING_M  9.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; hz = 60.0; capacity = 256; };\n"
                     "collision = { shape = \"model\"; };\n");
    steps_kind(&f, "tank")->resistance_j = 1e12;
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* Puts a tank so far from the middle, by an angle from the north, that drives towards it. */
static void put(double far_m, double angle_rad, double speed_mps)
{
    double sine, cosine;
    maths_sincos(angle_rad, &sine, &cosine);
    fixture_put(&f, (struct fixture_entity){
                        .kind = "tank",
                        .at = {25000.0 + far_m * sine, FIXTURE_GROUND_M, 25000.0 - far_m * cosine},
                        .velocity = {-speed_mps * sine, 0.0, speed_mps * cosine}});
}

static void set_throttle(uint32_t row, double throttle)
{
    struct entities e = steps_rows(&f);
    e.row[row].behaviour = BEHAVIOUR_DRIVEN;
    e.row[row].until_tick = UINT32_MAX;
    e.row[row].throttle = (float)throttle;
    fixture_forget_copies(&f);
}

static void put_rings(uint64_t *seed)
{
    double turned = fixture_uniform(seed, 0.0, 1.0);
    uint32_t placed = 0;
    for (uint32_t ring = 1; placed < TANKS_MOST; ring++) {
        uint32_t here = (uint32_t)(TWO_PI * ring);
        for (uint32_t i = 0; i < here && placed < TANKS_MOST; i++, placed++)
            put(SPACING_M * ring, turned + TWO_PI * i / here, 10.0);
    }
    for (uint32_t i = 0; i < TANKS_MOST; i++)
        set_throttle(i, 1.0);
}

static void note(struct vec3 at[TANKS_MOST])
{
    const struct entities e = steps_rows(&f);
    for (uint32_t i = 0; i < fixture_state(&f).head->used; i++)
        at[i] = entities_position(&e, i);
}

/* Returns how many tanks are exactly where they were, without a motion. */
static uint32_t standing(const struct vec3 at[TANKS_MOST])
{
    const struct entities e = steps_rows(&f);
    uint32_t count = 0;
    for (uint32_t i = 0; i < fixture_state(&f).head->used; i++)
        count += e.row[i].x == at[i].x && e.row[i].y == at[i].y && e.row[i].z == at[i].z &&
                 steps_speed(&f, i) == 0.0;
    return count;
}

static double moved_m(const struct vec3 *at, uint32_t row)
{
    const struct entities e = steps_rows(&f);
    return vec3_length(vec3_sub(entities_position(&e, row), *at));
}

/* Two tanks push each other head on for 5 s; at: where they are then. */
static void push_head_on(struct vec3 *at)
{
    put(8.0, 0.0, 2.0);
    put(8.0, PI, 2.0);
    set_throttle(0, 1.0);
    set_throttle(1, 1.0);
    fixture_continue(&f, (uint32_t)(5.0 * HZ));
    note(at);
}

static void test_tanks_that_push_each_other_head_on_stand(void **state)
{
    struct vec3 at[TANKS_MOST];
    (void)state;
    push_head_on(at);
    fixture_continue(&f, (uint32_t)(2.0 * HZ));
    assert_int_equal(standing(at), 2);
    assert_int_equal(fixture_state(&f).head->contact_count, 1);
}

/* One that reverses is off at once, also with little throttle: nothing presses on it any more. */
static void test_a_tank_that_stands_drives_off(void **state)
{
    struct vec3 at[TANKS_MOST];
    (void)state;
    for (double throttle = -1.0; throttle <= -0.1; throttle += 0.3) {
        steps_empty(&f);
        push_head_on(at);
        set_throttle(0, throttle);
        set_throttle(1, 0.0);
        fixture_continue(&f, (uint32_t)(4.0 * HZ));
        if (!(moved_m(&at[0], 0) > 0.3))
            fail_msg("with a throttle of %g the tank went %g m", throttle, moved_m(&at[0], 0));
    }
}

/* A tank that pushes another which only stands in its way moves it. */
static void test_a_tank_pushes_another_away(void **state)
{
    struct vec3 at[TANKS_MOST];
    (void)state;
    put(8.0, 0.0, 1.0);
    put(0.0, HALF_PI, 0.0);
    set_throttle(0, 1.0);
    fixture_continue(&f, (uint32_t)(5.0 * HZ));
    note(at);
    fixture_continue(&f, (uint32_t)(5.0 * HZ));
    print_message("# pushed %.2f m in 5 s\n", moved_m(&at[1], 1));
    assert_true(moved_m(&at[1], 1) > 0.5);
}

static void test_a_ring_that_presses_stands(void **state)
{
    uint64_t seed = fixture_seed(36);
    struct vec3 at[TANKS_MOST];
    (void)state;
    put_rings(&seed);
    fixture_continue(&f, (uint32_t)(8.0 * HZ));
    note(at);
    fixture_continue(&f, (uint32_t)HZ);
    print_message("# %u of %u tanks stand\n", standing(at), TANKS_MOST);
    assert_true(standing(at) >= TANKS_MOST / 2);
}

#define FRAMES 480u

static void run_rings(uint64_t seed, bool begins_anew, uint64_t digest[FRAMES])
{
    steps_empty(&f);
    put_rings(&seed);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        if (begins_anew && fixture_random(&seed) % 4 == 0)
            fixture_threads(&f, 1);
        fixture_continue(&f, 1);
        digest[frame] = fixture_digest(&f);
    }
}

static void test_a_ring_goes_on_alike_where_its_roles_begin_anew(void **state)
{
    static uint64_t digest[2][FRAMES];
    uint64_t seed = fixture_seed(37);
    run_rings(seed, false, digest[0]);
    close_world(state);
    open_world(state);
    run_rings(seed, true, digest[1]);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        if (digest[0][frame] != digest[1][frame])
            fail_msg("frame %u differs", frame + 1);
    }
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_tanks_that_push_each_other_head_on_stand),
        TEST(test_a_tank_that_stands_drives_off),
        TEST(test_a_tank_pushes_another_away),
        TEST(test_a_ring_that_presses_stands),
        TEST(test_a_ring_goes_on_alike_where_its_roles_begin_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
