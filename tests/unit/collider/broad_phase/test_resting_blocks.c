/* Blocks of rows that rest are kept, and are struck, found and let go as all others. */
#include "collider/broad_phase/resting_blocks.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define HERD   1100u /* the first block of 1,024 and some more */
#define SIDE   34u
#define GAP_M  30.0
#define WEST_M 24000.0

static struct fixture keeps, never; /* the same world; in the second no block is kept */
static struct fixture *const both[] = {&keeps, &never};

static int open_worlds(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
        fixture_open(both[i], "world = { capacity = 4096; }; collision = { shape = \"model\"; };");
    never.stepper.collider.broad.resting.never = true;
    return 0;
}

static int close_worlds(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
        fixture_close(both[i]);
    return 0;
}

static uint32_t put(struct fixture_entity entity, enum behaviour behaviour)
{
    uint32_t row = 0;
    for (int i = 0; i < 2; i++) {
        row = fixture_put(both[i], entity);
        struct entities e = steps_rows(both[i]);
        e.behaviour[row] = e.order[row] = (uint8_t)behaviour;
    }
    return row;
}

/* Parks vehicles in a square. */
static void put_herd(const char *kind)
{
    for (uint32_t n = 0; n < HERD; n++) {
        struct fixture_entity entity = {.kind = kind,
                                        .at = {WEST_M + GAP_M * (double)(n % SIDE), 100.0,
                                               WEST_M + GAP_M * (double)(n / SIDE)}};
        put(entity, BEHAVIOUR_IDLE);
    }
}

static void run(uint32_t frames)
{
    for (uint32_t i = 0; i < frames; i++) {
        for (int k = 0; k < 2; k++)
            fixture_continue(both[k], 1);
        struct state a = fixture_state(&keeps), b = fixture_state(&never);
        assert_int_equal(a.head->event_digest, b.head->event_digest);
        assert_int_equal(steps_state_hash(&keeps, &a), steps_state_hash(&never, &b));
    }
}

static void begin(void)
{
    for (int i = 0; i < 2; i++)
        fixture_run(both[i], 1); /* tells mover and collider that the test has written */
    run(60);
    assert_int_equal(never.stepper.collider.broad.resting.kept[0], 0);
}

static bool kept(void)
{
    return keeps.stepper.collider.broad.resting.kept[0] != 0;
}

static void test_a_vehicle_runs_into_a_block_that_rests(void **state)
{
    struct fixture_entity entity = {
        .kind = "tank", .at = {WEST_M - 60.0, 100.0, WEST_M + GAP_M}, .velocity = {16.0, 0.0, 0.0}};
    (void)state;
    put_herd("truck");
    uint32_t tank = put(entity, BEHAVIOUR_HOLD), struck = SIDE;
    assert_int_equal(tank, HERD);
    begin();
    assert_true(kept() && steps_rows(&keeps).x[tank] < WEST_M - 30.0);
    double before = steps_rows(&keeps).x[struck];
    run(180);
    assert_true(fixture_state(&keeps).head->tally.collisions > 0);
    assert_true(steps_rows(&keeps).x[struck] > before + 0.1);
}

static void test_a_block_whose_row_is_struck_is_kept_no_longer(void **state)
{
    struct fixture_entity entity = {
        .kind = "tank", .at = {WEST_M - 40.0, 100.0, WEST_M + GAP_M}, .velocity = {16.0, 0.0, 0.0}};
    (void)state;
    put_herd("truck");
    put(entity, BEHAVIOUR_HOLD);
    begin();
    assert_true(kept());
    for (uint32_t i = 0; i < 240 && kept(); i++)
        run(1);
    assert_false(kept());
    run(600); /* it comes to rest again */
    assert_true(fixture_state(&keeps).head->tally.collisions > 0);
}

static void test_a_charge_finds_a_block_that_rests(void **state)
{
    (void)state;
    put_herd("jeep");
    begin();
    assert_true(kept());
    for (int i = 0; i < 2; i++)
        steps_send(both[i], RING_CLIENTS,
                   (struct command){.source = 1,
                                    .type = COMMAND_FIRE,
                                    .kind = fixture_kind(both[i], "artillery"),
                                    .value = {WEST_M + 3.0 * GAP_M + 4.0, WEST_M + GAP_M}});
    run(300);
    assert_true(steps_rows(&keeps).damage[SIDE + 3] > DAMAGE_NONE);
}

/* Which rows may reach the ground depends on the highest rim of a crater. */
static void test_a_higher_rim_lets_blocks_with_aircraft_go(void **state)
{
    static struct resting_blocks blocks;
    const struct crater_index low = {.rim_m = 0.5}, high = {.rim_m = 0.7};
    struct method_input input = {.craters = &low, .rows = 2 * RESTING_BLOCKS_ROWS};
    (void)state;
    resting_blocks_begin(&blocks, &input);
    blocks.kept[0] = blocks.kept[1] = blocks.flies[1] = 1;
    resting_blocks_begin(&blocks, &input);
    assert_true(blocks.kept[0] && blocks.kept[1]);
    input.craters = &high;
    resting_blocks_begin(&blocks, &input);
    assert_true(blocks.kept[0] && !blocks.kept[1]);
    input.rows = RESTING_BLOCKS_ROWS / 2;
    blocks.kept[1] = 1;
    resting_blocks_begin(&blocks, &input);
    assert_true(blocks.kept[0] && !blocks.kept[1]);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_worlds, close_worlds)
    const struct CMUnitTest tests[] = {
        TEST(test_a_vehicle_runs_into_a_block_that_rests),
        TEST(test_a_block_whose_row_is_struck_is_kept_no_longer),
        TEST(test_a_charge_finds_a_block_that_rests),
        TEST(test_a_higher_rim_lets_blocks_with_aircraft_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
