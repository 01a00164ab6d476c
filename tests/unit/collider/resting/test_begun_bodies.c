/* Bodies of the rows that are listed: who has a place, and what is found again. */
#include "collider/resting/begun_bodies.h"

#include "tests/support/fixture.h"
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define ROWS 6u

static struct fixture f;
static struct response_context context;
static struct begun_bodies bodies;

static int set_up(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t n = 0; n < ROWS; n++)
        fixture_put(&f, (struct fixture_entity){
                            .kind = "tank", .at = {25000.0 + 20.0 * n, FIXTURE_GROUND_M, 25000.0}});
    steps_respond(&f, &context);
    return begun_bodies_init(&bodies, context.world);
}

static int tear_down(void **state)
{
    (void)state;
    begun_bodies_free(&bodies);
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* A frame in which rows first .. end - 1 are listed, the last one twice. */
static void list(uint32_t first, uint32_t end)
{
    for (uint32_t row = first; row < end; row++)
        begun_bodies_list(&bodies, row);
    begun_bodies_list(&bodies, end - 1);
    begun_bodies_find(&bodies, &context, NULL);
    for (uint32_t row = first; row < end; row++)
        assert_true(begun_bodies_row(&bodies, row)->body.path.at.x ==
                    steps_position(&f, row).x); /* the row's own */
}

static void test_a_row_keeps_its_place_while_it_is_listed(void **state)
{
    (void)state;
    list(0, 4);
    const struct begun_body *body = begun_bodies_row(&bodies, 3);
    begun_bodies_forget(&bodies);
    list(2, 4);
    assert_ptr_equal(begun_bodies_row(&bodies, 3), body);
    begun_bodies_forget(&bodies);
    assert_int_equal(bodies.place[0], 0); /* it was not listed again */
    assert_int_equal(bodies.place[1], 0);
    list(2, 6);
    assert_ptr_equal(begun_bodies_row(&bodies, 3), body);
    assert_int_equal(bodies.places, 4); /* rows 4 and 5 have those of 0 and 1 */
    assert_int_equal(bodies.vacant_count, 0);
}

static void test_a_body_is_the_same_until_it_moves_or_loses_its_place(void **state)
{
    (void)state;
    list(0, 2);
    const uint64_t version[2] = {bodies.version[0], bodies.version[1]};
    begun_bodies_forget(&bodies);
    context.motion->path[1].along.x = 0.5;
    list(0, 2);
    assert_true(bodies.version[0] == version[0]);
    assert_true(bodies.version[1] == version[1] + 1);
    begun_bodies_forget(&bodies);
    list(1, 2);
    begun_bodies_forget(&bodies); /* row 0 has no place now */
    list(0, 2);
    assert_true(bodies.version[0] == version[0] + 1);
    assert_true(bodies.version[1] == version[1] + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_row_keeps_its_place_while_it_is_listed, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(test_a_body_is_the_same_until_it_moves_or_loses_its_place,
                                        set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
