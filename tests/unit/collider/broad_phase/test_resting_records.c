/* Records of rows that rest are kept, and are struck, found and let go as all others. */
#include "collider/broad_phase/resting_records.h"
#include "tests/support/fixture.h"
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define HERD   1100u /* the first block of 1,024 and some more */
#define SIDE   34u
#define GAP_M  30.0
#define WEST_M 24000.0

static struct fixture keeps, never; /* the same world; in the second no record is kept */
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
        e.row[row].behaviour = e.row[row].order = (uint8_t)behaviour;
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
    run(70);
    assert_int_equal(never.stepper.collider.broad.resting.kept[0], 0);
}

static bool is_kept(uint32_t row)
{
    return keeps.stepper.collider.broad.resting.kept[row / 64] >> row % 64 & 1;
}

static void test_a_vehicle_runs_into_a_row_that_rests(void **state)
{
    struct fixture_entity entity = {
        .kind = "tank", .at = {WEST_M - 50.0, 100.0, WEST_M + GAP_M}, .velocity = {16.0, 0.0, 0.0}};
    (void)state;
    put_herd("truck");
    uint32_t tank = put(entity, BEHAVIOUR_HOLD), struck = SIDE;
    assert_int_equal(tank, HERD);
    begin();
    assert_true(is_kept(struck) && !is_kept(tank) &&
                steps_rows(&keeps).row[tank].x < WEST_M - 20.0);
    double before = steps_rows(&keeps).row[struck].x;
    run(180);
    assert_true(fixture_state(&keeps).head->tally.collisions > 0);
    assert_true(steps_rows(&keeps).row[struck].x > before + 0.1);
}

static void test_a_row_that_is_struck_is_kept_no_longer(void **state)
{
    struct fixture_entity entity = {
        .kind = "tank", .at = {WEST_M - 45.0, 100.0, WEST_M + GAP_M}, .velocity = {16.0, 0.0, 0.0}};
    (void)state;
    put_herd("truck");
    uint32_t tank = put(entity, BEHAVIOUR_HOLD);
    begin();
    assert_true(is_kept(SIDE));
    for (uint32_t i = 0; i < 240 && is_kept(SIDE); i++)
        run(1);
    assert_false(is_kept(SIDE));
    assert_true(is_kept(SIDE + 8) && is_kept(8 * SIDE)); /* others of its block are */
    run(900);                                            /* the tank leans on it */
    assert_false(is_kept(SIDE));
    for (int i = 0; i < 2; i++)
        steps_rows(both[i]).row[tank].state = ENTITY_FREE;
    begin();
    run(1300); /* a new index is worth it then */
    assert_true(is_kept(SIDE));
    assert_true(fixture_state(&keeps).head->tally.collisions > 0);
}

static void test_a_charge_finds_a_row_that_rests(void **state)
{
    (void)state;
    put_herd("jeep");
    begin();
    assert_true(is_kept(SIDE + 3));
    for (int i = 0; i < 2; i++)
        steps_send(both[i], RING_CLIENTS,
                   (struct command){.source = 1,
                                    .type = COMMAND_FIRE,
                                    .kind = fixture_kind(both[i], "artillery"),
                                    .value = {WEST_M + 3.0 * GAP_M + 4.0, WEST_M + GAP_M}});
    run(300);
    assert_true(steps_rows(&keeps).row[SIDE + 3].damage > DAMAGE_NONE);
}

/* A new crater may lift the ground under an aircraft. */
static void test_a_crater_lets_aircraft_go(void **state)
{
    struct resting_records resting;
    struct crater_index craters = {.count = 3};
    struct method_input input = {.craters = &craters, .rows = 2 * RESTING_RECORDS_ROWS};
    (void)state;
    assert_int_equal(resting_records_init(&resting, input.rows), 0);
    resting_records_begin(&resting, &input);
    resting.kept[1] = 0x6;
    resting.flies[1] = 0x2;
    resting_records_begin(&resting, &input);
    assert_int_equal(resting.kept[1], 0x6);
    craters.count = 4;
    resting_records_begin(&resting, &input);
    assert_int_equal(resting.kept[1], 0x4);
    input.rows = 65;
    resting_records_begin(&resting, &input);
    assert_int_equal(resting.kept[1], 0);
    resting_records_free(&resting);
}

static void test_rows_that_move_are_made_again(void **state)
{
    struct resting_records resting;
    struct method_input input = {.rows = RESTING_RECORDS_ROWS + 70};
    struct moving_rows moving = {.row = {[1] = 0x1}};
    uint64_t bin[RESTING_RECORDS_WORDS], held[2 * RESTING_RECORDS_WORDS] = {0};
    (void)state;
    held[RESTING_RECORDS_WORDS + 1] = 0x10; /* one cruises: it has no record unless it moves */
    assert_int_equal(resting_records_init(&resting, input.rows), 0);
    resting_records_begin(&resting, &input);
    uint64_t *second = resting.kept + RESTING_RECORDS_WORDS; /* the words of the second block */
    second[0] = UINT64_MAX;
    second[1] = 0x7;
    memset(resting.written, 0, resting.words * sizeof *resting.written);
    resting.written[RESTING_RECORDS_WORDS + 1] = 0x4; /* by a response */
    assert_int_equal(resting_records_note(&resting, 1, &moving, held, bin), 4);
    assert_int_equal(bin[0], 0);
    assert_int_equal(bin[1], 0x2d);
    assert_int_equal(second[1], 0x2);
    moving.all = true;
    assert_int_equal(resting_records_note(&resting, 1, &moving, held, bin), 70);
    resting_records_free(&resting);
}

static void test_responses_note_the_rows_that_they_write(void **state)
{
    struct collider *collider = &keeps.stepper.collider;
    struct state next = fixture_state(&keeps);
    struct response_context context = collider_response_context(collider, &next);
    (void)state;
    put_herd("truck");
    begin();
    assert_true(is_kept(SIDE));
    table_note(&context.writer, SIDE);
    run(1);
    assert_true(!is_kept(SIDE) && is_kept(SIDE + 1));
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_worlds, close_worlds)
    const struct CMUnitTest tests[] = {
        TEST(test_a_vehicle_runs_into_a_row_that_rests),
        TEST(test_a_row_that_is_struck_is_kept_no_longer),
        TEST(test_a_charge_finds_a_row_that_rests),
        TEST(test_responses_note_the_rows_that_they_write),
        TEST(test_rows_that_move_are_made_again),
        TEST(test_a_crater_lets_aircraft_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
