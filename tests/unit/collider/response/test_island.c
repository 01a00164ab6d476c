/* Several bodies at one moment, overlaps, dents and springs, in whole frames (thesis rows 33, 36,
 * 43, 46, 47). */
#include "collider/response/contact_impulse.h"
#include "collider/response/island.h"
#include "collider/response/deformation.h"
#include "collider/response/impact_damage.h"
#include "collider/solver/contact_spring.h"
#include "tests/support/steps.h"
#include "world/entity/dent.h"
#include "world/params.h"
#include "world/terrain/fixed.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HIGH_M 900.0

static struct fixture f;

static void open_with(const char *text)
{
    fixture_open(&f, text);
    struct kind *kind = steps_kind(&f, "helicopter"); /* radius 6 */
    kind->restitution = 1.0;
    kind->friction = 0.0;
    kind->resistance_j = 1e12;
    kind->explosive_kg = 0.0;
}

static int open_world(void **state)
{
    (void)state;
    open_with("");
    return 0;
}

static uint32_t put(double x, double z, double vx, double vz)
{
    return fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                   .at = {x, HIGH_M, z},
                                                   .velocity = {vx, 0.0, vz}});
}

static const struct event_collision *collision(uint32_t n)
{
    const struct event *event = fixture_event(&f, EVENT_COLLISION, n);
    assert_non_null(event);
    return &event->collision;
}

/* --- three and more ----------------------------------------------------------------------------*/

static void test_row_36_an_impact_passes_through_a_row_of_bodies(void **state)
{
    (void)state;
    uint32_t first = put(20000.0 - 12.5, 20000.0, 60.0, 0.0);
    uint32_t row[4];
    for (int i = 0; i < 4; i++)
        row[i] = put(20000.0 + 12.0 * i, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 4);
    assert_true(fabs(e.row[first].vx) < 1e-9);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(e.row[row[i]].vx) < 1e-9);
    assert_true(fabs(e.row[row[3]].vx - 60.0) < 1e-9);
    assert_true(fabs(e.row[row[3]].x - (20036.0 + 0.5)) < 1e-6); /* half the frame was left */
}

static void test_row_36_two_at_once_share_an_impact(void **state)
{
    (void)state;
    /* The one in the middle meets both at the same moment, above and below its path. */
    uint32_t one = put(20000.0 - 9.6 - 0.5, 20000.0, 60.0, 0.0);
    uint32_t north = put(20000.0, 20000.0 - 7.2, 0.0, 0.0);
    uint32_t south = put(20000.0, 20000.0 + 7.2, 0.0, 0.0);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 2);
    assert_true(fabs(collision(0)->toi - 0.5) < 1e-9 && fabs(collision(1)->toi - 0.5) < 1e-9);
    assert_true(fabs(e.row[one].vz) < 1e-9);
    assert_true(fabs(e.row[north].vx - e.row[south].vx) < 1e-9 &&
                fabs(e.row[north].vz + e.row[south].vz) < 1e-9);
    assert_true(fabs(e.row[one].vx + e.row[north].vx + e.row[south].vx - 60.0) < 1e-9);
    double energy = 0.0;
    for (uint32_t i = 0; i < 3; i++)
        energy += e.row[i].vx * e.row[i].vx + e.row[i].vz * e.row[i].vz;
    assert_true(fabs(energy - 3600.0) < 1e-6); /* all of it comes back */
}

static void test_row_36_a_body_hit_twice_in_a_frame_responds_twice(void **state)
{
    (void)state;
    steps_params(&f)->dt_s = 0.1;
    uint32_t one = put(20000.0, 20000.0, 200.0, 0.0); /* meets two, which meets three */
    uint32_t two = put(20014.0, 20000.0, 0.0, 0.0), three = put(20028.0, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 2);
    assert_true(fabs(collision(0)->toi - 0.1) < 1e-9 && fabs(collision(1)->toi - 0.2) < 1e-9);
    assert_true(fabs(e.row[one].vx) < 1e-9 && fabs(e.row[two].vx) < 1e-9);
    assert_true(fabs(e.row[three].vx - 200.0) < 1e-9);
    assert_true(fabs(e.row[three].x - (20028.0 + 0.8 * 20.0)) < 1e-6);
}

/* An impact from the side parts two bodies at the moment in which they touch: there is no
 * collision. A second one drives the first into the other after all, within the frame. */
static void test_row_36_bodies_that_part_may_meet_later(void **state)
{
    (void)state;
    const double impact = 12.0 - 1e-10, x = 20000.0, z = 20000.0;
    const double cosine = 0.25881904510252074, sine = 0.9659258262890683; /* 75 degrees */
    steps_params(&f)->dt_s = 0.1;
    uint32_t one = put(x, z, 1.0, 0.0), two = put(x + impact, z, 0.0, 0.0);
    put(x + impact * cosine, z + impact * sine, -200.0 * cosine, -200.0 * sine);
    put(x - 18.4, z - 4.7, 600.0 * 0.988, 600.0 * 0.15);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_true(e.row[two].vx > 300.0);
    assert_true(e.row[two].x > e.row[one].x + 12.0);
}

/* Slowed by a bush at the moment in which it strikes a tank, it has struck the tank once. */
static void test_row_36_a_bush_beside_makes_no_second_collision(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "objects = ( { kind = \"bush\"; at = [25000.0, 25000.0]; } );");
    const struct fixed_object *bush = &f.view.world.fixed[0];
    steps_kind(&f, "tank")->resistance_j = 1e12;
    double radius = steps_kind(&f, "tank")->radius_m, y = (double)bush->y;
    double x = bush->x - radius - (double)bush->radius_m - 0.25;
    uint32_t one =
        fixture_put(&f, (struct fixture_entity){
                            .kind = "tank", .at = {x, y, bush->z}, .velocity = {30.0, 0.0, 0.0}});
    double ahead = 2.0 * radius + 0.25 - 1e-10; /* the bush comes a little later */
    uint32_t two =
        fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = {x + ahead, y, bush->z}});
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 2);
    assert_true(fabs(collision(0)->toi - collision(1)->toi) < CONTACT_TIE);
    assert_true(collision(0)->b.fixed != collision(1)->b.fixed);
    assert_true(e.row[two].vx > 10.0 && e.row[one].vx < e.row[two].vx);
}

/* --- overlaps ----------------------------------------------------------------------------------*/

static void test_row_46_overlapping_bodies_part_exactly(void **state)
{
    (void)state;
    steps_kind(&f, "jet")->restitution = 0.0; /* radius 7 */
    steps_kind(&f, "jet")->resistance_j = 1e12;
    steps_kind(&f, "jet")->mass_kg = 4.0 * steps_kind(&f, "helicopter")->mass_kg;
    uint32_t light = put(20000.0, 20000.0, 1.0, 0.0);
    uint32_t heavy = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                             .at = {20010.0, HIGH_M, 20000.0},
                                                             .velocity = {0, 0, 0}});
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_true(e.row[heavy].x - e.row[light].x >= 13.0 - 1e-9);
    assert_true(e.row[heavy].x - e.row[light].x < 13.0 + 0.1);
    /* 3 m, the light one four times as far. */
    double pushed = e.row[heavy].x - 20010.0, way = 0.2 / 60.0; /* both go on at 0.2 m/s */
    assert_true(fabs(pushed - 0.6 - way) < 1e-6);
}

/* Two bodies that are so deep in each other and close at 6 m/s
 * bounce, and part by 6 mm each. */
static void bounce_and_part(const char *kind, double height_m, double apart_m, double deep_m)
{
    uint32_t row[2];
    fixture_close(&f);
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (int n = 0; n < 2; n++)
        row[n] =
            fixture_put(&f, (struct fixture_entity){
                                .kind = kind,
                                .at = {25000.0 + apart_m * n, FIXTURE_GROUND_M + height_m, 25000.0},
                                .velocity = {n == 0 ? 3.0 : -3.0}});
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    e.row[row[1]].x -= steps_gap(&f, &e, row[0], row[1]) + deep_m;
    fixture_forget_copies(&f);
    const struct vec3 before[2] = {entities_position(&e, row[0]), entities_position(&e, row[1])};
    fixture_run(&f, 1);
    e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    for (int n = 0; n < 2; n++) {
        struct vec3 way = vec3_sub(entities_position(&e, row[n]), before[n]);
        way = vec3_sub(way, vec3_scale(entities_velocity(&e, row[n]), 1.0 / 60.0));
        print_message("a %s was shifted by %.3f mm\n", kind, 1e3 * vec3_length(way));
        assert_true(fabs(vec3_length(way) - 0.006) < 1e-5);
    }
}

static void test_row_46_an_impact_on_the_ground_shifts_bodies_a_little(void **state)
{
    (void)state;
    bounce_and_part("jeep", 0.0, 8.0, 0.015);
}

/* Jets that hooked into each other head-on were moved apart by 0.9 m in a frame. */
static void test_row_46_an_impact_shifts_aircraft_a_little(void **state)
{
    (void)state;
    bounce_and_part("jet", 800.0, 18.0, 0.2);
}

static struct vec3 momentum_of(const struct entities *e, const uint32_t row[2])
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int n = 0; n < 2; n++)
        sum = vec3_add(sum, vec3_scale(entities_velocity(e, row[n]),
                                       f.view.world.kinds[e->row[row[n]].kind].mass_kg));
    return sum;
}

/* The lighter one is shifted by 6 mm, and the heavier by its share of that. When each was shifted
 * by up to 6 mm, their centre of mass moved, and so the momentum that turns them about it grew. */
static void test_row_43_aircraft_are_shifted_about_their_centre_of_mass(void **state)
{
    static const char *const kinds[2] = {"helicopter", "jet"};
    uint32_t row[2];
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (int n = 0; n < 2; n++)
        row[n] = fixture_put(
            &f, (struct fixture_entity){.kind = kinds[n],
                                        .at = {25000.0 + 18.0 * n, HIGH_M, 25000.0 + 1.0 * n},
                                        .velocity = {n == 0 ? 3.0 : -3.0}});
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    while (steps_gap(&f, &e, row[0], row[1]) > 0.0)
        e.row[row[1]].x -= 0.1;
    fixture_forget_copies(&f);
    struct vec3 before = momentum_of(&e, row);
    fixture_run(&f, 1);
    e = steps_rows(&f);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    assert_true(vec3_length(vec3_sub(momentum_of(&e, row), before)) < 1e-9 * vec3_length(before));
}

/* A truck that turns on the spot sweeps its corners into the body beside it. */
static void test_a_vehicle_turning_in_place_meets_its_neighbour(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "collision = { shape = \"model\"; };");
    uint32_t truck =
        fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {20000.0, 100.0, 20000.0}});
    fixture_put(&f, (struct fixture_entity){.kind = "truck", .at = {20003.0, 100.0, 20000.0}});
    struct entities e = steps_rows(&f);
    e.row[truck].spin_y = -6.0; /* both look north; it turns to the right */
    fixture_run(&f, 30);
    assert_true(fixture_event_count(&f, EVENT_COLLISION) >= 1);
    assert_true(steps_speed(&f, 1) > 0.0); /* pushed aside */
}

/* A pilot steers the nose of a helicopter, which has no spin, into one that flies away from it. No
 * impulse answers that: the turn ends at the contact. */
static void test_a_pilot_cannot_steer_into_a_neighbour(void **state)
{
    (void)state;
    fixture_close(&f);
    open_with(
        "world = { seed = 1; capacity = 16; hz = 10.0; }; collision = { shape = \"model\"; };");
    const struct kind *kind = steps_kind(&f, "helicopter");
    double apart = 0.5 * (kind->length_m + kind->width_m) - 3.0;
    uint32_t row = put(20000.0, 20000.0, 0.0, 0.0);
    put(20000.0 + apart, 20000.0 - 0.2 * kind->length_m, 0.5, 0.5);
    for (int frame = 0; frame < 20; frame++) {
        steps_drive(&f, row, 0.0, 1.0, 0.0);
        fixture_run(&f, 1);
        struct free_turn turn[2];
        struct body_motion *motion = &f.stepper.collider.motion;
        struct swept_body a = body_motion_body(motion, 0, &turn[0]);
        struct swept_body b = body_motion_body(motion, 1, &turn[1]);
        assert_true(time_of_impact_gap(&a, &b, 1.0) > 0.0);
    }
    assert_true(fixture_event_count(&f, EVENT_COLLISION) >= 1);
}

/* --- dents -------------------------------------------------------------------------------------*/

static void test_rows_33_47_a_blow_leaves_a_dent_where_it_struck(void **state)
{
    (void)state;
    struct kind *kind = steps_kind(&f, "helicopter");
    kind->restitution = 0.0;
    kind->rigidity = 0.25;
    kind->moldability = 0.75;
    kind->resistance_j = 1e7;
    uint32_t one = put(20000.0 - 12.5, 20000.0, 60.0, 0.0), two = put(20000.0, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    struct state now = fixture_state(&f);
    double half = 0.5 * 0.5 * (0.5 * kind->mass_kg) * 3600.0; /* half of what is lost */
    struct deformation crush = deformation_of(kind, half * IMPACT_HARM_OUTSIDE);
    assert_int_equal(now.head->dent_count, 2);
    assert_int_equal(now.dents[0].id, one + 1);
    assert_int_equal(now.dents[1].id, two + 1);
    for (int i = 0; i < 2; i++) {
        assert_true(fabs((double)now.dents[i].plastic_m - crush.plastic_m) < 1e-6);
        assert_true(fabs((double)now.dents[i].elastic_m - crush.elastic_m) < 1e-6);
        assert_int_equal(now.dents[i].tick, 1);
    }
    /* The first flies east and is struck on its nose; the second looks north: on its left. */
    assert_true(fabsf(now.dents[0].point[0] - 6.0f) < 1e-3f && now.dents[0].direction[0] < -0.999f);
    assert_true(fabsf(now.dents[1].point[2] + 6.0f) < 1e-3f && now.dents[1].direction[2] > 0.999f);
}

static void test_dents_beyond_the_list_are_counted(void **state)
{
    (void)state;
    steps_kind(&f, "helicopter")->restitution = 0.0;
    steps_kind(&f, "helicopter")->resistance_j = 1e6;
    steps_params(&f)->dent_slots = 1;
    put(20000.0 - 12.5, 20000.0, 30.0, 0.0);
    put(20000.0, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    assert_int_equal(fixture_state(&f).head->dent_count, 1);
    assert_int_equal(fixture_state(&f).head->tally.dents_refused, 1);
}

static void test_a_light_contact_leaves_no_dent(void **state)
{
    (void)state;
    put(20000.0 - 12.001, 20000.0, 0.5, 0.0);
    put(20000.0, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    assert_int_equal(fixture_state(&f).head->dent_count, 0);
}

/* --- springs -----------------------------------------------------------------------------------*/

static void test_row_43_a_spring_returns_speed_by_restitution(void **state)
{
    (void)state;
    fixture_close(&f);
    open_with("collision = { response = \"spring\"; shape = \"sphere\"; };");
    struct kind *kind = steps_kind(&f, "helicopter");
    kind->restitution = 0.5;
    kind->rigidity = 0.0;
    kind->moldability = 1.0;
    uint32_t one = put(20000.0 - 12.5, 20000.0, 60.0, 0.0), two = put(20000.0, 20000.0, 0.0, 0.0);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.row[one].vx + e.row[two].vx - 60.0) < 1e-9);
    assert_true(fabs(e.row[two].vx - e.row[one].vx - 30.0) < 1e-9);
    const struct contact_spring spring = {
        .reduced_kg = 0.5 * kind->mass_kg,
        .closing_mps = 60.0,
        .stiffness_npm = contact_spring_in_series(kind->stiffness_npm, kind->stiffness_npm),
        .restitution = 0.5};
    struct contact_spring_impact blow = contact_spring_impact(&spring);
    assert_true(fabs((double)collision(0)->impulse_ns / blow.impulse_ns - 1.0) < 1e-6);
    struct state now = fixture_state(&f);
    assert_int_equal(now.head->dent_count, 2); /* each skin by half of the spring's compression */
    assert_true(fabs((double)now.dents[0].plastic_m - 0.5 * blow.left_m) < 1e-6);
    assert_true(fabs((double)(now.dents[1].plastic_m + now.dents[1].elastic_m) -
                     0.5 * blow.depth_m) < 1e-6);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_36_an_impact_passes_through_a_row_of_bodies),
        TEST(test_row_36_two_at_once_share_an_impact),
        TEST(test_row_36_a_body_hit_twice_in_a_frame_responds_twice),
        TEST(test_row_36_bodies_that_part_may_meet_later),
        TEST(test_row_36_a_bush_beside_makes_no_second_collision),
        TEST(test_row_43_aircraft_are_shifted_about_their_centre_of_mass),
        TEST(test_row_46_overlapping_bodies_part_exactly),
        TEST(test_row_46_an_impact_on_the_ground_shifts_bodies_a_little),
        TEST(test_row_46_an_impact_shifts_aircraft_a_little),
        TEST(test_a_vehicle_turning_in_place_meets_its_neighbour),
        TEST(test_a_pilot_cannot_steer_into_a_neighbour),
        TEST(test_rows_33_47_a_blow_leaves_a_dent_where_it_struck),
        TEST(test_dents_beyond_the_list_are_counted),
        TEST(test_a_light_contact_leaves_no_dent),
        TEST(test_row_43_a_spring_returns_speed_by_restitution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
