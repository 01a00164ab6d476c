/* Settings of an existing world: which may change, and that a change shows in the hash. */
#include "config/loader.h"

#include "tests/support/fixture.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct params made;
static struct error_text error;

static int make_params(void **state)
{
    struct scenario scenario;
    (void)state;
    fixture_scenario(&scenario, "");
    made = scenario.settings->params;
    scenario_free(&scenario);
    return 0;
}

static int branch(struct params *params, const char *one, const char *two)
{
    const char *const overrides[] = {one, two};
    *params = made;
    return loader_branch(params, overrides, two ? 2 : 1, &error);
}

static void test_changes_are_stored_and_change_the_hash(void **state)
{
    struct params params, other;
    (void)state;
    assert_int_equal(branch(&params, "world.seed=7", NULL), 0);
    assert_int_equal(params.seed, 7);
    assert_int_not_equal(params.scenario_hash, made.scenario_hash);
    assert_int_equal(branch(&other, "world.seed=8", NULL), 0);
    assert_int_not_equal(other.scenario_hash, params.scenario_hash);
    assert_int_equal(branch(&params, "world.hz=50", "collision.response=figure8"), 0);
    assert_true(params.dt_s == 1.0 / 50.0);
    assert_int_equal(params.collision.response, MODEL_FIGURE8);
    assert_int_equal(branch(&params, "collision.method=brute", "collision.shape=model"), 0);
    assert_int_equal(branch(&params, "world.frames=100", "world.pace=max"), 0);
    assert_int_equal(params.frame_limit, 100);
    assert_int_equal(branch(&params, "renderer.width=640", "gateway.site=5"), 0);
    assert_int_equal(branch(&params, "world.wind_mps=3", "world.wind_from_deg=10"), 0);
    assert_int_equal(branch(&params, "world.cruise=true", "recorder.when_full=pause"), 0);
    assert_int_equal(branch(&params, "battle.end_s=50", "battle.again_s=3"), 0);
}

/* The same overrides at every start of a service leave it the same world. */
static void test_same_values_keep_the_hash(void **state)
{
    struct params params;
    (void)state;
    assert_int_equal(branch(&params, "world.seed=1", NULL), 0);
    assert_int_equal(params.scenario_hash, made.scenario_hash);
    assert_memory_equal(&params, &made, sizeof made);
}

static void test_other_keys_are_refused_by_name(void **state)
{
    static const char *const fixed[] = {"world.capacity=128",    "world.contacts=999",
                                        "world.remotes_max=9",   "terrain.source=generated",
                                        "terrain.spacing_m=125", "terrain.height_m=5",
                                        "objects.source=none"};
    struct params params;
    char name[64];
    (void)state;
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        assert_int_equal(branch(&params, "world.seed=7", fixed[i]), -1);
        snprintf(name, sizeof name, "%.*s", (int)strcspn(fixed[i], "="), fixed[i]);
        assert_non_null(strstr(error.text, name));
        assert_non_null(strstr(error.text, "allowed: world.seed, hz, frames"));
        assert_memory_equal(&params, &made,
                            sizeof made); /* a refusal leaves the first override undone */
    }
}

static void test_rules_of_values_hold(void **state)
{
    struct params params;
    (void)state;
    assert_int_equal(branch(&params, "world.hz=0", NULL), -1);
    assert_non_null(strstr(error.text, "world.hz = 0"));
    assert_int_equal(branch(&params, "world.sede=7", NULL), -1);
    assert_non_null(strstr(error.text, "unknown key"));
    assert_int_equal(branch(&params, "seven", NULL), -1);
    assert_int_equal(branch(&params, "collision.figure8.damage_low=5", NULL), -1);
    assert_non_null(strstr(error.text, "not below"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_changes_are_stored_and_change_the_hash),
        cmocka_unit_test(test_same_values_keep_the_hash),
        cmocka_unit_test(test_other_keys_are_refused_by_name),
        cmocka_unit_test(test_rules_of_values_hold),
    };
    return cmocka_run_group_tests(tests, make_params, NULL);
}
