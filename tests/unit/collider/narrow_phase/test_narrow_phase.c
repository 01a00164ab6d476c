/* When and where a pair touches: by spheres, by hulls, and objects that bodies may be inside. */
#include "collider/narrow_phase/narrow_phase.h"

#include "tests/support/steps.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;
static struct hull_contact impact;

static void open_with(const char *text)
{
    fixture_open(&f, text);
}

static void close_world(void)
{
    steps_respond_end(&context);
    fixture_close(&f);
}

static uint32_t put(const char *kind, double x, double y, double z)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, z}, .heading_rad = HALF_PI});
}

/* Row 0 moves this far east. Returns true if it touches the other side. */
static bool meets(double along, uint32_t other, bool through_fixed, double from)
{
    const struct pair pair = {0, other};
    context.path[0].along = (struct vec3){along, 0.0, 0.0};
    return narrow_phase_find(&context.input.detect, context.motion, through_fixed, &pair, from,
                             &impact);
}

static void test_spheres_touch_at_the_sum_of_their_radii(void **state)
{
    (void)state;
    open_with("");
    put("helicopter", 25000.0, 900.0, 25000.0);
    put("helicopter", 25030.0, 900.0, 25000.0);
    steps_respond(&f, &context);
    assert_true(meets(36.0, 1, false, 0.0)); /* 12 m of 30 are left after half the path */
    assert_true(fabs(impact.toi - 0.5) < 1e-12 && impact.normal.x == 1.0 && impact.depth_m < 1e-9);
    assert_true(fabs(impact.point.x - 25024.0) < 1e-9);
    assert_true(meets(36.0, 1, false, 0.75)); /* deep in it and going on */
    assert_true(impact.toi == 0.75 && fabs(impact.depth_m - 9.0) < 1e-9);
    assert_false(meets(17.9, 1, false, 0.0));
    assert_false(meets(-36.0, 1, false, 0.0));
    close_world();
}

static void test_what_looks_at_the_end_only_finds_it_at_the_end(void **state)
{
    (void)state;
    open_with("collision = { shape = \"sphere\"; method = \"npsnet2\"; };");
    put("helicopter", 25000.0, 900.0, 25000.0);
    put("helicopter", 25030.0, 900.0, 25000.0);
    steps_respond(&f, &context);
    assert_true(meets(30.0, 1, false, 0.0)); /* centre in centre: any normal will do */
    assert_true(impact.toi == 1.0 && impact.depth_m == 12.0);
    assert_true(vec3_length(impact.normal) == 1.0);
    close_world();
}

/* The method decided that they met; hulls pass over each other where spheres do not. */
static void test_hulls_pass_where_spheres_touch(void **state)
{
    (void)state;
    for (int model = 0; model < 2; model++) {
        open_with(model ? "collision = { shape = \"model\"; };" : "");
        double radius = steps_kind(&f, "tank")->radius_m;
        put("tank", 25000.0, FIXTURE_GROUND_M, 25000.0);
        put("tank", 25020.0, FIXTURE_GROUND_M, 25000.0 + 1.9 * radius);
        steps_respond(&f, &context);
        assert_int_equal(meets(40.0, 1, false, 0.0), !model);
        close_world();
    }
}

static void test_hulls_touch_where_they_are(void **state)
{
    (void)state;
    open_with("collision = { shape = \"model\"; };");
    put("truck", 25000.0, FIXTURE_GROUND_M, 25000.0);
    put("truck", 25020.0, FIXTURE_GROUND_M, 25000.0);
    steps_respond(&f, &context);
    assert_true(meets(20.0, 1, false, 0.0));
    assert_true(impact.toi > 0.0 && impact.normal.x > 0.999 && impact.depth_m == 0.0);
    struct free_turn turn;
    struct swept_body a = body_motion_body(context.motion, 0, &turn),
                      b = body_motion_body(context.motion, 1, &turn);
    assert_true(fabs(time_of_impact_gap(&a, &b, impact.toi) - SKIN_M) < 1e-8);
    /* They touch now, and part: the outer hulls must not hide that the pieces do not touch. */
    double toi = impact.toi;
    assert_false(meets(-20.0, 1, false, 0.0));
    assert_true(meets(20.0, 1, false, toi) && impact.toi == toi);
    close_world();
}

/* Bodies may be inside a bush, and a body inside may leave it; inside a tree only if bodies pass
 * through fixed objects. */
static void test_only_entering_a_yielding_object_is_a_contact(void **state)
{
    (void)state;
    for (int model = 0; model < 2; model++) {
        open_with(model ? "collision = { shape = \"model\"; };\n"
                          "objects = ( { kind = \"bush\"; at = [25010.0, 25000.0]; },\n"
                          "            { kind = \"building\"; at = [25010.0, 25000.0]; } );"
                        : "objects = ( { kind = \"bush\"; at = [25010.0, 25000.0]; },\n"
                          "            { kind = \"building\"; at = [25010.0, 25000.0]; } );");
        uint32_t bush = f.view.world.kinds[f.view.world.fixed[0].kind].rigidity < 0.1 ? 0 : 1;
        uint32_t wall = bush ^ 1u;
        put("tank", 24960.0, FIXTURE_GROUND_M, 25000.0);
        steps_respond(&f, &context);
        for (int through = 0; through < 2; through++) {
            assert_true(meets(50.0, bush | PAIR_FIXED, through, 0.0));
            assert_true(impact.toi > 0.0 && impact.toi < 1.0);
            assert_false(meets(50.0, bush | PAIR_FIXED, through, impact.toi));
            assert_true(meets(50.0, wall | PAIR_FIXED, through, 0.0));
            assert_int_equal(meets(50.0, wall | PAIR_FIXED, through, impact.toi), !through);
        }
        close_world();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spheres_touch_at_the_sum_of_their_radii),
        cmocka_unit_test(test_what_looks_at_the_end_only_finds_it_at_the_end),
        cmocka_unit_test(test_hulls_pass_where_spheres_touch),
        cmocka_unit_test(test_hulls_touch_where_they_are),
        cmocka_unit_test(test_only_entering_a_yielding_object_is_a_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
