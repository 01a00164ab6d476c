/* One impact on one body: damage, and a dent where it was hit (thesis rows 33, 47). */
#include "collider/response/impact_damage.h"
#include "collider/response/deformation.h"
#include "collider/solver/contact_spring.h"
#include "tests/support/steps.h"
#include "world/entity/dent.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;
static uint32_t row;
static const struct impact impact = {
    .point = {25006.0, 901.0, 25000.0}, .normal = {1.0, 0.0, 0.0}, .time = 0.5};

/* A helicopter that looks east, struck on its nose. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    struct kind *kind = steps_kind(&f, "helicopter");
    kind->rigidity = 0.25;
    kind->moldability = 0.75;
    kind->resistance_j = 1e6;
    kind->explosive_kg = 0.0;
    row = fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                  .at = {25000.0, 900.0, 25000.0},
                                                  .heading_rad = HALF_PI});
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

static const struct dent *dent(uint32_t n)
{
    assert_true(context.next->head->dent_count == n + 1);
    return &context.next->dents[n];
}

static void test_rows_33_47_an_impact_damages_and_dents(void **state)
{
    (void)state;
    struct deformation deformation = deformation_of(steps_kind(&f, "helicopter"), 4e5);
    impact_damage_row(&context, row, &impact, -1.0, 4e5, NULL);
    assert_true(context.next->entities.row[row].harm_j == deformation.harm_j);
    assert_int_equal(context.next->entities.row[row].damage, DAMAGE_MED);
    assert_int_equal(dent(0)->id, row + 1);
    assert_true(fabs((double)dent(0)->plastic_m - deformation.plastic_m) < 1e-6);
    assert_true(fabs((double)dent(0)->elastic_m - deformation.elastic_m) < 1e-6);
    /* On its own axes: x forward, y up; inwards is backwards. */
    assert_true(fabsf(dent(0)->point[0] - 6.0f) < 1e-3f && fabsf(dent(0)->point[1] - 1.0f) < 1e-3f);
    assert_true(dent(0)->direction[0] < -0.999f);
    impact_damage_row(&context, row, &impact, 1.0, 4e5, NULL);
    assert_true(dent(1)->direction[0] > 0.999f); /* struck as the second of the two */
}

static void test_a_spring_dents_each_skin_by_half_its_compression(void **state)
{
    struct kind *kind = steps_kind(&f, "helicopter");
    (void)state;
    const struct contact_spring_impact spring = {.depth_m = 0.5, .left_m = 0.2};
    kind->rigidity = 0.0;
    kind->moldability = 1.0;
    impact_damage_row(&context, row, &impact, -1.0, 1.0, &spring);
    assert_true(fabsf(dent(0)->plastic_m - 0.1f) < 1e-6f);
    assert_true(fabsf(dent(0)->elastic_m - 0.15f) < 1e-6f);
}

static void test_row_26_a_rigid_skin_takes_less_of_the_spring(void **state)
{
    struct kind *kind = steps_kind(&f, "helicopter");
    (void)state;
    const struct contact_spring_impact spring = {.depth_m = 0.5, .left_m = 0.2};
    kind->rigidity = 0.6;
    kind->moldability = 0.5;
    impact_damage_row(&context, row, &impact, -1.0, 1.0, &spring);
    assert_true(fabsf(dent(0)->plastic_m - 0.02f) < 1e-6f);
    assert_true(fabsf(dent(0)->elastic_m - 0.08f) < 1e-6f);
    kind->rigidity = 1.0; /* gives way nowhere */
    impact_damage_row(&context, row, &impact, -1.0, 1.0, &spring);
    assert_int_equal(context.next->head->dent_count, 1);
}

static void test_no_energy_does_nothing(void **state)
{
    (void)state;
    impact_damage_row(&context, row, &impact, -1.0, 0.0, NULL);
    impact_damage_row(&context, row, &impact, -1.0, 10.0, NULL);
    assert_int_equal(context.next->head->dent_count, 0);
    assert_true(context.next->entities.row[row].harm_j <= 10.0);
}

/* What it cannot take destroys it; a wreck is dented further and harmed no more. */
static void test_a_wreck_is_dented_and_not_harmed(void **state)
{
    (void)state;
    impact_damage_row(&context, row, &impact, -1.0, 9e6, NULL);
    assert_int_equal(context.next->entities.row[row].state, ENTITY_WRECK);
    double harm = context.next->entities.row[row].harm_j;
    impact_damage_row(&context, row, &impact, -1.0, 9e6, NULL);
    assert_true(context.next->entities.row[row].harm_j == harm);
    assert_int_equal(context.next->head->tally.destroyed, 1);
    assert_int_equal(dent(1)->id, row + 1);
}

static void test_what_is_outside_breaks_before_the_frame(void **state)
{
    struct kind kind = {.resistance_j = 1e6};
    double room = 0.6e6 / IMPACT_HARM_OUTSIDE, harm = 0.0;
    (void)state;
    assert_true(fabs(impact_harm(&kind, 0.0, 1000.0) - 1000.0 * IMPACT_HARM_OUTSIDE) < 1e-6);
    assert_true(fabs(impact_harm(&kind, 0.0, room + 1000.0) - 0.6e6 - 1000.0 * IMPACT_HARM_INSIDE) <
                1e-6);
    assert_true(fabs(impact_harm(&kind, 0.7e6, 1000.0) - 1000.0 * IMPACT_HARM_INSIDE) < 1e-6);
    for (int n = 0; n < 100; n++) /* many small impacts are as bad as one of the same energy */
        harm += impact_harm(&kind, harm, 2.0 * room / 100.0);
    assert_true(fabs(harm - impact_harm(&kind, 0.0, 2.0 * room)) < 1e-3);
    assert_true(impact_harm(&kind, 0.0, 0.0) == 0.0);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_what_is_outside_breaks_before_the_frame),
        TEST(test_rows_33_47_an_impact_damages_and_dents),
        TEST(test_a_spring_dents_each_skin_by_half_its_compression),
        TEST(test_row_26_a_rigid_skin_takes_less_of_the_spring),
        TEST(test_no_energy_does_nothing),
        TEST(test_a_wreck_is_dented_and_not_harmed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
