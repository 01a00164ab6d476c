/* Rows for new entities: rows are used again, ids never. */
#include "mover/weapon/spawn.h"
#include "tests/support/steps.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define CAPACITY 16

static struct fixture f;
static struct step_context step;
static struct serial_context context;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 16; };");
    steps_serial_context(&f, &step, &context);
    return 0;
}

static uint32_t spawn(const char *kind)
{
    return spawn_entity(&context, fixture_kind(&f, kind), FORCE_BLUE);
}

static void test_a_new_row_keeps_nothing_of_the_old_one(void **state)
{
    struct entities *m = &f.view.m.entities;
    (void)state;
    memset(m->row, 0xa5, CAPACITY * sizeof *m->row);
    uint32_t row = spawn("tank");
    const struct kind *kind = steps_kind(&f, "tank");
    assert_int_equal(row, 0);
    assert_int_equal(m->row[row].id, 1);
    assert_int_equal(m->row[row].state, ENTITY_ACTIVE);
    assert_int_equal(m->row[row].force, FORCE_BLUE);
    assert_int_equal(m->row[row].rounds, kind->rounds);
    assert_true(m->row[row].fuel_l == kind->fuel_l);
    assert_true(m->row[row].x == 0.0 && m->row[row].vx == 0.0 && m->row[row].harm_j == 0.0);
    assert_int_equal(m->row[row].target_id | m->row[row].owner_id | m->row[row].threat_id |
                         m->row[row].bumped | m->row[row].trigger | m->row[row].flags |
                         m->row[row].damage,
                     0);
}

static void test_a_munition_flies_and_has_a_life(void **state)
{
    const struct entities *m = &f.view.m.entities;
    const struct state_head *head = f.view.m.head;
    uint32_t row = spawn("missile");
    (void)state;
    assert_int_equal(m->row[row].behaviour, BEHAVIOUR_FLIGHT);
    assert_int_equal(m->row[row].until_tick, 1 + (uint32_t)(20.0 * 60.0));
    assert_int_equal(head->munitions, 1);
    assert_int_equal(head->vehicles, 0);
    spawn_remove(&context, row);
    assert_int_equal(head->munitions, 0);
}

static void test_a_full_table_refuses_and_counts(void **state)
{
    struct state_head *head = f.view.m.head;
    (void)state;
    for (uint32_t n = 0; n < CAPACITY; n++)
        assert_int_equal(spawn("jeep"), n);
    assert_int_equal(spawn("jeep"), SLOT_NONE);
    assert_int_equal(spawn("shell"), SLOT_NONE);
    assert_int_equal(head->tally.spawns_refused, 2);
    assert_int_equal(head->next_id, CAPACITY + 1);
    spawn_remove(&context, 5);
    assert_int_equal(spawn("jeep"), 5);
    assert_int_equal(f.view.m.entities.row[5].id, CAPACITY + 1);
}

static void test_freed_rows_rest_while_there_are_others(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 4; n++)
        spawn("jeep");
    spawn_remove(&context, 1);
    /* The search continues from where it was: a row's late references expire meanwhile. */
    for (uint32_t n = 4; n < CAPACITY; n++)
        assert_int_equal(spawn("jeep"), n);
    assert_int_equal(spawn("jeep"), 1);
}

/* --- the end of the table ----------------------------------------------------------------------*/

#define MANY 3000u

static int open_wide_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 4096; };");
    steps_serial_context(&f, &step, &context);
    return 0;
}

static void test_the_end_of_the_table_falls_back_after_a_burst(void **state)
{
    const struct state_head *head = f.view.m.head;
    const struct entities *m = &f.view.m.entities;
    (void)state;
    for (uint32_t n = 0; n < MANY; n++)
        assert_int_equal(spawn("shell"), n);
    for (uint32_t n = 0; n < MANY; n++)
        spawn_remove(&context, n);
    spawn_fall_back(&context);
    assert_int_equal(head->used, spawn_roof(head, m->capacity));
    assert_true(head->used < MANY / 10);
    for (uint32_t n = 0; n < 2 * head->used; n++) {
        uint32_t row = spawn("shell");
        assert_true(row < head->used && head->used < MANY / 10);
        spawn_remove(&context, row);
    }
}

static void test_a_row_in_use_holds_the_end_of_the_table(void **state)
{
    const struct state_head *head = f.view.m.head;
    (void)state;
    for (uint32_t n = 0; n < MANY; n++)
        spawn(n == MANY - 500 ? "jeep" : "shell");
    for (uint32_t n = 0; n < MANY; n++) {
        if (n != MANY - 500)
            spawn_remove(&context, n);
    }
    spawn_fall_back(&context);
    assert_int_equal(head->used, MANY - 499);
    assert_int_equal(f.view.m.entities.row[MANY - 500].state, ENTITY_ACTIVE);
    spawn_remove(&context, MANY - 500);
    spawn_fall_back(&context);
    assert_true(head->used < MANY / 10);
}

static void test_a_free_row_rests_below_the_roof_too(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 100; n++)
        spawn("jeep");
    spawn_remove(&context, 50);
    for (uint32_t n = 0; n < 100; n++) {
        assert_true(spawn("shell") != 50);
        spawn_fall_back(&context);
    }
}

/* Against a list that a child could keep. */
static void test_random_comings_and_goings_keep_ids_and_counts(void **state)
{
    uint64_t random = fixture_seed(10);
    uint32_t id[CAPACITY] = {0}, next = 1, live = 0, rounds = 0;
    bool round_at[CAPACITY] = {false};
    const struct entities *m = &f.view.m.entities;
    const struct state_head *head = f.view.m.head;
    (void)state;
    for (int n = 0; n < 20000; n++) {
        uint32_t at = (uint32_t)(fixture_random(&random) % CAPACITY);
        if (fixture_random(&random) & 1) {
            bool round = fixture_random(&random) & 1;
            uint32_t row = spawn(round ? "shell" : "jeep");
            assert_int_equal(row == SLOT_NONE, live == CAPACITY);
            if (row == SLOT_NONE)
                continue;
            assert_int_equal(id[row], 0); /* a row that was free */
            id[row] = next++;
            round_at[row] = round;
            live++;
            rounds += round;
        } else if (id[at] != 0) {
            spawn_remove(&context, at);
            id[at] = 0;
            live--;
            rounds -= round_at[at];
        }
        for (uint32_t i = 0; i < head->used; i++)
            assert_int_equal(m->row[i].id, id[i]);
        assert_int_equal(head->munitions, rounds);
        assert_int_equal(head->vehicles, live - rounds);
    }
}

static void test_intents_end_when_the_frame_is_full(void **state)
{
    uint32_t most = f.view.world.params->intents_per_frame;
    (void)state;
    for (uint32_t n = 0; n < most; n++) {
        struct event *intent = serial_context_intent(&context, EVENT_AGENT);
        assert_non_null(intent);
        memset(intent->bytes, 0xa5, sizeof intent->bytes);
    }
    assert_null(serial_context_intent(&context, EVENT_AGENT));
    assert_int_equal(f.view.m.head->intent_count, most);
    f.view.m.head->intent_count = 0;
    const struct event *again = serial_context_intent(&context, EVENT_FIRE);
    for (size_t n = 0; n < sizeof again->bytes; n++) /* nothing of the last frame is left */
        assert_int_equal(again->bytes[n], 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_new_row_keeps_nothing_of_the_old_one),
        TEST(test_a_munition_flies_and_has_a_life),
        TEST(test_a_full_table_refuses_and_counts),
        TEST(test_freed_rows_rest_while_there_are_others),
        cmocka_unit_test_prestate_setup_teardown(test_the_end_of_the_table_falls_back_after_a_burst,
                                                 open_wide_world, fixture_teardown, &f),
        cmocka_unit_test_prestate_setup_teardown(test_a_row_in_use_holds_the_end_of_the_table,
                                                 open_wide_world, fixture_teardown, &f),
        cmocka_unit_test_prestate_setup_teardown(test_a_free_row_rests_below_the_roof_too,
                                                 open_wide_world, fixture_teardown, &f),
        TEST(test_random_comings_and_goings_keep_ids_and_counts),
        TEST(test_intents_end_when_the_frame_is_full),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
