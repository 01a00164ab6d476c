/* Bodies that are put elsewhere stand on the ground there. */
#include "collider/resting/ground_placement.h"

#include "world/terrain/rest_pose.h"
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;

static struct entities *begin(const char *kind, uint8_t entity_state)
{
    fixture_open(&f, "");
    steps_plane(&f, 0.2, 0.1);
    fixture_put(&f, (struct fixture_entity){.kind = kind, .at = {25005.0, 101.5, 25000.0}});
    steps_rows(&f).state[0] = entity_state;
    steps_rows(&f).pitch[0] = 0.7;
    steps_rows(&f).roll[0] = -0.4;
    steps_respond(&f, &context);
    return &context.next->entities;
}

static void end(void)
{
    steps_respond_end(&context);
    fixture_close(&f);
}

static void test_a_vehicle_takes_its_pose_from_the_ground(void **state)
{
    (void)state;
    const struct entities *e = begin("tank", ENTITY_ACTIVE);
    ground_placement_put(&context, 0, (struct vec3){25030.0, 7.0, 25010.0}, 1.0);
    struct rest_pose pose = rest_pose_of(&f.view.world.terrain, context.input.detect.craters,
                                         &f.view.world.kinds[e->kind[0]], 25030.0, 25010.0, 1.0);
    assert_true(e->x[0] == 25030.0 && e->z[0] == 25010.0 && e->heading[0] == 1.0);
    assert_true(e->y[0] == pose.y_m && fabs(e->y[0] - 107.0) < 1e-4);
    assert_true(e->pitch[0] == pose.pitch_rad && e->roll[0] == pose.roll_rad);
    end();
}

static void test_a_wreck_keeps_pose_and_height_over_the_ground(void **state)
{
    (void)state;
    const struct entities *e = begin("tank", ENTITY_WRECK);
    ground_placement_put(&context, 0, (struct vec3){25030.0, 7.0, 25010.0}, 1.0);
    assert_true(e->x[0] == 25030.0 && e->z[0] == 25010.0 && e->heading[0] == 1.0);
    assert_true(fabs(e->y[0] - 107.5) < 1e-4);
    assert_true(e->pitch[0] == 0.7 && e->roll[0] == -0.4);
    end();
}

static void test_the_columns_are_marked_as_changed(void **state)
{
    (void)state;
    begin("tank", ENTITY_ACTIVE);
    context.writer.changed[0] = 0;
    ground_placement_put(&context, 0, (struct vec3){25030.0, 7.0, 25010.0}, 1.0);
    const uint64_t all = COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z) | COLUMN_BIT(heading) |
                         COLUMN_BIT(pitch) | COLUMN_BIT(roll);
    assert_true((context.writer.changed[0] & all) == all);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_vehicle_takes_its_pose_from_the_ground),
        cmocka_unit_test(test_a_wreck_keeps_pose_and_height_over_the_ground),
        cmocka_unit_test(test_the_columns_are_marked_as_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
