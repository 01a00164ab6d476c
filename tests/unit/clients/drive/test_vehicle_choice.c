/* Choices of vehicles and targets, and the map, from a mirror that the test fills. */
#include "clients/drive/character_map.c" /* the unit tests are not linked with the processes */
#include "clients/drive/vehicle_choice.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define OURS   77
#define THEIRS 88

enum { TANK, TRUCK, SHELL, KINDS };

static struct world_mirror mirror;
static jolon_Entity entity[8];
static jolon_EntityName names[2] = {{.id = 3, .name = "Hauler"}, {.id = 5, .name = "Red-1"}};
static const struct vehicle_choice any = {.source = OURS, .from = 1, .force = -1, .kind = -1};

/* 1 is the present one, in the middle, heading north; a wreck and a shell are there too. */
static int open_mirror(void **state)
{
    (void)state;
    static const jolon_KindInfo kinds[KINDS] = {
        [TANK] = {.name = "tank", .domain = jolon_DOMAIN_LAND, .range_m = 2000.0f},
        [TRUCK] = {.name = "truck", .domain = jolon_DOMAIN_LAND},
        [SHELL] = {.name = "shell", .domain = jolon_DOMAIN_MUNITION},
    };
    static const jolon_Entity all[] = {
        {.id = 1, .kind = TANK, .force = jolon_FORCE_BLUE, .x_m = 1000, .z_m = 1000},
        {.id = 2, .kind = TANK, .force = jolon_FORCE_BLUE, .x_m = 1500, .z_m = 1000},
        {.id = 3, .kind = TRUCK, .force = jolon_FORCE_BLUE, .x_m = 1100, .z_m = 1000},
        {.id = 4, .kind = TANK, .force = jolon_FORCE_RED, .x_m = 1000, .z_m = 500},
        {.id = 5, .kind = TANK, .force = jolon_FORCE_RED, .x_m = 1010, .z_m = 200},
        {.id = 6, .kind = TANK, .force = jolon_FORCE_RED, .x_m = 1000, .z_m = 1400},
        {.id = 7, .kind = TANK, .force = jolon_FORCE_RED, .x_m = 1000, .z_m = 900},
        {.id = 8, .kind = SHELL, .force = jolon_FORCE_RED, .x_m = 1000, .z_m = 990},
    };
    mirror = (struct world_mirror){.name = "w", .has_world = true, .has_batch = true};
    memcpy(mirror.kinds, kinds, sizeof kinds);
    memcpy(entity, all, sizeof all);
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        entity[i].state = jolon_ENTITY_ACTIVE;
    entity[6].state = jolon_ENTITY_WRECK;
    mirror.world.side_m = 50000.0;
    mirror.world.kinds._length = KINDS;
    mirror.names.entry = names;
    mirror.names.count = 2;
    mirror.batch.entity = entity;
    mirror.batch.count = sizeof all / sizeof all[0];
    return 0;
}

static void test_next_goes_round(void **state)
{
    (void)state;
    struct vehicle_choice choice = any;
    assert_int_equal(vehicle_choice_next(&mirror, &choice, 1), 2);
    assert_int_equal(vehicle_choice_next(&mirror, &choice, -1), 6); /* no wreck, no shell */
    choice.from = 6;
    assert_int_equal(vehicle_choice_next(&mirror, &choice, 1), 1);
    choice.from = 0;
    assert_int_equal(vehicle_choice_next(&mirror, &choice, 1), 1);
}

static void test_other_drivers_are_left_alone(void **state)
{
    (void)state;
    entity[1].driver = THEIRS;
    entity[2].driver = OURS;
    assert_int_equal(vehicle_choice_next(&mirror, &any, 1), 3);
    entity[2].driver = THEIRS;
    assert_int_equal(vehicle_choice_nearest(&mirror, &any), 6);
}

static void test_nearest(void **state)
{
    (void)state;
    struct vehicle_choice choice = any;
    assert_int_equal(vehicle_choice_nearest(&mirror, &choice), 3);
    choice.kind = TANK;
    assert_int_equal(vehicle_choice_nearest(&mirror, &choice), 6);
    choice.force = FORCE_BLUE;
    assert_int_equal(vehicle_choice_nearest(&mirror, &choice), 2);
    choice.force = FORCE_NEUTRAL;
    assert_int_equal(vehicle_choice_nearest(&mirror, &choice), 0);
}

static void test_called(void **state)
{
    (void)state;
    struct error_text error;
    struct vehicle_choice choice = any;
    choice.from = 0;
    assert_int_equal(vehicle_choice_by_text(&mirror, &choice, "4", &error), 4);
    assert_int_equal(vehicle_choice_by_text(&mirror, &choice, "Hauler", &error), 3);
    assert_int_equal(vehicle_choice_by_text(&mirror, &choice, "truck", &error), 3);
    assert_int_equal(vehicle_choice_by_text(&mirror, &choice, "red", &error), 4);
    static const char *const wrong[] = {"",   "4711",           "shell", "neutral",
                                        "4x", "99999999999999", "-1"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_int_equal(vehicle_choice_by_text(&mirror, &choice, wrong[i], &error), 0);
        assert_non_null(strstr(error.text, "jolon world dump"));
    }
}

/* Ahead is north: 4 at 500 m, 5 at 800 m; 6 is behind, 7 a wreck. */
static void test_target(void **state)
{
    (void)state;
    const jolon_Entity *self = &entity[0];
    assert_int_equal(vehicle_choice_target(&mirror, self, 0, 0.0, 1.0, 2000.0), 4);
    assert_int_equal(vehicle_choice_target(&mirror, self, 4, 0.0, 1.0, 2000.0), 5);
    assert_int_equal(vehicle_choice_target(&mirror, self, 5, 0.0, 1.0, 2000.0), 4);
    assert_int_equal(vehicle_choice_target(&mirror, self, 0, PI, 1.0, 2000.0), 6);
    assert_int_equal(vehicle_choice_target(&mirror, self, 0, HALF_PI, 0.3, 2000.0), 0);
    assert_int_equal(vehicle_choice_target(&mirror, self, 0, 0.0, 1.0, 400.0), 0);
    entity[0].force = jolon_FORCE_NEUTRAL; /* everybody's enemy, if it wants to be */
    assert_int_equal(vehicle_choice_target(&mirror, self, 0, HALF_PI, 0.3, 2000.0), 3);
}

static void test_seen(void **state)
{
    (void)state;
    const jolon_Entity *seen = vehicle_choice_seen(&mirror, &entity[0], 0.0, 0.2, 5000.0);
    assert_int_equal(seen->id, 7);
    assert_null(vehicle_choice_seen(&mirror, &entity[0], -HALF_PI, 0.2, 5000.0));
    struct relative_position sight = vehicle_choice_relative(&entity[0], &entity[1]);
    assert_true(fabs(sight.bearing_rad - HALF_PI) < 1e-9 && fabs(sight.distance_m - 500.0) < 1e-9);
}

static void test_codes_differ(void **state)
{
    (void)state;
    char code[KINDS][3];
    character_map_codes(code, &mirror);
    assert_string_equal(code[TANK], "ta");
    assert_string_equal(code[TRUCK], "tr");
    assert_string_equal(code[SHELL], "sh");
}

static void test_chart(void **state)
{
    (void)state;
    static struct character_map map;
    character_map_draw(&map, &mirror, &entity[0], 4, 15, 21, 100.0);
    assert_string_equal(map.cell[7][10].text, "/\\"); /* in the middle, to the north */
    assert_string_equal(map.cell[7][15].text, "ta");
    assert_string_equal(map.cell[7][11].text, "tr");
    assert_string_equal(map.cell[2][10].text, "TA");
    assert_int_equal(map.cell[2][10].mark, CHARACTER_MAP_TARGET);
    assert_string_equal(map.cell[6][10].text, "xx");
    assert_string_equal(map.cell[0][0].text, " .");
    character_map_draw(&map, &mirror, &entity[0], 0, 15, 31, 100.0);
    assert_string_equal(map.cell[7][0].text, "//"); /* west of the world */
    character_map_draw(&map, &mirror, &entity[0], 0, 100000, -5, 100.0);
    assert_int_equal(map.rows, CHARACTER_MAP_ROWS_MAX);
    character_map_draw(&map, &mirror, NULL, 0, 15, 21, 100.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_next_goes_round, open_mirror),
        cmocka_unit_test_setup(test_other_drivers_are_left_alone, open_mirror),
        cmocka_unit_test_setup(test_nearest, open_mirror),
        cmocka_unit_test_setup(test_called, open_mirror),
        cmocka_unit_test_setup(test_target, open_mirror),
        cmocka_unit_test_setup(test_seen, open_mirror),
        cmocka_unit_test_setup(test_codes_differ, open_mirror),
        cmocka_unit_test_setup(test_chart, open_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
