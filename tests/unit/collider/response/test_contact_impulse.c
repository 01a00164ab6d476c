/* Impulses on cases that can be worked out by hand. Momentum and energy over random ones are in
 * tests/property/collider/test_collide.c. */
#include "collider/response/damage.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/deformation.h"
#include "collider/response/impact_damage.h"
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/terrain/fallen.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; },\n"
                     "            { kind = \"building\"; at = [26000.0, 25000.0]; },\n"
                     "            { kind = \"bush\"; at = [27000.0, 25000.0]; } );\n");
    struct kind *tank = steps_kind(&f, "tank"), *jeep = steps_kind(&f, "jeep");
    tank->resistance_j = jeep->resistance_j = 1e12;
    tank->mass_kg = 3000.0;
    jeep->mass_kg = 1000.0;
    tank->restitution = jeep->restitution = 0.5;
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double speed_mps)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {x, 100.0, z},
                                                   .velocity = {speed_mps, 0.0, 0.0},
                                                   .heading_rad = HALF_PI});
}

static const struct event_collision *collision(void)
{
    const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
    assert_non_null(event);
    return &event->collision;
}

/* A tank at 8 m/s into a jeep at rest, met half way through the frame. */
static void ram(uint32_t *tank, uint32_t *jeep)
{
    *tank = put("tank", 20000.0, 20000.0, 8.0);
    *jeep = put("jeep", 20004.6 + 4.0 / 60.0, 20000.0, 0.0);
    fixture_run(&f, 1);
}

static void test_a_head_on_impact_follows_newton(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    ram(&tank, &jeep);
    struct entities e = steps_rows(&f);
    /* Common speed 6; the jeep leaves at 6 + e * 6, the tank at 6 - e * 2. */
    assert_true(fabs(e.row[tank].vx - 5.0) < 1e-9 && fabs(e.row[jeep].vx - 9.0) < 1e-9);
    assert_true(e.row[tank].vz == 0.0 && e.row[jeep].vz == 0.0);
    assert_true(fabs((double)collision()->impulse_ns - 9000.0) < 1e-3);
    assert_true(fabs((double)collision()->closing_mps - 8.0) < 1e-6);
    assert_true(fabs(collision()->toi - 0.5) < 1e-9);
    assert_int_equal(collision()->response, RESPONSE_BOUNCE);
    /* Lost: half the reduced mass of 750 times 64 times 1 - e^2, the jeep three quarters of it. */
    const double jeep_j = 13500.0 * IMPACT_HARM_OUTSIDE, tank_j = 4500.0 * IMPACT_HARM_OUTSIDE;
    assert_true(fabs(e.row[jeep].harm_j - deformation_of(steps_kind(&f, "jeep"), jeep_j).harm_j) <
                1e-6);
    assert_true(fabs(e.row[tank].harm_j - deformation_of(steps_kind(&f, "tank"), tank_j).harm_j) <
                1e-6);
}

static void test_the_event_says_where_and_which_way(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    ram(&tank, &jeep);
    const struct event_collision *c = collision();
    assert_true(fabs(c->point[0] - (20000.0 + 4.0 / 60.0 + 3.0)) < 1e-9 && c->point[2] == 20000.0);
    assert_true(c->normal[0] == 1.0f && c->normal[1] == 0.0f && c->normal[2] == 0.0f);
    assert_true(c->direction_a[0] == 1.0f); /* row 34 */
    assert_int_equal(c->a.id, tank + 1);
    assert_int_equal(c->b.id, jeep + 1);
    assert_int_equal(c->b.kind, fixture_kind(&f, "jeep"));
}

static void test_the_softer_of_the_two_decides_the_bounce(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    steps_kind(&f, "jeep")->restitution = 0.0;
    ram(&tank, &jeep);
    assert_true(fabs(steps_rows(&f).row[tank].vx - 6.0) < 1e-9);
    assert_true(fabs(steps_rows(&f).row[jeep].vx - 6.0) < 1e-9);
    assert_int_equal(collision()->response, RESPONSE_STOP);
}

static void test_bodies_continue_from_where_they_touched(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    ram(&tank, &jeep);
    struct entities e = steps_rows(&f);
    /* Half the frame is left, at 5 and at 9 m/s. */
    assert_true(fabs(e.row[tank].x - (20000.0 + 4.0 / 60.0 + 2.5 / 60.0)) < 1e-9);
    assert_true(fabs(e.row[jeep].x - (20004.6 + 4.0 / 60.0 + 4.5 / 60.0)) < 1e-9);
    assert_int_equal(e.row[tank].bumped & e.row[jeep].bumped, 1);
    assert_true(fabs((double)e.row[tank].bump_heading - 1.5 * PI) < 1e-6); /* away is west */
    assert_true(fabs((double)e.row[jeep].bump_heading - HALF_PI) < 1e-6);
    fixture_run(&f, 1);
    assert_true(fabs(steps_rows(&f).row[jeep].x - e.row[jeep].x - 9.0 / 60.0) < 1e-9);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
}

/* Touching along the diagonal: 3-4-5 with a reach of 4.6. */
static void graze(double friction, uint32_t *tank, uint32_t *jeep)
{
    steps_kind(&f, "tank")->friction = steps_kind(&f, "jeep")->friction = friction;
    *tank = put("tank", 20000.0, 20000.0, 8.0);
    *jeep = put("jeep", 20000.0 + 0.8 * 4.6, 20000.0 + 0.6 * 4.6, 0.0);
    fixture_run(&f, 1);
}

static void test_friction_drags_along_and_turns(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    graze(0.5, &tank, &jeep);
    struct entities e = steps_rows(&f);
    double across = e.row[tank].vz * 0.8 - e.row[tank].vx * 0.6;
    double dragged = e.row[jeep].vz * 0.8 - e.row[jeep].vx * 0.6;
    assert_true(across > -8.0 * 0.6 && dragged < 0.0); /* some of it went over */
    double mt = steps_kind(&f, "tank")->mass_kg, mj = steps_kind(&f, "jeep")->mass_kg;
    assert_true(fabs(mt * e.row[tank].vx + mj * e.row[jeep].vx - 8.0 * mt) < 1e-6 * mt);
    assert_true(fabs(mt * e.row[tank].vz + mj * e.row[jeep].vz) < 1e-6 * mt);
    /* The jeep's north-west side is dragged to the north-east: clockwise, seen from above. */
    assert_true(e.row[jeep].spin_y < 0.0 && e.row[tank].spin_y != 0.0);
    assert_true(e.row[jeep].spin_x == 0.0 &&
                e.row[jeep].spin_z == 0.0); /* the ground holds it level */
}

static void test_without_friction_only_the_speed_along_the_normal_changes(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    graze(0.0, &tank, &jeep);
    struct entities e = steps_rows(&f);
    double along = e.row[tank].vx * 0.8 + e.row[tank].vz * 0.6,
           across = e.row[tank].vz * 0.8 - e.row[tank].vx * 0.6;
    assert_true(fabs(across + 8.0 * 0.6) < 1e-6);
    assert_true(fabs(along - 8.0 * 0.8 * 5.0 / 8.0) < 1e-6);
    assert_true(fabs(e.row[jeep].vx * 0.6 - e.row[jeep].vz * 0.8) < 1e-6);
}

static double kinetic_j(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct mass_properties mass = mass_properties_of(&f.view.world.kinds[e.row[row].kind]);
    return 0.5 * mass.mass_kg * (e.row[row].vx * e.row[row].vx + e.row[row].vz * e.row[row].vz) +
           0.5 * mass.moment.y * e.row[row].spin_y * e.row[row].spin_y;
}

static void test_half_of_the_work_of_friction_is_heat(void **state)
{
    uint32_t tank, jeep;
    (void)state;
    graze(0.5, &tank, &jeep);
    struct entities e = steps_rows(&f);
    double lost = 0.5 * 3000.0 * 64.0 - kinetic_j(tank) - kinetic_j(jeep);
    double impulse = 1000.0 * (e.row[jeep].vx * 0.8 + e.row[jeep].vz * 0.6);
    double along = 0.5 * impulse * 8.0 * 0.8 * (1.0 - 0.5), rubbed = lost - along;
    assert_true(rubbed > 0.02 * lost);
    double jeep_j = 0.75 * (along + 0.5 * rubbed) * IMPACT_HARM_OUTSIDE;
    double harm = deformation_of(steps_kind(&f, "jeep"), jeep_j).harm_j;
    assert_true(fabs(e.row[jeep].harm_j - harm) < 1e-3 * harm);
}

/* --- fixed objects -----------------------------------------------------------------------------*/

/* Runs a tank of 3 t into object n at this speed. */
static uint32_t into(uint32_t n, double speed_mps, double radius_m)
{
    uint32_t row = put("tank", 25000.0 + 1000.0 * n - 3.0 - radius_m - 0.25 * speed_mps / 60.0,
                       25000.0, speed_mps);
    fixture_run(&f, 1);
    return row;
}

static void test_a_wall_throws_it_back(void **state)
{
    double restitution = maths_min(0.5, steps_kind(&f, "building")->restitution);
    uint32_t row = into(1, 10.0, 9.0);
    (void)state;
    assert_true(fabs(steps_rows(&f).row[row].vx + 10.0 * restitution) < 1e-6);
    double energy = 0.5 * 3000.0 * 100.0;
    double rigidity = steps_kind(&f, "building")->rigidity;
    double lost = energy * (1.0 - restitution * restitution) * rigidity;
    assert_true(fabs(steps_rows(&f).row[row].harm_j -
                     deformation_of(steps_kind(&f, "tank"), lost).harm_j) < 1e-3);
}

/* The speed after breaking the tree, which is struck at its foot and there resists like a quarter
 * of its mass, by a tank of 3 t. */
static double through_tree(double speed)
{
    double debris = steps_kind(&f, "tree")->mass_kg / 4.0;
    double left = speed * speed - 2.0 * steps_kind(&f, "tree")->resistance_j / 3000.0;
    return sqrt(left) * 3000.0 / (3000.0 + debris);
}

static void test_what_breaks_costs_its_resistance_and_takes_momentum(void **state)
{
    double resistance = steps_kind(&f, "tree")->resistance_j;
    double speed = sqrt(2.0 * 4.0 * resistance / 3000.0); /* four times what it withstands */
    double after = through_tree(speed);
    uint32_t row = into(0, speed, (double)1.8f);
    (void)state;
    assert_int_equal(fallen_damage(fixture_state(&f).fixed_damage[0]), DAMAGE_HIGH);
    assert_int_equal(collision()->response, RESPONSE_SLOW);
    assert_int_equal(collision()->b.damage, DAMAGE_HIGH);
    assert_true(fabs(steps_rows(&f).row[row].vx - after) < 1e-6);
    assert_true(fabs((double)collision()->impulse_ns - 3000.0 * (speed - after)) < 1e-2);
    /* A quarter of the frame before, the rest after, at its new speed. */
    double from = 25000.0 - 3.0 - (double)1.8f;
    assert_true(fabs(steps_rows(&f).row[row].x - from - 0.75 * after / 60.0) < 1e-6);
    /* The tank takes the tree's rigidity of what is lost. */
    double debris = steps_kind(&f, "tree")->mass_kg / 4.0;
    double lost = 0.5 * 3000.0 * speed * speed - 0.5 * (3000.0 + debris) * after * after;
    double taken = lost * steps_kind(&f, "tree")->rigidity;
    double harm = deformation_of(steps_kind(&f, "tank"), taken).harm_j;
    assert_true(fabs(steps_rows(&f).row[row].harm_j - harm) < 1e-6 * harm);
    fixture_run(&f, 30);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1); /* a stump stops no vehicle */
}

static void test_what_breaks_changes_the_speed_along_the_normal_only(void **state)
{
    double speed = 60.0, reach = 3.0 + (double)1.8f;
    (void)state;
    /* The tank touches the tree at 3-4-5: the normal is (0.8, 0.6). */
    uint32_t row = put("tank", 25000.0 - 0.8 * reach, 25000.0 - 0.6 * reach, speed);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(fallen_damage(fixture_state(&f).fixed_damage[0]), DAMAGE_HIGH);
    double along = e.row[row].vx * 0.8 + e.row[row].vz * 0.6,
           across = e.row[row].vz * 0.8 - e.row[row].vx * 0.6;
    assert_true(fabs(across + 0.6 * speed) < 1e-4);
    assert_true(fabs(along - through_tree(0.8 * speed)) < 1e-4);
}

static void test_what_withstands_by_a_hair_stops_it(void **state)
{
    double speed = sqrt(2.0 * steps_kind(&f, "tree")->resistance_j / 3000.0);
    uint32_t row = into(0, speed * (1.0 - 1e-6), (double)1.8f);
    (void)state;
    assert_int_equal(fixture_state(&f).fixed_damage[0], DAMAGE_MED);
    assert_true(steps_rows(&f).row[row].vx <= 0.0);
}

static void test_row_32_a_bush_does_and_takes_no_damage(void **state)
{
    uint32_t row = into(2, 10.0, (double)f.view.world.fixed[2].radius_m);
    (void)state;
    fixture_run(&f, 60);
    assert_int_equal(fixture_state(&f).fixed_damage[2], DAMAGE_NONE);
    assert_true(steps_rows(&f).row[row].harm_j == 0.0);
    assert_true(steps_rows(&f).row[row].vx > 5.0 && steps_rows(&f).row[row].vx < 10.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
}

static void test_no_extreme_of_mass_or_resistance_makes_a_nan(void **state)
{
    static const double masses[] = {0.001, 1.0, 1e9}, resistances[] = {1.0, 1e12};
    (void)state;
    for (int m = 0; m < 9; m++) {
        for (int r = 0; r < 2; r++) {
            fixture_close(&f);
            open_world(NULL);
            steps_kind(&f, "tank")->mass_kg = masses[m % 3];
            steps_kind(&f, "jeep")->mass_kg = masses[m / 3];
            steps_kind(&f, "tree")->resistance_j = resistances[r];
            steps_kind(&f, "tank")->explosive_kg = 0.0;
            steps_params(&f)->collision.damage_high = r == 0 ? 0.0 : 1.0;
            put("tank", 24994.0, 25000.0, 80.0);
            put("tank", 20000.0, 20000.0, 80.0);
            put("jeep", 20005.0, 20000.0, -80.0);
            fixture_run(&f, 3);
            struct entities e = steps_rows(&f);
            for (uint32_t i = 0; i < 3; i++)
                assert_true(isfinite(e.row[i].x) && isfinite(e.row[i].y) && isfinite(e.row[i].z) &&
                            isfinite(e.row[i].vx) && isfinite(e.row[i].vz) &&
                            isfinite(e.row[i].harm_j));
        }
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_head_on_impact_follows_newton),
        TEST(test_the_event_says_where_and_which_way),
        TEST(test_the_softer_of_the_two_decides_the_bounce),
        TEST(test_bodies_continue_from_where_they_touched),
        TEST(test_friction_drags_along_and_turns),
        TEST(test_half_of_the_work_of_friction_is_heat),
        TEST(test_without_friction_only_the_speed_along_the_normal_changes),
        TEST(test_a_wall_throws_it_back),
        TEST(test_what_breaks_costs_its_resistance_and_takes_momentum),
        TEST(test_what_breaks_changes_the_speed_along_the_normal_only),
        TEST(test_what_withstands_by_a_hair_stops_it),
        TEST(test_row_32_a_bush_does_and_takes_no_damage),
        TEST(test_no_extreme_of_mass_or_resistance_makes_a_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
