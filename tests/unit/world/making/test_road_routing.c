/* Routes along roads: from a few points to all those of the ways between them. */
#include "world/making/road_routing.h"

#include "tests/support/fixture.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A cross of two roads about (1000, 1000), and one far away that meets neither. */
static struct road_point cross[] = {{0, 1000, 0, 0},   {1000, 1000, 0, 0}, {2000, 1000, 0, 0},
                                    {1000, 0, 1, 0},   {1000, 2000, 1, 0}, {9000, 9000, 2, 0},
                                    {9000, 9500, 2, 0}};

static struct error_text error;

/* Builds the routes of a scenario with one vehicle on the cross. */
static int build(struct world_build *built, struct scenario *scenario, const char *route)
{
    char text[512];
    snprintf(text, sizeof text,
             "vehicles = (\n{ kind = \"truck\"; roads = true;\nroute = ( %s ); },\n"
             "{ kind = \"jeep\"; route = ( [1, 2], [3, 4], [5, 6] ); } );",
             route);
    fixture_scenario(scenario, text);
    *built = (struct world_build){.scenario = scenario, .roads = cross};
    built->counts.road_points = sizeof cross / sizeof cross[0];
    return road_routing_build(built, &error);
}

static void finish(struct world_build *built, struct scenario *scenario)
{
    built->roads = NULL; /* not of the heap */
    world_build_free(built);
    scenario_free(scenario);
}

static void check_point(const struct world_build *built, uint32_t index, double x, double z)
{
    const struct route_point *p = &built->route_points[index];
    if (!(fabs(p->x - x) < 1e-6 && fabs(p->z - z) < 1e-6))
        fail_msg("point %u is (%.3f, %.3f), not (%.3f, %.3f)", index, p->x, p->z, x, z);
}

static void test_the_way_goes_over_the_crossing_and_back(void **state)
{
    struct world_build built;
    struct scenario scenario;
    (void)state;
    assert_int_equal(build(&built, &scenario, "[100, 1200], [1150, 1900]"), 0);
    /* Feet on the roads, the crossing between them, and home. */
    assert_int_equal(built.routes[0].first, 0);
    assert_int_equal(built.routes[0].count, 4);
    check_point(&built, 0, 100, 1000);
    check_point(&built, 1, 1000, 1000);
    check_point(&built, 2, 1000, 1900);
    check_point(&built, 3, 1000, 1000);
    /* A route without roads is as it was given. */
    assert_int_equal(built.routes[1].first, 4);
    assert_int_equal(built.routes[1].count, 3);
    check_point(&built, 6, 5, 6);
    assert_int_equal(built.counts.route_points, 7);
    assert_true(fabs(road_routing_length(&built, &built.routes[0]) - 3600.0) < 1e-9);
    struct route_place place = road_routing_place(&built, &built.routes[0], 1000.0);
    assert_true(fabs(place.x - 1000.0) < 1e-9 && fabs(place.z - 1100.0) < 1e-9);
    assert_true(fabs(place.heading - PI) < 1e-9);
    assert_int_equal(place.next, 2);
    place = road_routing_place(&built, &built.routes[0], -100.0); /* before its beginning */
    assert_true(fabs(place.x - 200.0) < 1e-9 && fabs(place.z - 1000.0) < 1e-9);
    assert_int_equal(place.next, 0);
    finish(&built, &scenario);
}

static void check_refusal(const char *route, const char *words)
{
    struct world_build built;
    struct scenario scenario;
    assert_int_equal(build(&built, &scenario, route), -1);
    if (!strstr(error.text, words))
        fail_msg("\"%s\" is not in: %s", words, error.text);
    finish(&built, &scenario);
}

static void test_what_no_road_leads_to_is_refused(void **state)
{
    (void)state;
    check_refusal("[100, 1000], [500, 1251]",
                  ":5: vehicles[0].route: point 2, [500, 1251], is 251 m from the nearest road; "
                  "allowed: up to 250 m; right would be: near [500, 1000]");
    check_refusal(
        "[100, 1000], [9000, 9200]",
        ":5: vehicles[0].route: no road leads from point 1, [100, 1000], to point 2, [9000, "
        "9200]; right would be: points on roads that meet");
}

static void test_ground_without_roads_is_refused(void **state)
{
    struct scenario scenario;
    struct world_build built;
    (void)state;
    fixture_scenario(&scenario, "vehicles = ( { kind = \"truck\"; roads = true; route = ( [1, 2], "
                                "[3, 4] ); } );");
    assert_int_equal(world_build_make(&built, &scenario, &error), -1);
    assert_non_null(strstr(error.text,
                           "vehicles[0].roads = true: this ground has no roads; right would "
                           "be: terrain.source = \"generated\""));
    scenario_free(&scenario);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_way_goes_over_the_crossing_and_back),
        cmocka_unit_test(test_what_no_road_leads_to_is_refused),
        cmocka_unit_test(test_ground_without_roads_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
