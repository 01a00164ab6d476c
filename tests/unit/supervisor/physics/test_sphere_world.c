/* A world in which bodies collide as spheres: the corners of their boxes touch the ground, and
 * reach farther than the hulls. */
#include "supervisor/physics/physics_check.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct physics_check check;

static int close_world(void **state)
{
    (void)state;
    physics_check_free(&check);
    fixture_close(&f);
    return 0;
}

static void next(struct state *now)
{
    const struct physics_events events = {f.view.events, f.view.world.params->event_slots};
    now->head->frame++;
    now->head->tick++;
    assert_int_equal(physics_check_frame(&check, now, &events), 0);
}

static void test_a_box_at_rest_on_its_side(void **state)
{
    (void)state;
    fixture_open(&f, "");
    struct kind *kind = steps_kind(&f, "tank");
    kind->bound_m = 1.0;
    const struct vec3 at = {25000.0, FIXTURE_GROUND_M + 0.5 * kind->width_m, 25000.0};
    uint32_t tank = fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = at});
    struct state now = fixture_state(&f);
    now.entities.row[tank].state = ENTITY_WRECK;
    now.entities.row[tank].roll = HALF_PI;
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    now.entities.row[tank].until_tick = (uint32_t)now.head->tick + 1; /* it rests from now on */
    next(&now);
    next(&now);
    assert_true(measures_good(&check.measures));
    assert_true(check.measures.of[MEASURE_OF_WRECK_HEIGHT].worst < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_a_box_at_rest_on_its_side, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
