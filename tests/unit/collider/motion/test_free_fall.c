/* Who falls freely in a frame, and what is left of the fall at a time. */
#include "collider/motion/free_fall.h"
#include "tests/support/steps.h"
#include "world/entity/wreck_drag.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define DT_S (1.0 / 60.0)
#define FALL (GRAVITY_MPS2 * DT_S)

static struct fixture f;
static struct response_context context;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* A body in the air to which the frame has given this much speed downwards, after the air has
 * slowed it if it is a wreck. */
static uint32_t put(const char *kind, enum entity_state state, double faster_mps)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {25000.0, 900.0, 25000.0},
                                                           .velocity = {40.0, 3.0, 0.0}});
    steps_rows(&f).row[row].state = (uint8_t)state;
    steps_respond(&f, &context);
    struct entities n = context.next->entities;
    const struct mat3 axes = rotation_matrix(rotation_of(n.row[row].heading, 0.0, 0.0));
    if (state == ENTITY_WRECK)
        entities_set_velocity(&n, row,
                              wreck_drag_slow(steps_kind(&f, kind), &axes,
                                              entities_velocity(&n, row),
                                              world_dt_s(&f.view.world)));
    n.row[row].vy -= faster_mps;
    return row;
}

static double left(uint32_t row, double time)
{
    return free_fall_left_mps(context.motion, row, time);
}

static void test_the_rest_of_the_fall_is_left(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", ENTITY_WRECK, FALL);
    assert_true(fabs(left(row, 0.0) - FALL) < 1e-12);
    context.next->entities.row[row].vx = -7.0; /* by an impact: it falls on */
    assert_true(fabs(left(row, 0.25) - 0.75 * FALL) < 1e-12);
    assert_true(left(row, 1.0) == 0.0);
    assert_true(free_fall_unearned_mps(context.motion, row, 0.25) == 0.0);
    free_fall_ahead(context.motion, row);
    assert_true(left(row, 0.25) == 0.0);
    assert_true(fabs(free_fall_unearned_mps(context.motion, row, 0.25) - 0.75 * FALL) < 1e-12);
}

static void test_who_is_held_does_not_fall(void **state)
{
    (void)state;
    assert_true(left(put("helicopter", ENTITY_ACTIVE, FALL), 0.0) == 0.0); /* a pilot descends */
    steps_respond_end(&context);
    assert_true(left(put("helicopter", ENTITY_WRECK, 0.9 * FALL), 0.0) == 0.0);
}

static void test_who_becomes_a_wreck_has_not_fallen_yet(void **state)
{
    (void)state;
    uint32_t row = put("helicopter", ENTITY_ACTIVE, FALL);
    context.next->entities.row[row].state = ENTITY_WRECK;
    assert_true(left(row, 0.0) == 0.0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_the_rest_of_the_fall_is_left),
        TEST(test_who_is_held_does_not_fall),
        TEST(test_who_becomes_a_wreck_has_not_fallen_yet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
