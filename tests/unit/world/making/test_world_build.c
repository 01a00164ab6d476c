/* Building a world and its frame 0 from a scenario, and what is refused. */
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"

#include "tests/support/fixture.h"
#include "world/model.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/checksum.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static struct fixture f;

/* Builds a world that must be refused and gives the message. */
static const char *refusal(const char *text)
{
    static struct error_text error;
    struct scenario scenario;
    struct world_build built;
    fixture_scenario(&scenario, text);
    if (world_build_make(&built, &scenario, &error) == 0)
        fail_msg("taken: %s", text);
    scenario_free(&scenario);
    return error.text;
}

static void check_refusal(const char *text, const char *const words[], int count)
{
    const char *message = refusal(text);
    for (int i = 0; i < count; i++) {
        if (!strstr(message, words[i]))
            fail_msg("\"%s\" is not in: %s", words[i], message);
    }
}

static void test_vehicle_at_a_place_starts_as_it_was_told(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"jet\"; name = \"V\"; at = [25000.0, 24000.0]; "
                     "altitude_m = 300.0; heading_deg = 90.0; speed_mps = 250.0; force = \"red\"; "
                     "behaviour = \"hold\"; fire_at_will = true; } );");
    struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    const struct kind *kind = &f.view.world.kinds[fixture_kind(&f, "jet")];
    assert_int_equal(now.head->used, 1);
    assert_int_equal(e->row[0].id, 1);
    assert_int_equal(e->row[0].kind, fixture_kind(&f, "jet"));
    assert_int_equal(e->row[0].state, ENTITY_ACTIVE);
    assert_int_equal(e->row[0].force, FORCE_RED);
    assert_int_equal(e->row[0].behaviour, BEHAVIOUR_HOLD);
    assert_int_equal(e->row[0].order, BEHAVIOUR_HOLD);
    assert_int_equal(e->row[0].flags, ENTITY_FLAG_FIRE_AT_WILL);
    assert_true(e->row[0].x == 25000.0 && e->row[0].z == 24000.0 && e->row[0].y == 400.0);
    assert_true(fabs(e->row[0].heading - HALF_PI) < 1e-12);
    assert_true(fabs(e->row[0].vx - 250.0) < 1e-9 && e->row[0].vy == 0.0 &&
                fabs(e->row[0].vz) < 1e-9);
    assert_true(e->row[0].fuel_l == kind->fuel_l);
    assert_int_equal(e->row[0].rounds, kind->rounds);
    assert_int_equal(e->row[0].damage, DAMAGE_NONE);
    fixture_close(&f);
}

/* Each kind of vehicle can be had by name. Ships need water, which this world has not. */
static void test_every_kind_of_vehicle_spawns_by_name(void **state)
{
    static struct kind kinds[KIND_COUNT_MAX];
    (void)state;
    fixture_open(&f, "");
    uint32_t count = f.view.world.counts.kinds;
    memcpy(kinds, f.view.world.kinds, count * sizeof *kinds);
    fixture_close(&f);
    for (uint32_t i = 0; i < count; i++) {
        char text[128];
        if (kinds[i].domain != DOMAIN_LAND && kinds[i].domain != DOMAIN_AIR)
            continue;
        snprintf(text, sizeof text, "vehicles = ( { kind = \"%.*s\"; at = [25000.0, 25000.0]; } );",
                 KIND_NAME_MAX - 1, kinds[i].name);
        fixture_open(&f, text);
        assert_int_equal(fixture_state(&f).head->vehicles, 1);
        assert_string_equal(f.view.world.kinds[fixture_state(&f).entities.row[0].kind].name,
                            kinds[i].name);
        fixture_close(&f);
    }
}

static void test_group_is_placed_in_its_area_and_clear_of_each_other(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 30; area = [1000.0, 2000.0, 1200.0, "
                     "2200.0]; }, { kind = \"jeep\"; count = 20; area = [1100.0, 2100.0, 1300.0, "
                     "2300.0]; } );");
    struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    assert_int_equal(now.head->used, 50);
    for (uint32_t i = 0; i < 50; i++) {
        double low = i < 30 ? 1000.0 : 1100.0;
        assert_in_range(e->row[i].x, low, low + 200.0);
        assert_in_range(e->row[i].z, low + 1000.0, low + 1200.0);
        assert_true(e->row[i].y == FIXTURE_GROUND_M);
        assert_true(e->row[i].heading >= 0.0 && e->row[i].heading < TWO_PI);
        for (uint32_t j = 0; j < i; j++) {
            double dx = e->row[i].x - e->row[j].x, dz = e->row[i].z - e->row[j].z;
            double gap = f.view.world.kinds[e->row[i].kind].radius_m +
                         f.view.world.kinds[e->row[j].kind].radius_m;
            assert_true(dx * dx + dz * dz > gap * gap);
        }
    }
    fixture_close(&f);
}

/* Guns, rotors and crowns of the real shapes keep clear too: at first nobody overlaps anybody. */
static void test_real_shapes_start_clear_of_each_other(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };\n"
                     "objects = ( { kind = \"tree\"; at = [1050.0, 2050.0]; } );\n"
                     "vehicles = ( { kind = \"tank\"; count = 25; area = [1000.0, 2000.0, 1100.0, "
                     "2100.0]; } );");
    const struct world *world = &f.view.world;
    const struct kind *tank = &world->kinds[fixture_kind(&f, "tank")];
    const struct kind *tree = &world->kinds[fixture_kind(&f, "tree")];
    struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    assert_true(tank->level_m > tank->radius_m && tree->level_m > tree->radius_m);
    for (uint32_t i = 0; i < 25; i++) {
        assert_true(hypot(e->row[i].x - 1050.0, e->row[i].z - 2050.0) >
                    tank->level_m + tree->level_m);
        for (uint32_t j = 0; j < i; j++)
            assert_true(hypot(e->row[i].x - e->row[j].x, e->row[i].z - e->row[j].z) >
                        2.0 * tank->level_m);
    }
    fixture_close(&f);
}

static void test_frame_0_is_in_both_buffers_and_its_checksum_holds(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; count = 5; } );");
    for (int i = 0; i < 2; i++) {
        const struct state *w = &f.view.w[i];
        assert_int_equal(w->head->frame, 0);
        assert_int_equal(w->head->tick, 0);
        assert_int_equal(w->head->used, 5);
        assert_int_equal(w->head->vehicles, 5);
        assert_int_equal(w->head->munitions, 0);
        assert_int_equal(w->head->next_id, 6);
        assert_int_equal(w->head->event_end, 0);
        assert_int_equal(w->head->crater_count, 0);
        assert_int_equal(w->head->paused, 0);
        assert_true(w->head->time_scale == 1.0);
        assert_int_equal(w->head->checksum, state_checksum(w, f.view.world.counts.fixed));
    }
    assert_int_equal(state_digest(&f.view.world, &f.view.w[0]),
                     state_digest(&f.view.world, &f.view.w[1]));
    fixture_close(&f);
}

static void test_same_scenario_same_world_other_seed_another(void **state)
{
    const char *const worlds[] = {"world = { seed = 1; capacity = 64; };",
                                  "world = { seed = 1; capacity = 64; };",
                                  "world = { seed = 2; capacity = 64; };"};
    uint64_t digest[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s vehicles = ( { kind = \"tank\"; count = 20; } );",
                 worlds[i]);
        fixture_open(&f, text);
        digest[i] = fixture_digest(&f);
        fixture_close(&f);
    }
    assert_int_equal(digest[0], digest[1]);
    assert_int_not_equal(digest[0], digest[2]);
}

static void test_names_of_groups_are_numbered(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; name = \"alpha\"; count = 12; }, { kind = "
                     "\"jeep\"; count = 2; }, { kind = \"jeep\"; name = \"lone\"; } );");
    const struct world *world = &f.view.world;
    assert_int_equal(world->counts.names, 15);
    assert_string_equal(world_entity_name(world, 1), "alpha-1");
    assert_string_equal(world_entity_name(world, 12), "alpha-12");
    assert_string_equal(world_entity_name(world, 13), "");
    assert_string_equal(world_entity_name(world, 15), "lone");
    fixture_close(&f);
}

static void test_long_names_keep_their_numbers(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; name = \"abcdefghijklmno\"; count = 30; }, "
                     "{ kind = \"jeep\"; name = \"abcdefghijklmnopqrstuvw\"; } );");
    assert_string_equal(world_entity_name(&f.view.world, 30), "abcdefghijklmno-30");
    assert_string_equal(world_entity_name(&f.view.world, 31), "abcdefghijklmnopqrstuvw");
    fixture_close(&f);
}

static void test_fires_are_in_order_of_time_then_of_the_file(void **state)
{
    (void)state;
    fixture_open(&f, "vehicles = ( { kind = \"tank\"; name = \"A\"; at = [1000.0, 1000.0]; }, "
                     "{ kind = \"tank\"; name = \"B\"; at = [2000.0, 1000.0]; } );"
                     "fires = ( { at_s = 2.0; shooter = \"A\"; target = \"B\"; },"
                     "{ at_s = 1.0; munition = \"rocket\"; point = [3000.0, 1000.0]; },"
                     "{ at_s = 1.0; shooter = \"B\"; munition = \"missile\"; point = [5.0, 6.0]; },"
                     "{ at_s = 0.0; shooter = \"B\"; target = \"A\"; } );");
    const struct fire_order *fires = f.view.world.fires;
    assert_int_equal(f.view.world.counts.fires, 4);
    assert_int_equal(fires[0].tick, 1); /* nothing happens before the first step */
    assert_int_equal(fires[1].tick, 60);
    assert_int_equal(fires[2].tick, 60);
    assert_int_equal(fires[3].tick, 120);
    assert_int_equal(fires[0].shooter_slot, 1);
    assert_int_equal(fires[0].target_slot, 0);
    assert_int_equal(fires[0].kind, KIND_NONE);
    assert_int_equal(fires[1].shooter_slot, SLOT_NONE);
    assert_int_equal(fires[1].kind, fixture_kind(&f, "rocket"));
    assert_true(fires[1].x == 3000.0 && fires[1].z == 1000.0);
    assert_int_equal(fires[2].target_slot, SLOT_NONE);
    assert_int_equal(fires[2].kind, fixture_kind(&f, "missile"));
    assert_int_equal(fires[3].shooter_slot, 0);
    assert_int_equal(fires[3].target_slot, 1);
    fixture_close(&f);
}

/* rows 2, 3: objects lie in gridsquare order, and each square's are found from it */
static void test_listed_objects_are_in_gridsquare_order(void **state)
{
    (void)state;
    fixture_open(&f,
                 "objects = ( { kind = \"tree\"; at = [40000.0, 40000.0]; heading_deg = 90.0; },"
                 "{ kind = \"bush\"; at = [130.0, 10.0]; }, { kind = \"rock\"; at = [10.0, "
                 "10.0]; }, { kind = \"pole\"; at = [10.0, 40000.0]; } );");
    const struct world *world = &f.view.world;
    assert_int_equal(world->counts.fixed, 4);
    for (uint32_t i = 0; i < 4; i++) {
        const struct fixed_object *object = &world->fixed[i];
        uint32_t square = gridsquare_of(&GRIDSQUARES_DEFAULT, object->x, object->z);
        const uint32_t *reach;
        bool found = false;
        if (i > 0)
            assert_true(square >= gridsquare_of(&GRIDSQUARES_DEFAULT, world->fixed[i - 1].x,
                                                world->fixed[i - 1].z));
        for (uint32_t n = world_reach(world, square, &reach); n > 0; n--)
            found = found || reach[n - 1] == i;
        assert_true(found);
        assert_true(object->y == (float)FIXTURE_GROUND_M);
        assert_true(object->radius_m == (float)world->kinds[object->kind].radius_m);
        assert_int_equal(f.view.w[0].fixed_damage[i], DAMAGE_NONE);
    }
    assert_int_equal(world->fixed[3].turn, 16384); /* the tree: a quarter turn */
    fixture_close(&f);
}

static void test_static_parts_are_copied_whole(void **state)
{
    (void)state;
    fixture_open(&f,
                 "vehicles = ( { kind = \"truck\"; route = ( [1000.0, 1000.0], [2000.0, 1000.0], "
                 "[2000.0, 3000.0] ); area = [500.0, 500.0, 900.0, 900.0]; } );");
    const struct world *world = &f.view.world;
    const struct scenario *s = f.scenario;
    assert_int_equal(world->counts.kinds, s->kind_count);
    assert_memory_equal(world->kinds, s->kinds, s->kind_count * sizeof *s->kinds);
    assert_memory_equal(world->models, s->models, s->model_count * sizeof *s->models);
    assert_memory_equal(world->model_vertices, s->vertices, s->vertex_count * sizeof *s->vertices);
    assert_true(world->counts.hulls > 0);
    assert_int_equal(world->counts.hulls, s->hull_count);
    assert_memory_equal(world->hulls, s->hulls, s->hull_count * sizeof *s->hulls);
    assert_int_equal(world->counts.hull_vertices, s->hull_vertex_count);
    assert_memory_equal(world->hull_vertices, s->hull_vertices,
                        s->hull_vertex_count * sizeof *s->hull_vertices);
    assert_int_equal(world->counts.hull_planes, s->hull_plane_count);
    assert_memory_equal(world->hull_planes, s->hull_planes,
                        s->hull_plane_count * sizeof *s->hull_planes);
    struct params params = s->settings->params;
    memcpy(params.base, f.built->base, sizeof params.base);
    assert_memory_equal(world->params, &params, sizeof params);
    assert_int_equal(world->counts.routes, 1);
    assert_int_equal(world->routes[0].count, 3);
    assert_true(world->route_points[2].z == 3000.0);
    struct state now = fixture_state(&f);
    assert_int_equal(now.entities.row[0].behaviour, BEHAVIOUR_ROUTE);
    assert_int_equal(now.entities.row[0].order_arg, 0); /* its route */
    assert_int_equal(world->counts.posts_side, 401);
    assert_true(world->terrain.spacing_m == 125.0);
    assert_true(world->terrain.posts[401 * 401 - 1] == (float)FIXTURE_GROUND_M);
    fixture_close(&f);
}

static void test_full_table_is_no_mistake(void **state)
{
    (void)state;
    fixture_open(&f,
                 "world = { capacity = 16; }; vehicles = ( { kind = \"tank\"; count = 16; } );");
    assert_int_equal(fixture_state(&f).head->used, 16);
    fixture_run(&f, 3); /* and it runs */
    fixture_close(&f);
}

static void test_no_place_is_refused_with_kind_number_and_area(void **state)
{
    static const char *const ship[] = {"ship", "number 1 of 2", "[1000, 2000, 3000, 4000]",
                                       "wrong ground; right would be: ", "deep water"};
    static const char *const ashore[] = {
        ":4: vehicles[0].at = [1000, 2000]: a ship would stand on dry land", "a place on water"};
    static const char *const crowd[] = {"tank", "of 60", "crowded"};
    (void)state;
    check_refusal("vehicles = ( { kind = \"ship\"; count = 2; area = [1000.0, 2000.0, 3000.0, "
                  "4000.0]; } );",
                  ship, 5);
    check_refusal("vehicles = ( { kind = \"ship\"; at = [1000.0, 2000.0]; } );", ashore, 2);
    check_refusal("vehicles = ( { kind = \"tank\"; count = 60; area = [1000.0, 2000.0, 1020.0, "
                  "2020.0]; } );",
                  crowd, 3);
}

/* An altitude is for aircraft; a scenario that gives one to a tank leaves it on the ground. */
static void test_land_vehicles_start_on_the_ground(void **state)
{
    struct scenario scenario;
    struct world_build built;
    struct error_text error;
    (void)state;
    fixture_scenario(&scenario, "vehicles = ( { kind = \"tank\"; at = [1000.0, 1000.0]; } );");
    scenario.groups[0].floating = 1;
    scenario.groups[0].altitude_m = 50.0;
    assert_int_equal(world_build_make(&built, &scenario, &error), 0);
    assert_true(built.first.row[0].y == FIXTURE_GROUND_M);
    world_build_free(&built);
    scenario_free(&scenario);
}

/* The loader finds both of these first, in files; a scenario that comes another way must not pass.
 */
static void test_scenario_that_does_not_fit_is_refused(void **state)
{
    struct scenario scenario;
    struct world_build built;
    struct error_text error;
    (void)state;
    fixture_scenario(&scenario,
                     "vehicles = ( { kind = \"tank\"; name = \"A\"; count = 20; } );"
                     "fires = ( { at_s = 1.0; shooter = \"A-1\"; target = \"A-2\"; } );");
    scenario.settings->params.capacity = 19;
    assert_int_equal(world_build_make(&built, &scenario, &error), -1);
    assert_non_null(strstr(error.text, "world.capacity = 19"));
    assert_null(built.posts); /* nothing is left to free */
    scenario.settings->params.capacity = 20;
    snprintf(scenario.fires[0].shooter, sizeof scenario.fires[0].shooter, "nobody");
    assert_int_equal(world_build_make(&built, &scenario, &error), -1);
    assert_non_null(strstr(
        error.text, "fires[0].shooter = \"nobody\": no vehicle has that name; right would be: "));
    snprintf(scenario.fires[0].shooter, sizeof scenario.fires[0].shooter, "A-1");
    snprintf(scenario.fires[0].target, sizeof scenario.fires[0].target, "A-21");
    assert_int_equal(world_build_make(&built, &scenario, &error), -1);
    assert_non_null(strstr(error.text, "fires[0].target = \"A-21\""));
    scenario_free(&scenario);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vehicle_at_a_place_starts_as_it_was_told),
        cmocka_unit_test(test_every_kind_of_vehicle_spawns_by_name),
        cmocka_unit_test(test_group_is_placed_in_its_area_and_clear_of_each_other),
        cmocka_unit_test(test_real_shapes_start_clear_of_each_other),
        cmocka_unit_test(test_frame_0_is_in_both_buffers_and_its_checksum_holds),
        cmocka_unit_test(test_same_scenario_same_world_other_seed_another),
        cmocka_unit_test(test_names_of_groups_are_numbered),
        cmocka_unit_test(test_long_names_keep_their_numbers),
        cmocka_unit_test(test_fires_are_in_order_of_time_then_of_the_file),
        cmocka_unit_test(test_listed_objects_are_in_gridsquare_order),
        cmocka_unit_test(test_static_parts_are_copied_whole),
        cmocka_unit_test(test_full_table_is_no_mistake),
        cmocka_unit_test(test_no_place_is_refused_with_kind_number_and_area),
        cmocka_unit_test(test_land_vehicles_start_on_the_ground),
        cmocka_unit_test(test_scenario_that_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
