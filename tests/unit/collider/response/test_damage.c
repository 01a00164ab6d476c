/* Energy into damage: rows 26, 27, 30, 33. */
#include "collider/response/damage.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"tree\"; at = [25000.0, 25000.0]; } );");
    for (uint32_t n = 0; n < 3; n++)
        fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                .at = {20000.0 + 500.0 * n, 100.0, 20000.0}});
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

static const struct entities *rows(void)
{
    return &context.next->entities;
}

static void test_harm_adds_up_to_three_levels_and_destruction(void **state)
{
    static const struct {
        double share;
        enum damage damage;
    } blows[] = {{0.09, DAMAGE_NONE}, {0.02, DAMAGE_LOW},      {0.18, DAMAGE_LOW},
                 {0.02, DAMAGE_MED},  {0.28, DAMAGE_MED},      {0.02, DAMAGE_HIGH},
                 {0.38, DAMAGE_HIGH}, {0.02, DAMAGE_DESTROYED}};
    double resistance = steps_kind(&f, "jeep")->resistance_j, sum = 0.0;
    (void)state;
    for (size_t n = 0; n < sizeof blows / sizeof blows[0]; n++) {
        sum += blows[n].share * resistance;
        damage_row(&context, 0, blows[n].share * resistance, 0.0);
        assert_int_equal(rows()->row[0].damage, blows[n].damage);
        assert_true(fabs(rows()->row[0].harm_j - sum) < 1e-6);
        assert_int_equal(rows()->row[0].state,
                         blows[n].damage == DAMAGE_DESTROYED ? ENTITY_WRECK : ENTITY_ACTIVE);
    }
    assert_int_equal(context.next->head->tally.destroyed, 1);
    assert_int_equal(rows()->row[1].damage, DAMAGE_NONE);
}

static void test_no_energy_and_nonsense_do_no_damage(void **state)
{
    (void)state;
    damage_row(&context, 0, 0.0, 0.0);
    damage_row(&context, 0, -5.0, 0.0);
    damage_row(&context, 0, (double)NAN, 0.0);
    assert_true(rows()->row[0].harm_j == 0.0);
    assert_int_equal(rows()->row[0].state, ENTITY_ACTIVE);
}

static void test_one_is_destroyed_once(void **state)
{
    double resistance = steps_kind(&f, "jeep")->resistance_j;
    (void)state;
    damage_row(&context, 0, 3.0 * resistance, 0.25);
    assert_int_equal(context.charges->count, 1); /* what it carries burns */
    assert_true(context.charges->charge[0].time == 0.25 &&
                context.charges->charge[0].explosive_kg == 1.0);
    assert_int_equal(context.charges->charge[0].owner_id, 0);
    damage_row(&context, 0, 3.0 * resistance, 0.5);
    damage_destroy(&context, 0, 0.5);
    assert_int_equal(context.charges->count, 1);
    assert_int_equal(context.next->head->tally.destroyed, 1);
    assert_int_equal(rows()->row[0].behaviour, BEHAVIOUR_IDLE);
    assert_int_equal(rows()->row[0].order, BEHAVIOUR_IDLE);
    assert_int_equal(rows()->row[0].changed_tick, context.next->head->tick);
}

static void test_row_27_a_fixed_object_keeps_its_hardest_impact(void **state)
{
    double resistance = steps_kind(&f, "tree")->resistance_j;
    (void)state;
    assert_int_equal(damage_fixed_object(&context, 0, 0.4 * resistance), DAMAGE_MED);
    assert_int_equal(damage_fixed_object(&context, 0, 0.2 * resistance),
                     DAMAGE_MED); /* blows do not add */
    assert_int_equal(damage_fixed_object(&context, 0, 0.99 * resistance), DAMAGE_MED);
    assert_int_equal(context.next->head->tally.fixed_damaged, 1);
    assert_int_equal(damage_fixed_object(&context, 0, 1.0 * resistance), DAMAGE_HIGH);
    assert_int_equal(context.next->head->tally.fixed_damaged, 2);
    assert_int_equal(fixture_state(&f).fixed_damage[0], DAMAGE_NONE); /* the committed frame's */
}

static void test_row_27_a_kinds_own_constants_go_before_the_scenarios(void **state)
{
    struct kind *tree = steps_kind(&f, "tree");
    double resistance = tree->resistance_j;
    (void)state;
    tree->damage_low = 0.01;
    tree->damage_med = 0.5;
    assert_int_equal(damage_fixed_object(&context, 0, 0.009 * resistance), DAMAGE_NONE);
    assert_int_equal(damage_fixed_object(&context, 0, 0.02 * resistance), DAMAGE_LOW);
    assert_int_equal(damage_fixed_object(&context, 0, 0.4 * resistance), DAMAGE_LOW);
    assert_int_equal(damage_fixed_object(&context, 0, 0.5 * resistance), DAMAGE_MED);
    assert_int_equal(damage_fixed_object(&context, 0, 0.99 * resistance), DAMAGE_MED);
    tree->damage_high = 0.9; /* 0 before: the scenario's 1 */
    assert_int_equal(damage_fixed_object(&context, 0, 0.95 * resistance), DAMAGE_HIGH);
}

static void test_row_27_by_mass_an_object_keeps_its_hardest_impact(void **state)
{
    struct collision_params *limits = &steps_params(&f)->collision;
    (void)state;
    limits->mass_c1_kg = 3000.0;
    limits->mass_c2_kg = 2000.0;
    limits->mass_c3_kg = 1000.0;
    assert_int_equal(damage_fixed_mass(&context, 0, 999.9), DAMAGE_NONE);
    assert_int_equal(context.next->head->tally.fixed_damaged, 0);
    assert_int_equal(damage_fixed_mass(&context, 0, 2000.0), DAMAGE_MED);
    assert_int_equal(damage_fixed_mass(&context, 0, 1000.0), DAMAGE_MED);
    assert_int_equal(context.next->head->tally.fixed_damaged, 1);
    assert_int_equal(damage_fixed_mass(&context, 0, 3000.0), DAMAGE_HIGH);
    assert_int_equal(fixture_state(&f).fixed_damage[0], DAMAGE_NONE);
}

static void test_row_26_resistance_decides(void **state)
{
    (void)state;
    steps_kind(&f, "jeep")->resistance_j = 1000.0;
    damage_row(&context, 0, 999.0, 0.0);
    assert_int_equal(rows()->row[0].state, ENTITY_ACTIVE);
    steps_kind(&f, "jeep")->resistance_j = 998.0;
    rows()->row[1].until_tick = 5;
    damage_row(&context, 1, 999.0, 0.0);
    assert_int_equal(rows()->row[1].state, ENTITY_WRECK);
    assert_int_equal(rows()->row[1].until_tick, 0); /* the wreck is not at rest yet */
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_harm_adds_up_to_three_levels_and_destruction),
        TEST(test_no_energy_and_nonsense_do_no_damage),
        TEST(test_one_is_destroyed_once),
        TEST(test_row_27_a_fixed_object_keeps_its_hardest_impact),
        TEST(test_row_27_a_kinds_own_constants_go_before_the_scenarios),
        TEST(test_row_27_by_mass_an_object_keeps_its_hardest_impact),
        TEST(test_row_26_resistance_decides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
