/* What stands around a vehicle that turns. */
#include "mover/agent/room_around.h"

#include "tests/support/steps.h"
#include "world/entity/kind.h"
#include "world/maths/maths.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static struct shunting_room look(uint32_t row)
{
    struct step_context step;
    struct serial_context serial;
    fixture_run(&f, 1);
    steps_serial_context(&f, &step, &serial);
    return room_around(&step, row);
}

/* Returns the obstacle whose middle is within 1.5 m of a place. */
static struct shunting_obstacle find(const struct shunting_room *room, double x, double z)
{
    for (uint32_t n = 0; n < room->count; n++) {
        if (fabs(room->obstacle[n].x - x) < 1.5 && fabs(room->obstacle[n].z - z) < 1.5)
            return room->obstacle[n];
    }
    fail_msg("nothing is at %.0f, %.0f", x, z);
    return room->obstacle[0];
}

static void test_a_house_is_a_rectangle_and_a_tree_a_disc(void **state)
{
    (void)state;
    fixture_open(&f,
                 "collision = { shape = \"model\"; };\n"
                 "objects = ( { kind = \"building\"; at = [25015.0, 25000.0]; heading_deg = 90.0; "
                 "}, { kind = \"tree\"; at = [24990.0, 25000.0]; }, { kind = \"bush\"; at = "
                 "[25000.0, 25005.0]; }, { kind = \"tree\"; at = [25000.0, 25090.0]; } );\n"
                 "vehicles = ( { kind = \"jeep\"; at = [25000.0, 25000.0]; heading_deg = 0.0; "
                 "behaviour = \"idle\"; } );");
    const struct shunting_room room = look(0);
    const struct shunting_obstacle house = find(&room, 25015.0, 25000.0);
    const struct shunting_obstacle tree = find(&room, 24990.0, 25000.0);
    assert_int_equal(room.count, 2); /* a bush does no harm, and one tree is far away */
    assert_true(fabs(house.half_m - 8.1) < 0.3 && fabs(house.half_width - 6.2) < 0.3);
    assert_true(fabs(house.ux - 1.0) < 1e-6);
    assert_true(tree.half_m == 0.0 && tree.border_m > 0.1 && tree.border_m < 1.5);
}

static void test_vehicles_that_stand_are_there_with_their_guns(void **state)
{
    (void)state;
    fixture_open(&f,
                 "collision = { shape = \"model\"; };\n"
                 "vehicles = ( { kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 0.0; "
                 "behaviour = \"idle\"; }, { kind = \"tank\"; at = [25010.0, 25000.0]; "
                 "heading_deg = 90.0; behaviour = \"idle\"; }, { kind = \"jeep\"; at = [24990.0, "
                 "25000.0]; heading_deg = 0.0; behaviour = \"hold\"; speed_mps = 5.0; } );");
    const struct shunting_room room = look(0);
    const struct kind *tank = steps_kind(&f, "tank");
    const struct shunting_obstacle hull = find(&room, 25010.0, 25000.0);
    assert_int_equal(room.count, 2); /* the tank and its gun; the jeep drives */
    assert_true(fabs(hull.ux - 1.0) < 1e-6 && hull.half_m == 0.5 * tank->length_m);
    assert_true(room.obstacle[1].x + room.obstacle[1].half_m > 25010.0 + hull.half_m + 1.0);
}

/* Where spheres collide nothing has corners. */
static void test_spheres_are_discs(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"truck\"; at = [25000.0, 25000.0]; heading_deg = 0.0; "
                     "behaviour = \"idle\"; }, { kind = \"tank\"; at = [25012.0, 25000.0]; "
                     "heading_deg = 90.0; behaviour = \"idle\"; } );");
    const struct shunting_room room = look(0);
    assert_int_equal(room.count, 1);
    assert_true(room.obstacle[0].half_m == 0.0);
    assert_true(room.obstacle[0].border_m == steps_kind(&f, "tank")->radius_m);
    assert_true(room.front_m == room.left_m && room.front_m == steps_kind(&f, "truck")->radius_m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_a_house_is_a_rectangle_and_a_tree_a_disc, close_world),
        cmocka_unit_test_teardown(test_vehicles_that_stand_are_there_with_their_guns, close_world),
        cmocka_unit_test_teardown(test_spheres_are_discs, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
