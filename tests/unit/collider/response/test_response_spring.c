/* The response "spring": rigidity and moldability of the kinds change its outcome (rows 26, 43). */
#include "tests/support/steps.h"
#include "world/entity/dent.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    steps_params(&f)->collision.response = MODEL_SPRING;
    return 0;
}

struct outcome_of_crash {
    double speed_mps, harm_j, plastic_m, elastic_m;
};

/* Two jeeps at 6 m/s, head on; what becomes of the first. */
static struct outcome_of_crash crash(double rigidity, double moldability)
{
    struct kind *jeep = steps_kind(&f, "jeep");
    steps_empty(&f);
    jeep->rigidity = rigidity;
    jeep->moldability = moldability;
    jeep->resistance_j = 1e12;
    uint32_t first = fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                             .at = {25000.0, 100.0, 25000.0},
                                                             .velocity = {6.0, 0.0, 0.0}});
    fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                            .at = {25003.3, 100.0, 25000.0},
                                            .velocity = {-6.0, 0.0, 0.0}});
    fixture_run(&f, 1);
    struct state now = fixture_state(&f);
    struct outcome_of_crash crash = {now.entities.row[first].vx, now.entities.row[first].harm_j,
                                     0.0, 0.0};
    if (now.head->dent_count == 2) {
        crash.plastic_m = (double)now.dents[0].plastic_m;
        crash.elastic_m = (double)now.dents[0].elastic_m;
    }
    return crash;
}

static void test_row_26_rigidity_changes_damage_and_dents(void **state)
{
    (void)state;
    struct outcome_of_crash soft = crash(0.1, 0.5), hard = crash(0.8, 0.5), stone = crash(1.0, 0.5);
    assert_true(hard.harm_j > soft.harm_j); /* at once, not into the skin */
    assert_true(hard.plastic_m < soft.plastic_m && hard.elastic_m < soft.elastic_m);
    assert_true(soft.plastic_m > 0.0 && stone.plastic_m == 0.0);
    assert_true(soft.speed_mps == hard.speed_mps); /* the stiffness decides that */
}

static void test_row_26_moldability_changes_damage_and_what_stays(void **state)
{
    (void)state;
    struct outcome_of_crash springy = crash(0.2, 0.1), clay = crash(0.2, 0.9);
    assert_true(clay.harm_j > springy.harm_j);
    assert_true(clay.plastic_m > springy.plastic_m && clay.elastic_m < springy.elastic_m);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_row_26_rigidity_changes_damage_and_dents),
        TEST(test_row_26_moldability_changes_damage_and_what_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
