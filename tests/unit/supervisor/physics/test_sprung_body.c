/* A tank on its springs, placed and moved by hand: in the ground, in the air, and with energy that
 * its engine did not give. */
#include "supervisor/physics/sprung_body.h"

#include "supervisor/physics/body_measures.h"
#include "supervisor/physics/physics_check.h"
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define DT 0.016666666666666666

static struct fixture f;
static struct physics_check check;
static struct state now;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static int end_check(void **state)
{
    (void)state;
    physics_check_free(&check);
    steps_empty(&f);
    return 0;
}

/* Puts a tank on its springs so high over the level ground, and looks at it. */
static void begin(double height_m, double up_mps)
{
    fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                            .at = {25000.0, 100.0 + height_m, 25000.0},
                                            .behaviour = BEHAVIOUR_DRIVEN});
    now = fixture_state(&f);
    now.entities.row[0].flags |= ENTITY_FLAG_CHASSIS;
    now.entities.row[0].vy = up_mps;
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
}

static void next(void)
{
    judged_next(&f, &check, &now);
}

static double worst(enum measure_kind kind)
{
    return check.measures.of[kind].taken > 0 ? check.measures.of[kind].worst : -1.0;
}

static void test_a_shell_in_the_ground(void **state)
{
    (void)state;
    double travel = steps_kind(&f, "tank")->travel_m;
    begin(-travel + 0.01, 0.0);
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SHELL_UNDERGROUND));
    now.entities.row[0].y = 100.0 - travel - 0.16;
    next();
    assert_true(fabs(worst(MEASURE_OF_SHELL_UNDERGROUND) - 0.16) < 1e-9);
    assert_false(measure_good(&check.measures, MEASURE_OF_SHELL_UNDERGROUND));
}

/* Where two craters meet the ground has a step. A body as small as a point, 5 cm below its upper
 * side: 1 cm from the step it is no deeper than its way out, and further away it is that deep. */
static void test_a_shell_beside_a_step_is_as_deep_as_its_way_out(void **state)
{
    const struct crater craters[] = {
        {.x = 25000.0, .z = 25000.0, .radius_m = 2.1f, .depth_m = 0.84f},
        {.x = 25001.92, .z = 24999.44, .radius_m = 2.1f, .depth_m = 0.84f}};
    const struct kind point = {
        .domain = DOMAIN_LAND, .axles = 2, .heave_hz = 1.0, .tracked = 1, .length_m = 1e-9};
    struct surface surface = {.terrain = &f.view.world.terrain};
    struct body_look body = {.kind = &point};
    double step_x = 0.0, step_z = 0.0;
    (void)state;
    assert_int_equal(surface_update(&surface, craters, 2), 0);
    for (double z = 24996.0; z < 25004.0 && !(step_x > 0.0); z += 0.05) {
        for (double x = 24996.0; x < 25006.0 && !(step_x > 0.0); x += 0.002) {
            double west = surface_height(&surface, x, z), east;
            east = surface_height(&surface, x + 0.002, z);
            if (west - east > 0.06)
                step_x = x, step_z = z;
        }
    }
    assert_true(step_x > 0.0);
    body.now.pose = rigid_pose_of((struct vec3){0.0, 0.0, 0.0}, 0.0, 0.0, 0.0);
    body.named.at = (struct vec3){step_x - 0.01, 0.0, step_z};
    body.named.at.y = surface_height(&surface, step_x - 0.01, step_z) - 0.05;
    sprung_body_look(&surface, &body);
    assert_true(body.now.springs.shell_m == -0.015);
    body.named.at.x = step_x - 0.1;
    body.named.at.y = surface_height(&surface, step_x - 0.1, step_z) - 0.05;
    sprung_body_look(&surface, &body);
    assert_true(fabs(body.now.springs.shell_m + 0.05) < 1e-6);
    surface_free(&surface);
}

/* A crater throws earth over it, and another vehicle pushes it into a bank. */
static void test_a_shell_gets_out_of_the_ground_after_an_explosion(void **state)
{
    const struct ground_look ground = {.dt_s = DT};
    struct measures measures = {.frame = 1};
    struct kind kind = {.domain = DOMAIN_LAND, .max_speed_mps = 20.0, .bound_m = 4.0};
    struct body_look body = {.kind = &kind, .now = {.sprung = true}, .blasts = 1};
    (void)state;
    body.now.springs.shell_m = -0.05;
    body_measures_motion(&measures, &ground, &body);
    body.blasts = 0;
    for (int frame = 0; frame < 11; frame++)
        body_measures_motion(&measures, &ground, &body);
    assert_true(measures.of[MEASURE_OF_SHELL_UNDERGROUND].worst == 0.0);
    body_measures_motion(&measures, &ground, &body);
    body_measures_motion(&measures, &ground, &body);
    assert_true(measures.of[MEASURE_OF_SHELL_UNDERGROUND].worst == 0.05);
}

static void test_a_tank_that_falls_is_good_and_one_that_floats_is_not(void **state)
{
    (void)state;
    begin(3.0, 0.0);
    now.entities.row[0].spin_z = 1e-12;
    for (int n = 0; n < 20; n++) {
        double v = now.entities.row[0].vy - GRAVITY_MPS2 * DT;
        now.entities.row[0].y += 0.5 * (v + now.entities.row[0].vy) * DT;
        now.entities.row[0].vy = v;
        next();
    }
    assert_true(worst(MEASURE_OF_FLOATING) >= 0.0 && worst(MEASURE_OF_FLOATING) < 1e-9);
    assert_true(worst(MEASURE_OF_SPRUNG_ENERGY) >= 0.0 && worst(MEASURE_OF_SPRUNG_ENERGY) < 1e-6);
    next(); /* it stands still in the air */
    now.entities.row[0].vy = 0.0;
    next();
    assert_true(worst(MEASURE_OF_FLOATING) >= GRAVITY_MPS2 - 1e-9);
    assert_false(measure_good(&check.measures, MEASURE_OF_FLOATING));
}

static void test_energy_that_no_engine_gives(void **state)
{
    (void)state;
    const struct kind *kind = steps_kind(&f, "tank");
    begin(0.0, 0.0);
    now.entities.row[0].spin_z = 1e-12;
    next();
    assert_true(worst(MEASURE_OF_SPRUNG_ENERGY) < 1e-9);
    now.entities.row[0].vx = 4.0; /* 8 J/kg, in one frame */
    next();
    double engine = kind->power_w / kind->mass_kg * DT;
    assert_true(fabs(worst(MEASURE_OF_SPRUNG_ENERGY) - (8.0 - engine)) < 1e-6);
    assert_false(measure_good(&check.measures, MEASURE_OF_SPRUNG_ENERGY));
}

/* A vehicle that eases back to the ground has no spin. In a bend of the ground it climbs faster
 * from one frame to the next; when it has left the ground's angles by its springs, that counts. */
static void test_a_climb_with_the_ground_is_no_energy_of_springs(void **state)
{
    (void)state;
    begin(0.0, 0.0);
    next();
    now.entities.row[0].vy = 4.0;
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SPRUNG_ENERGY));
    now.entities.row[0].vy = 0.0;
    next();
    now.entities.row[0].vy = 4.0;
    now.entities.row[0].spin_x = 0.1;
    next();
    assert_false(measure_good(&check.measures, MEASURE_OF_SPRUNG_ENERGY));
}

/* A vehicle that slides down a mountain side is faster than its engine makes it, until it is slow
 * again; one that goes down a slope which its brakes hold is not. */
static void test_a_slide_is_faster_than_the_engine(void **state)
{
    double fast = 3.0 * steps_kind(&f, "tank")->max_speed_mps;
    (void)state;
    begin(0.0, -fast);
    now.entities.row[0].vx = fast;
    next();
    now.entities.row[0].vy = 0.0; /* where it comes to the foot */
    next();
    assert_true(measure_good(&check.measures, MEASURE_OF_SPEED));
    now.entities.row[0].vx = 0.3 * fast;
    next();
    now.entities.row[0].vx = fast;
    now.entities.row[0].vy = -0.4 * fast;
    next();
    assert_false(measure_good(&check.measures, MEASURE_OF_SPEED));
}

/* Its springs give back what a drop pressed into them. */
static void test_a_drop_on_its_springs_gains_nothing(void **state)
{
    (void)state;
    begin(0.3, 0.0);
    now.entities.row[0].flags |= ENTITY_FLAG_CHASSIS;
    physics_check_free(&check);
    fixture_run(&f, 1);
    now = fixture_state(&f);
    assert_int_equal(physics_check_begin(&check, &f.view.world, &now), 0);
    for (int n = 0; n < 180; n++) {
        fixture_run(&f, 1);
        now = fixture_state(&f);
        assert_int_equal(physics_check_frame(&check, &now, NULL), 0);
    }
    assert_true(worst(MEASURE_OF_SPRUNG_ENERGY) >= 0.0 && worst(MEASURE_OF_SPRUNG_ENERGY) < 0.2);
    assert_true(worst(MEASURE_OF_SHELL_UNDERGROUND) < 0.02);
}

int main(void)
{
#define T(name) cmocka_unit_test_teardown(name, end_check)
    const struct CMUnitTest tests[] = {
        T(test_a_shell_in_the_ground),
        T(test_a_shell_beside_a_step_is_as_deep_as_its_way_out),
        T(test_a_shell_gets_out_of_the_ground_after_an_explosion),
        T(test_a_tank_that_falls_is_good_and_one_that_floats_is_not),
        T(test_energy_that_no_engine_gives),
        T(test_a_climb_with_the_ground_is_no_energy_of_springs),
        T(test_a_slide_is_faster_than_the_engine),
        T(test_a_drop_on_its_springs_gains_nothing),
    };
    return cmocka_run_group_tests(tests, open_world, close_world);
}
