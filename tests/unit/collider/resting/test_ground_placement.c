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
    steps_rows(&f).row[0].state = entity_state;
    steps_rows(&f).row[0].pitch = 0.7;
    steps_rows(&f).row[0].roll = -0.4;
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
    struct rest_pose pose =
        rest_pose_of(&f.view.world.terrain, context.input.detect.craters,
                     &f.view.world.kinds[e->row[0].kind], 25030.0, 25010.0, 1.0);
    assert_true(e->row[0].x == 25030.0 && e->row[0].z == 25010.0 && e->row[0].heading == 1.0);
    assert_true(e->row[0].y == pose.y_m && fabs(e->row[0].y - 107.0) < 1e-4);
    assert_true(e->row[0].pitch == pose.pitch_rad && e->row[0].roll == pose.roll_rad);
    end();
}

static void test_a_wreck_keeps_pose_and_height_over_the_ground(void **state)
{
    (void)state;
    const struct entities *e = begin("tank", ENTITY_WRECK);
    ground_placement_put(&context, 0, (struct vec3){25030.0, 7.0, 25010.0}, 1.0);
    assert_true(e->row[0].x == 25030.0 && e->row[0].z == 25010.0 && e->row[0].heading == 1.0);
    assert_true(fabs(e->row[0].y - 107.5) < 1e-4);
    assert_true(e->row[0].pitch == 0.7 && e->row[0].roll == -0.4);
    end();
}

static void test_the_row_is_noted_as_written(void **state)
{
    (void)state;
    begin("tank", ENTITY_ACTIVE);
    context.writer.written[0] = 0;
    ground_placement_put(&context, 0, (struct vec3){25030.0, 7.0, 25010.0}, 1.0);
    assert_true(context.writer.written[0] == 1);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_vehicle_takes_its_pose_from_the_ground),
        cmocka_unit_test(test_a_wreck_keeps_pose_and_height_over_the_ground),
        cmocka_unit_test(test_the_row_is_noted_as_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
