/* How bodies in the air go back on their way: those that go together with others keep what they do
 * together, and their velocity (row 46). */
#include "collider/guard/send_back.h"

#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define WRECK  0u
#define COURSE 1u /* a helicopter that holds its course */

static struct fixture f;
static struct response_context context;
static const struct vec3 way = {0.5, -0.25, 0.125}, drift = {0.25, -0.125, 0.0}, none = {0};

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < 2; i++)
        fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                .behaviour = BEHAVIOUR_HOLD,
                                                .at = {25000.0 + 30.0 * i, 400.0, 25000.0},
                                                .velocity = vec3_scale(way, 60.0)});
    steps_rows(&f).row[WRECK].state = ENTITY_WRECK;
    steps_respond(&f, &context);
    for (uint32_t i = 0; i < 2; i++) {
        struct entity *row = &context.next->entities.row[i];
        row->x += way.x, row->y += way.y, row->z += way.z;
        body_motion_compute(context.motion, i);
    }
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static void send(uint32_t row, struct vec3 together, uint32_t times)
{
    uint8_t back = 0;
    for (uint32_t i = 0; i < times && back < SEND_BACK_MOST; i++)
        back = send_back_go(&context, row, together, back + 1);
}

static void assert_came(uint32_t row, struct vec3 came)
{
    struct vec3 from = entities_position(&context.motion->before, row);
    struct vec3 at = entities_position(&context.next->entities, row);
    assert_true(vec3_length(vec3_sub(vec3_sub(at, from), came)) < 1e-9);
}

static void assert_velocity(uint32_t row, double share)
{
    struct vec3 velocity = entities_velocity(&context.next->entities, row);
    assert_true(vec3_length(vec3_sub(velocity, vec3_scale(way, 60.0 * share))) < 1e-9);
}

static void test_what_goes_together_goes_back_among_itself_first(void **state)
{
    (void)state;
    for (uint32_t row = WRECK; row <= COURSE; row++) {
        send(row, drift, 1);
        assert_came(row, vec3_lerp(drift, way, 0.5));
    }
    assert_velocity(COURSE, 1.0);
}

static void test_a_wreck_that_goes_with_others_keeps_its_energy(void **state)
{
    (void)state;
    for (uint32_t row = WRECK; row <= COURSE; row++) {
        send(row, drift, SEND_BACK_HALF + 1);
        assert_came(row, drift);
    }
    assert_velocity(COURSE, 1.0);
    send(WRECK, drift, SEND_BACK_MOST);
    assert_came(WRECK, none);
    struct vec3 velocity = entities_velocity(&context.next->entities, WRECK);
    double gained =
        0.5 * (vec3_dot(velocity, velocity) - 3600.0 * vec3_dot(way, way)) - GRAVITY_MPS2 * way.y;
    assert_true(fabs(gained) < 1e-6);
}

static void test_a_wreck_alone_is_stopped(void **state)
{
    (void)state;
    send(WRECK, none, 1);
    assert_came(WRECK, vec3_scale(way, 0.5));
    assert_velocity(WRECK, 0.5);
    send(WRECK, none, SEND_BACK_HALF + 1);
    assert_came(WRECK, none);
    assert_velocity(WRECK, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_what_goes_together_goes_back_among_itself_first,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_wreck_that_goes_with_others_keeps_its_energy,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_wreck_alone_is_stopped, open_world, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
