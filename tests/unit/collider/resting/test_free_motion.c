/* Which bodies get their motion from contacts of which one body is free. */
#include "collider/resting/free_motion.h"

#include "tests/support/steps.h"
#include "world/entity/persistent_contact.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

enum { TANK, JEEP };

#define GAP_M 0.004

static struct fixture f;
static struct response_context context;

/* A jeep in the air beside a tank, with a contact that the table has kept. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {25000.0, 100.0, 25000.0}});
    fixture_put(&f, (struct fixture_entity){.kind = "jeep", .at = {25004.0, 100.8, 25000.0}});
    const struct state now = fixture_state(&f);
    steps_rows(&f).row[JEEP].flags |= ENTITY_FLAG_CHASSIS;
    steps_respond(&f, &context);
    steps_rows(&f).row[JEEP].x -= steps_gap(&f, &context.next->entities, TANK, JEEP) - GAP_M;
    steps_respond_end(&context);
    now.head->tick = 10;
    now.head->contact_count = 1;
    now.contacts[0] = (struct persistent_contact){.a_row = TANK,
                                                  .a_id = now.entities.row[TANK].id,
                                                  .b_row = JEEP,
                                                  .b_id = now.entities.row[JEEP].id,
                                                  .begin_tick = 5,
                                                  .pressed_tick = 9};
    steps_respond(&f, &context);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

/* Lets the mover bring the jeep to the east, and solves the contacts. Returns true if these
 * determine its motion. */
static bool solve(double east_m)
{
    context.next->entities.row[JEEP].x += east_m;
    context.next->entities.row[JEEP].vx = 60.0 * east_m;
    body_motion_compute(context.motion, JEEP);
    free_bodies_solve(&f.stepper.collider.free, &context);
    return f.stepper.collider.free.owned[JEEP] != 0;
}

static void test_what_presses_on_a_vehicle_moves_it(void **state)
{
    (void)state;
    assert_true(solve(-2.0 * GAP_M));
    assert_true(context.next->entities.row[JEEP].x > steps_rows(&f).row[JEEP].x - GAP_M);
}

/* Otherwise the ground would bear it in that frame by points of its hull, as it bears wrecks, and
 * not by its wheels: a howitzer on its side floated over the wall of a trench. */
static void test_a_vehicle_on_which_nothing_presses_keeps_its_motion(void **state)
{
    (void)state;
    assert_false(solve(GAP_M));
    assert_true(context.next->entities.row[JEEP].x == steps_rows(&f).row[JEEP].x + GAP_M);
    assert_int_equal(f.stepper.collider.free.pairs, 1);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_what_presses_on_a_vehicle_moves_it),
        TEST(test_a_vehicle_on_which_nothing_presses_keeps_its_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
