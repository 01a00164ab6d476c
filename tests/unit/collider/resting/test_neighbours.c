/* The neighbourhood of bodies that part: who may be pushed, each pair once. */
#include "collider/resting/neighbours.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS 4u

static struct fixture f;
static struct response_context context;
static struct neighbours neighbours;
static struct contact_groups groups;

/* Three trucks in a row, 9 m apart, and one 100 m away. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < ROWS; i++)
        fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                .at = {25000.0 + 9.0 * i + (i == 3 ? 100.0 : 0.0),
                                                       FIXTURE_GROUND_M, 25000.0},
                                                .heading_rad = HALF_PI});
    steps_respond(&f, &context);
    assert_int_equal(neighbours_init(&neighbours, &f.view.world), 0);
    assert_int_equal(contact_groups_init(&groups, &f.view.world), 0);
    neighbours_begin(&neighbours);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    neighbours_free(&neighbours);
    contact_groups_free(&groups);
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static bool lists(uint32_t a, uint32_t b)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < groups.count; i++)
        found += groups.pair[i].a == a && groups.pair[i].b == b;
    assert_true(found <= 1);
    return found == 1;
}

static void test_pairs_within_reach_are_listed_once(void **state)
{
    (void)state;
    neighbours_add(&neighbours, &(struct pair){0, 1});
    assert_true(neighbours_list(&neighbours, &context, 5.0, &groups));
    assert_true(lists(0, 1) && lists(1, 2) && !lists(2, 3));
    uint32_t count = groups.count;
    assert_false(neighbours_list(&neighbours, &context, 5.0, &groups));
    assert_int_equal(groups.count, count);
}

static void test_bodies_out_of_reach_are_not(void **state)
{
    (void)state;
    neighbours_add(&neighbours, &(struct pair){3, PAIR_FIXED});
    assert_false(neighbours_list(&neighbours, &context, 5.0, &groups));
    assert_int_equal(groups.count, 0);
}

/* A pair that is marked has been measured. Its bodies may be pushed, and are looked at next. */
static void test_a_marked_pair_passes_on(void **state)
{
    (void)state;
    uint32_t index = contact_queue_pair(context.contacts, &(struct pair){0, 1});
    context.contacts->marks[index] |= CONTACT_GATHERED;
    neighbours_add(&neighbours, &(struct pair){0, PAIR_FIXED});
    assert_true(neighbours_list(&neighbours, &context, 5.0, &groups));
    assert_true(!lists(0, 1) && lists(1, 2));
    neighbours_unmark(&context);
    for (uint32_t i = 0; i < context.contacts->pair_count; i++)
        assert_int_equal(context.contacts->marks[i] & CONTACT_GATHERED, 0);
}

static void test_a_frame_forgets_the_last_one(void **state)
{
    (void)state;
    const struct pair pair = {0, 1}, other = {2, 3};
    neighbours_add(&neighbours, &pair);
    assert_true(neighbours_has(&neighbours, &pair));
    assert_true(neighbours_has(&neighbours, &(struct pair){1, 2}));
    assert_false(neighbours_has(&neighbours, &other));
    neighbours_begin(&neighbours);
    assert_false(neighbours_has(&neighbours, &pair));
    assert_int_equal(neighbours.count, 0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_pairs_within_reach_are_listed_once),
        TEST(test_bodies_out_of_reach_are_not),
        TEST(test_a_marked_pair_passes_on),
        TEST(test_a_frame_forgets_the_last_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
