/* The parts of the shipped models that collide on their own. */
#include "config/mesh/model_parts.h"

#include "config/loader.h"
#include "tests/support/quick_config.h"
#include "world/entity/hull.h"
#include "world/making/scenario.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct scenario shipped;

static int load_shipped(void **state)
{
    struct error_text error;
    (void)state;
    return loader_scenario(&shipped, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error);
}

static int free_shipped(void **state)
{
    (void)state;
    scenario_free(&shipped);
    return 0;
}

static const struct kind *kind_of(const char *name)
{
    uint16_t index = kind_find(shipped.kinds, shipped.kind_count, name);
    assert_int_not_equal(index, KIND_NONE);
    return &shipped.kinds[index];
}

/* Hulls come in the order of their parts, and a part that turns has hulls of its own. */
static void check_parts(const struct kind *kind)
{
    uint32_t seen[HULL_PART_COUNT] = {0};
    for (uint32_t h = 0; h < kind->hull_count; h++) {
        uint32_t part = shipped.hulls[kind->first_hull + h].part;
        assert_in_range(part, 0, HULL_PART_COUNT - 1);
        assert_true(h == 0 || part >= shipped.hulls[kind->first_hull + h - 1].part);
        seen[part]++;
    }
    assert_int_equal(seen[HULL_PART_BODY], kind->body_hulls);
    assert_int_equal(seen[HULL_PART_TURRET] > 0, kind->part_count > HULL_PART_TURRET);
    assert_int_equal(seen[HULL_PART_GUN] > 0, kind->part_count > HULL_PART_GUN);
    for (uint32_t part = 0; part < kind->part_count; part++)
        assert_int_equal(shipped.hulls[kind->first_part_hull + part].part, part);
}

static void test_kinds_with_a_turret_have_three_parts(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];
        assert_int_equal(kind->part_count, kind->turret_rate_rps > 0.0 ? HULL_PART_COUNT : 0);
        check_parts(kind);
    }
}

static void test_only_turrets_and_guns_reach_further_than_the_model(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];
        assert_true(kind->part_count > 0 ? kind->reach_m >= kind->bound_m
                                         : kind->reach_m == kind->bound_m);
    }
    /* The muzzle is 5.95 m from the turret's axis, which is 0.2 m behind the middle. */
    assert_true(kind_of("tank")->reach_m > 6.15 && kind_of("tank")->reach_m < 7.0);
}

/* Parts turn about the same points as they are drawn (renderer/scene/model/mesh.c). */
static void test_pivots_are_those_of_the_visible_parts(void **state)
{
    const struct kind *tank = kind_of("tank");
    (void)state;
    assert_true(fabs(tank->turret_pivot.x + 0.2) < 1e-6 && fabs(tank->turret_pivot.z) < 1e-6);
    assert_true(fabs(tank->gun_pivot.x - 1.3) < 0.02 && fabs(tank->gun_pivot.y - 1.81) < 0.01);
    struct vec3 none =
        model_parts_pivot(&shipped, &shipped.models[kind_of("truck")->model], PART_TURRET);
    assert_true(none.x == 0.0 && none.y == 0.0 && none.z == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinds_with_a_turret_have_three_parts),
        cmocka_unit_test(test_only_turrets_and_guns_reach_further_than_the_model),
        cmocka_unit_test(test_pivots_are_those_of_the_visible_parts),
    };
    return cmocka_run_group_tests(tests, load_shipped, free_shipped);
}
