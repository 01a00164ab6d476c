/* The loader: defaults, overrides, derived parameters, and the shipped kinds and scenarios. */
#include "config/ground_source.h"
#include "config/loader.h"

#include "config/syntax/schema.h"
#include "tests/support/quick_config.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"
#include "world/param_values.h"
#include "world/view_mode.h"
#include "world/world.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static struct error_text error;

/* Loads a text that must be accepted. */
static void must_load(struct scenario *scenario, const char *text, const char *override)
{
    if (quick_config_load(scenario, text, override, &error) != 0)
        fail_msg("refused: %s", error.text);
}

static const struct kind *kind_of(const struct scenario *scenario, const char *name)
{
    uint16_t index = kind_find(scenario->kinds, scenario->kind_count, name);

    assert_int_not_equal(index, KIND_NONE);
    return &scenario->kinds[index];
}

/* --- defaults and values -----------------------------------------------------------------------*/

static void test_empty_file_has_defaults(void **state)
{
    struct scenario s;

    (void)state;
    must_load(&s, "# nothing\n", NULL);
    assert_string_equal(s.settings->params.name, "unnamed");
    assert_string_equal(s.settings->params.scenario, quick_config.scenario_path);
    assert_int_equal(s.settings->params.seed, 1991);
    assert_true(s.settings->params.hz == 60.0 && s.settings->params.dt_s == 1.0 / 60.0);
    assert_int_equal(s.settings->params.capacity, 4096);
    assert_int_equal(s.settings->params.frame_limit, 0);
    assert_int_equal(s.settings->params.pace, PACE_REAL);
    assert_int_equal(s.settings->params.event_slots, 65536);
    assert_int_equal(s.settings->params.events_per_frame, 8192);
    assert_int_equal(s.settings->params.intents_per_frame, 4096);
    assert_int_equal(s.settings->params.command_slots, 1024);
    assert_int_equal(s.settings->params.crater_slots, 65536);
    assert_int_equal(s.settings->params.contact_slots, 16384);
    assert_int_equal(s.settings->params.initial_entities, 0);
    assert_int_equal(s.settings->terrain, TERRAIN_GENERATED);
    assert_true(s.settings->spacing_m == 31.25);
    assert_int_equal(s.settings->objects, OBJECTS_TABLE1);
    assert_int_equal(s.settings->params.collision.method, METHOD_SWEPT);
    assert_int_equal(s.settings->params.collision.shape, SHAPE_MODEL);
    assert_int_equal(s.settings->params.collision.response, MODEL_IMPULSE);
    assert_true(s.settings->params.collision.threshold_height_m == 60.0);
    assert_true(s.settings->params.collision.fast_vehicle_mps == 8.0);
    assert_true(s.settings->params.collision.fast_fixed_mps == 8.0);
    assert_true(s.settings->params.collision.large_fixed_kg == 20000.0);
    assert_true(s.settings->params.collision.damage_high == 1.0);
    assert_true(s.settings->params.collision.damage_med == 0.3);
    assert_true(s.settings->params.collision.damage_low == 0.1);
    assert_int_equal(s.settings->params.collision.nearness, NEARNESS_AND);
    assert_true(s.settings->params.collision.mps_near_m == 10.0);
    assert_int_equal(s.settings->params.collision.measure, MEASURE_ENERGY);
    assert_true(s.settings->params.collision.mass_c1_kg == 20000.0);
    assert_true(s.settings->params.collision.mass_c2_kg == 8000.0);
    assert_true(s.settings->params.collision.mass_c3_kg == 1000.0);
    assert_int_equal(s.settings->params.renderer.width, 1280);
    assert_int_equal(s.settings->params.renderer.height, 720);
    assert_true(s.settings->params.renderer.fps == 2.0);
    assert_int_equal(s.settings->params.renderer.views, 1u << VIEW_CHASE | 1u << VIEW_MAP);
    assert_int_equal(s.settings->params.renderer.follow, 0);
    assert_int_equal(s.settings->params.renderer.fog, 1);
    assert_int_equal(s.settings->params.renderer.haze, 1);
    assert_int_equal(s.settings->params.renderer.texture, 1);
    scenario_free(&s);
}

static void test_sizes_follow_capacity(void **state)
{
    static const struct {
        const char *override;
        uint32_t event_slots, intents, contacts;
    } rows[] = {
        {"world.capacity=16", 65536, 1056, 256},
        {"world.capacity=65", 65536, 1154, 260},
        {"world.capacity=4097", 131072, 8192, 16388},
        {"world.capacity=16384", 262144, 16384, 65536},
        {"world.capacity=65536", 1048576, 65536, 114688},
        {"world.capacity=1048576", 1048576, 65536, 1097728},
        {"world.contacts=1", 65536, 4096, 1},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct scenario s;

        must_load(&s, "", rows[i].override);
        assert_int_equal(s.settings->params.event_slots, rows[i].event_slots);
        assert_int_equal(s.settings->params.events_per_frame, rows[i].event_slots / 8);
        assert_int_equal(s.settings->params.intents_per_frame, rows[i].intents);
        assert_int_equal(s.settings->params.contact_slots, rows[i].contacts);
        scenario_free(&s);
    }
}

static void test_default_objects_depend_on_ground(void **state)
{
    static const struct {
        const char *text, *override;
        enum object_source objects;
        uint32_t count;
    } rows[] = {
        {"terrain = { source = \"flat\"; };", "world.seed=1", OBJECTS_NONE, 0},
        {"", "terrain.source=flat", OBJECTS_NONE, 0},
        {"terrain = { source = \"flat\"; }; objects = { source = \"table1\"; };", "world.seed=1",
         OBJECTS_TABLE1, 0},
        {"objects = { source = \"none\"; };", "world.seed=1", OBJECTS_NONE, 0},
        {"objects = ( { kind = \"tree\"; at = [1, 2.5]; } );", "world.seed=1", OBJECTS_LIST, 1},
        {"objects = ( );", "world.seed=1", OBJECTS_LIST, 0},
        {"objects = ( { kind = \"tree\"; at = [1, 2.5]; } );", "objects.source=none", OBJECTS_NONE,
         0},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct scenario s;

        must_load(&s, rows[i].text, rows[i].override);
        assert_int_equal(s.settings->objects, rows[i].objects);
        assert_int_equal(s.object_count, rows[i].count);
        scenario_free(&s);
    }
}

static void test_vehicle_entry(void **state)
{
    struct scenario s;

    (void)state;
    must_load(&s,
              "vehicles = (\n"
              "  { kind = \"tank\"; count = 3; force = \"blue\"; name = \"a\";\n"
              "    area = [1, 2, 3.5, 4]; fire_at_will = true; },\n"
              "  { kind = \"jet\"; name = \"V\"; at = [10, 20]; altitude_m = 300;\n"
              "    heading_deg = -90; speed_mps = 250; behaviour = \"hold\"; },\n"
              "  { kind = \"truck\"; route = ( [5, 6], [7, 8], [9, 10] ); },\n"
              "  { kind = \"jeep\"; at = [11, 12]; } );\n"
              "fires = ( { at_s = 2; shooter = \"a-3\"; target = \"V\"; },\n"
              "          { munition = \"artillery\"; point = [30, 40]; } );\n",
              NULL);
    assert_int_equal(s.group_count, 4);
    assert_int_equal(s.settings->params.initial_entities, 6);
    assert_int_equal(s.groups[0].kind, kind_find(s.kinds, s.kind_count, "tank"));
    assert_int_equal(s.groups[0].count, 3);
    assert_int_equal(s.groups[0].force, FORCE_BLUE);
    assert_int_equal(s.groups[0].behaviour, BEHAVIOUR_PATROL);
    assert_int_equal(s.groups[0].flags, ENTITY_FLAG_FIRE_AT_WILL);
    assert_false(s.groups[0].placed || s.groups[0].turned || s.groups[0].moving ||
                 s.groups[0].floating);
    assert_true(s.areas[s.groups[0].area].x1 == 3.5 && s.areas[s.groups[0].area].z1 == 4.0);
    assert_int_equal(s.groups[0].route, UINT32_MAX);
    assert_true(s.groups[1].placed && s.groups[1].turned && s.groups[1].moving &&
                s.groups[1].floating);
    assert_int_equal(s.groups[1].behaviour, BEHAVIOUR_HOLD);
    assert_int_equal(s.groups[1].force, FORCE_NEUTRAL);
    assert_true(s.groups[1].x == 10.0 && s.groups[1].z == 20.0);
    assert_true(fabs(s.groups[1].heading_rad - 1.5 * PI) < 1e-9);
    assert_true(s.groups[1].speed_mps == 250.0 && s.groups[1].altitude_m == 300.0);
    assert_int_equal(s.groups[2].behaviour, BEHAVIOUR_ROUTE);
    assert_int_equal(s.routes[s.groups[2].route].count, 3);
    assert_true(s.route_points[s.routes[s.groups[2].route].first + 1].z == 8.0);
    assert_true(s.areas[s.groups[2].area].x1 == 50000.0);
    assert_int_equal(s.groups[3].behaviour, BEHAVIOUR_IDLE);
    assert_int_equal(s.fire_count, 2);
    assert_string_equal(s.fires[0].shooter, "a-3");
    assert_string_equal(s.fires[0].target, "V");
    assert_int_equal(s.fires[0].munition, KIND_NONE);
    assert_int_equal(s.fires[0].line, 8);
    assert_int_equal(s.fires[1].munition, kind_find(s.kinds, s.kind_count, "artillery"));
    assert_true(s.fires[1].x == 30.0 && s.fires[1].z == 40.0);
    scenario_free(&s);
}

/* An override and the file store the same value, for every key that an override can set. */
/* One override of each key, and the text that says the same. */
static const struct {
    const char *override, *text;
} set_and_text[] = {
    {"world.name=here", "world = { name = \"here\"; };"},
    {"world.seed=7", "world = { seed = 7; };"},
    {"world.hz=10", "world = { hz = 10; };"},
    {"world.hz=12.5", "world = { hz = 12.5; };"},
    {"world.capacity=64", "world = { capacity = 64; };"},
    {"world.contacts=300", "world = { contacts = 300; };"},
    {"world.frames=9007199254740991", "world = { frames = 9007199254740991; };"},
    {"world.pace=max", "world = { pace = \"max\"; };"},
    {"world.cruise=true", "world = { cruise = true; };"},
    {"terrain.source=flat", "terrain = { source = \"flat\"; };"},
    {"terrain.height_m=-20.5", "terrain = { height_m = -20.5; };"},
    {"terrain.side_m=50000", "terrain = { side_m = 50000; };"},
    {"terrain.spacing_m=125", "terrain = { spacing_m = 125; };"},
    {"objects.source=none", "objects = { source = \"none\"; };"},
    {"collision.method=swept", "collision = { method = \"swept\"; };"},
    {"collision.method=brute", "collision = { method = \"brute\"; };"},
    {"collision.shape=sphere", "collision = { shape = \"sphere\"; };"},
    {"collision.shape=model", "collision = { shape = \"model\"; };"},
    {"collision.response=figure8", "collision = { response = \"figure8\"; };"},
    {"collision.npsnet2.nearness=or", "collision = { npsnet2 = { nearness = \"or\"; }; };"},
    {"collision.mps.near_m=25", "collision = { mps = { near_m = 25; }; };"},
    {"collision.figure8.measure=mass", "collision = { figure8 = { measure = \"mass\"; }; };"},
    {"collision.figure8.mass_c1_kg=30000", "collision = { figure8 = { mass_c1_kg = 30000; }; };"},
    {"collision.figure8.mass_c2_kg=9000", "collision = { figure8 = { mass_c2_kg = 9000; }; };"},
    {"collision.figure8.mass_c3_kg=0", "collision = { figure8 = { mass_c3_kg = 0; }; };"},
    {"collision.threshold_height_m=5", "collision = { threshold_height_m = 5; };"},
    {"collision.figure8.fast_vehicle_mps=1",
     "collision = { figure8 = { fast_vehicle_mps = 1; }; };"},
    {"collision.figure8.fast_fixed_mps=2", "collision = { figure8 = { fast_fixed_mps = 2; }; };"},
    {"collision.figure8.large_fixed_kg=3", "collision = { figure8 = { large_fixed_kg = 3; }; };"},
    {"collision.figure8.damage_high=4", "collision = { figure8 = { damage_high = 4; }; };"},
    {"collision.figure8.damage_med=0.5", "collision = { figure8 = { damage_med = 0.5; }; };"},
    {"collision.figure8.damage_low=0.25", "collision = { figure8 = { damage_low = 0.25; }; };"},
    {"world.wind_mps=12", "world = { wind_mps = 12; };"},
    {"world.wind_from_deg=90", "world = { wind_from_deg = 90; };"},
    {"battle.end_s=300", "battle = { end_s = 300; };"},
    {"battle.again_s=400", "battle = { again_s = 400; };"},
    {"recorder.when_full=pause", "recorder = { when_full = \"pause\"; };"},
    {"renderer.width=640", "renderer = { width = 640; };"},
    {"renderer.height=480", "renderer = { height = 480; };"},
    {"renderer.fps=0", "renderer = { fps = 0; };"},
    {"renderer.view=map", "renderer = { view = \"map\"; };"},
    {"renderer.follow=4294967295", "renderer = { follow = 4294967295; };"},
    {"world.seed=4294967296", "/* 1 */ world = { seed = 0x100000000; # [1\n };"},
    {"renderer.fog=false", "renderer = { fog = false; };"},
    {"renderer.haze=false", "renderer = { haze = false; };"},
    {"renderer.texture=false", "renderer = { texture = false; };"},
    {"renderer.view=map,orbit", "renderer = { view = \"map, orbit\"; };"},
    {"renderer.backend=soft", "renderer = { backend = \"soft\"; };"},
    {"renderer.hold=false", "renderer = { hold = false; };"},
    {"gateway.enabled=true", "gateway = { enabled = true; };"},
    {"gateway.address=239.1.2.3", "gateway = { address = \"239.1.2.3\"; };"},
    {"gateway.address=::1", "gateway = { address = \"::1\"; };"},
    {"gateway.interface=eth0", "gateway = { interface = \"eth0\"; };"},
    {"gateway.listen=[ff02::1]:3001", "gateway = { listen = \"[ff02::1]:3001\"; };"},
    {"gateway.port=3001", "gateway = { port = 3001; };"},
    {"gateway.exercise=2", "gateway = { exercise = 2; };"},
    {"gateway.site=7", "gateway = { site = 7; };"},
    {"gateway.application=36", "gateway = { application = 36; };"},
    {"gateway.applications=65533", "gateway = { applications = 65533; };"},
    {"gateway.version=6", "gateway = { version = 6; };"},
    {"gateway.rate=100", "gateway = { rate = 100; };"},
    {"gateway.listen=127.0.0.1:3001", "gateway = { listen = \"127.0.0.1:3001\"; };"},
    {"gateway.clamp=false", "gateway = { clamp = false; };"},
    {"gateway.timeout_s=60", "gateway = { timeout_s = 60; };"},
    {"world.remotes_max=100", "world = { remotes_max = 100; };"},
    {"gateway.latitude_deg=-30.5", "gateway = { latitude_deg = -30.5; };"},
    {"gateway.longitude_deg=10.25", "gateway = { longitude_deg = 10.25; };"},
    {"gateway.undulation_m=45.5", "gateway = { undulation_m = 45.5; };"},
    {"gateway.undulation_grid=true", "gateway = { undulation_grid = true; };"},
    {"gateway.peers=10.0.0.0/8", "gateway = { peers = \"10.0.0.0/8\"; };"},
    {"gateway.control=7:1, 8:*", "gateway = { control = \"7:1, 8:*\"; };"},
    {"gateway.cot=239.2.3.1:6969", "gateway = { cot = \"239.2.3.1:6969\"; };"},
};

/* Asserts that two scenarios have the same settings but for their hashes. */
static void assert_same_settings(const struct scenario *p, const struct scenario *q)
{
    p->settings->params.scenario_hash = q->settings->params.scenario_hash;
    assert_memory_equal(&p->settings->params, &q->settings->params, sizeof(p->settings->params));
    assert_true(p->settings->terrain == q->settings->terrain &&
                p->settings->objects == q->settings->objects &&
                p->settings->spacing_m == q->settings->spacing_m &&
                p->settings->flat_height_m == q->settings->flat_height_m);
}

static void test_override_equals_file(void **state)
{
    struct scenario plain;

    (void)state;
    must_load(&plain, "", NULL);
    for (size_t i = 0; i < COUNT(set_and_text); i++) {
        struct scenario with, file;

        must_load(&with, "", set_and_text[i].override);
        must_load(&file, set_and_text[i].text, NULL);
        assert_int_not_equal(with.settings->params.scenario_hash,
                             plain.settings->params.scenario_hash);
        assert_int_not_equal(file.settings->params.scenario_hash,
                             plain.settings->params.scenario_hash);
        assert_same_settings(&with, &file);
        scenario_free(&with);
        scenario_free(&file);
    }
    scenario_free(&plain);
}

static void test_every_key_is_overridden(void **state)
{
    (void)state;
    for (uint32_t key = 0; key < schema_scenario.count; key++) {
        const char *name = schema_scenario.keys[key].name;
        bool tried = strcmp(name, GROUND_SOURCE_KEY) == 0; /* test_ground_source.c has a file */

        for (size_t i = 0; i < COUNT(set_and_text); i++)
            tried |= strncmp(set_and_text[i].override, name, strlen(name)) == 0;
        if (!tried)
            fail_msg("no row sets %s", name);
    }
}

static void test_last_override_counts(void **state)
{
    static const char *const overrides[] = {"world.seed=5", "world.hz=30", "world.seed=6"};
    struct scenario s;

    (void)state;
    quick_config_write(quick_config.scenario_path, "world = { seed = 4; };");
    assert_int_equal(loader_scenario(&s, quick_config.data_dir, quick_config.scenario_path,
                                     overrides, 3, &error),
                     0);
    assert_int_equal(s.settings->params.seed, 6);
    assert_true(s.settings->params.hz == 30.0);
    scenario_free(&s);
}

static void test_same_input_same_hash(void **state)
{
    struct scenario a, b;

    (void)state;
    must_load(&a, "world = { seed = 4; };", NULL);
    must_load(&b, "world = { seed = 4; };", NULL);
    assert_int_equal(a.settings->params.scenario_hash, b.settings->params.scenario_hash);
    scenario_free(&b);
    must_load(&b, "world = { seed = 4; }; ", NULL);
    assert_int_not_equal(a.settings->params.scenario_hash, b.settings->params.scenario_hash);
    scenario_free(&a);
    scenario_free(&b);
}

/* Rows 42 to 45: every method can be combined with every shape and response (rows 27 to 29, 42,
 * 43). */
static void test_methods_shapes_and_responses_combine(void **state)
{
    (void)state;
    for (uint32_t method = 0; method < METHOD_COUNT; method++) {
        for (uint32_t shape = 0; shape < SHAPE_COUNT; shape++) {
            for (uint32_t response = 0; response < MODEL_COUNT; response++) {
                struct scenario s;
                char text[160];

                snprintf(text, sizeof(text),
                         "collision = { method = \"%s\"; shape = \"%s\"; response = \"%s\"; };",
                         method_name((enum method)method), shape_name((enum shape)shape),
                         response_model_name((enum response_model)response));
                must_load(&s, text, NULL);
                assert_int_equal(s.settings->params.collision.method, method);
                assert_int_equal(s.settings->params.collision.shape, shape);
                assert_int_equal(s.settings->params.collision.response, response);
                scenario_free(&s);
            }
        }
    }
}

static const char *const vehicles[] = {"tank",     "jet",       "ship",         "helicopter",
                                       "carrier",  "jeep",      "truck",        "helo-cow",
                                       "wishbone", "hamburger", "attack-tomato"};

/* The thesis's vehicles, with its Table 2 and the radius of its tanks. */
static void test_shipped_kinds(void **state)
{
    bool class_seen[OBJECT_CLASS_COUNT] = {false};
    struct scenario s;

    (void)state;
    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, NULL, NULL, 0, &error), 0);
    for (size_t i = 0; i < COUNT(vehicles); i++) {
        assert_true(kind_of(&s, vehicles[i])->domain <= DOMAIN_AIR);
        for (size_t j = 0; j < i; j++)
            assert_int_not_equal(kind_of(&s, vehicles[i])->model, kind_of(&s, vehicles[j])->model);
    }
    assert_true(kind_of(&s, "tank")->radius_m == 3.0);
    assert_true(fabs(kind_of(&s, "tank")->max_speed_mps - 60 / 3.6) < 0.01);
    assert_true(fabs(kind_of(&s, "ship")->max_speed_mps - 50 / 3.6) < 0.01);
    assert_true(fabs(kind_of(&s, "jet")->max_speed_mps - 1000 / 3.6) < 0.1);
    assert_int_equal(kind_of(&s, "tank")->munition, kind_find(s.kinds, s.kind_count, "shell"));
    assert_int_equal(kind_of(&s, "truck")->munition, KIND_NONE);
    assert_int_equal(kind_of(&s, "missile")->guidance, GUIDANCE_HOMING);
    assert_int_equal(kind_of(&s, "artillery")->craters, 1);
    assert_true(kind_of(&s, "artillery")->explosive_kg == 7.0);
    for (uint32_t i = 0; i < s.kind_count; i++) {
        if (s.kinds[i].domain == DOMAIN_FIXED)
            class_seen[s.kinds[i].object_class] = true;
        if (i > 0)
            assert_true(strcmp(s.kinds[i - 1].name, s.kinds[i].name) < 0);
    }
    for (int i = 0; i < OBJECT_CLASS_COUNT; i++)
        assert_true(class_seen[i]);
    scenario_free(&s);
}

/* --- shipped scenarios -------------------------------------------------------------------------*/

static void test_shipped_scenarios(void **state)
{
    bool seen[KIND_COUNT_MAX] = {false};
    struct scenario s;

    (void)state;
    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, NULL, NULL, 0, &error), 0);
    assert_string_equal(s.settings->params.name, "hunter-liggett");
    assert_int_equal(s.settings->params.initial_entities, 500);
    assert_int_equal(s.settings->objects, OBJECTS_TABLE1);
    for (uint32_t i = 0; i < s.group_count; i++)
        seen[s.groups[i].kind] = true;
    for (size_t i = 0; i < COUNT(vehicles); i++) {
        if (!seen[kind_find(s.kinds, s.kind_count, vehicles[i])])
            fail_msg("hunter-liggett has no %s", vehicles[i]);
    }
    scenario_free(&s);
    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error), 0);
    assert_int_equal(s.settings->params.initial_entities, 2);
    assert_int_equal(s.settings->terrain, TERRAIN_FLAT);
    scenario_free(&s);
    assert_int_equal(
        loader_scenario(&s, QUICK_CONFIG_SHIPPED, "proving-ground.cfg", NULL, 0, &error), 0);
    assert_int_equal(s.settings->objects, OBJECTS_LIST);
    assert_int_equal(s.object_count, 15);
    scenario_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty_file_has_defaults),
        cmocka_unit_test(test_sizes_follow_capacity),
        cmocka_unit_test(test_default_objects_depend_on_ground),
        cmocka_unit_test(test_vehicle_entry),
        cmocka_unit_test(test_override_equals_file),
        cmocka_unit_test(test_every_key_is_overridden),
        cmocka_unit_test(test_last_override_counts),
        cmocka_unit_test(test_same_input_same_hash),
        cmocka_unit_test(test_methods_shapes_and_responses_combine),
        cmocka_unit_test(test_shipped_kinds),
        cmocka_unit_test(test_shipped_scenarios),
    };

    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
