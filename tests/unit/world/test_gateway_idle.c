/* Settings of a gateway that a world does not have: which are named. */
#include "world/gateway_idle.h"

#include "config/syntax/schema.h"
#include "tests/support/fixture.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static char names[GATEWAY_IDLE_TEXT];

static bool idle(const char *scenario_text)
{
    struct scenario scenario;
    fixture_scenario(&scenario, scenario_text);
    bool result = gateway_idle_settings(&scenario.settings->params, names);
    scenario_free(&scenario);
    return result;
}

static void test_defaults_are_not_named(void **state)
{
    (void)state;
    assert_false(idle(""));
    assert_string_equal(names, "");
}

static void test_what_is_set_is_named(void **state)
{
    (void)state;
    assert_true(idle("gateway = { peers = \"10.0.0.0/8\"; };"));
    assert_string_equal(names, "gateway.peers");
    assert_true(idle("world = { remotes_max = 5; }; gateway = { control = \"7:1\"; site = 7; };"));
    assert_string_equal(names, "gateway.control, gateway.site, world.remotes_max");
}

static void test_a_gateway_uses_them(void **state)
{
    (void)state;
    assert_false(idle("gateway = { enabled = true; peers = \"10.0.0.0/8\"; };"));
}

static void test_a_place_is_not_named(void **state)
{
    (void)state;
    assert_false(idle("gateway = { latitude_deg = 46.0; longitude_deg = 7.0; };"));
}

/* Every key of the gateway is either named or the place of the world. */
static void test_all_keys_are_known(void **state)
{
    (void)state;
    assert_true(idle("world = { remotes_max = 5; }; gateway = {"
                     "address = \"10.0.0.5\"; port = 3001; listen = \"10.0.0.5\";"
                     "interface = \"eth0\"; exercise = 2; site = 2; application = 2;"
                     "applications = 2; version = 6; rate = 6; clamp = false; timeout_s = 60;"
                     "undulation_grid = true; cot = \"10.0.0.5\"; peers = \"none\";"
                     "control = \"7:1\"; };"));
    for (uint32_t i = 0; i < schema_scenario.count; i++) {
        const char *name = schema_scenario.keys[i].name;
        bool of_place = strcmp(name, "gateway.latitude_deg") == 0 ||
                        strcmp(name, "gateway.longitude_deg") == 0 ||
                        strcmp(name, "gateway.undulation_m") == 0;
        if (strncmp(name, "gateway.", 8) == 0 && strcmp(name, "gateway.enabled") != 0 && !of_place)
            assert_non_null(strstr(names, name));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults_are_not_named), cmocka_unit_test(test_what_is_set_is_named),
        cmocka_unit_test(test_a_gateway_uses_them),    cmocka_unit_test(test_a_place_is_not_named),
        cmocka_unit_test(test_all_keys_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
