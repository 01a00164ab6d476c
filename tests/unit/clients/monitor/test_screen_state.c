/* The monitor's table and screen state: filtering, sorting, and the effect of keys. */
#include "clients/monitor/screen_state.c" /* the unit tests are not linked with the processes */
#include "clients/monitor/vehicle_table.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE_M 50000.0

static jolon_Entity entities[5];
static struct world_mirror mirror;
static struct vehicle_table table;
static struct screen_state screen;

const char *world_mirror_kind_name(const struct world_mirror *from, uint32_t kind)
{
    (void)from;
    return kind == 0 ? "tank" : kind == 1 ? "jeep" : "shell";
}

const char *name_table_of(const struct name_table *names, uint32_t id)
{
    (void)names;
    return id == 30 ? "Padre" : "";
}

static int setup(void **state)
{
    static const struct {
        uint16_t kind;
        jolon_Force force;
        jolon_Behaviour behaviour;
        float speed;
    } rows[5] = {{0, jolon_FORCE_BLUE, jolon_BEHAVIOUR_PATROL, 12.0f},
                 {1, jolon_FORCE_RED, jolon_BEHAVIOUR_FLEE, 25.0f},
                 {0, jolon_FORCE_RED, jolon_BEHAVIOUR_ATTACK, 0.0f},
                 {2, jolon_FORCE_RED, jolon_BEHAVIOUR_FLIGHT, 900.0f},
                 {1, jolon_FORCE_NEUTRAL, jolon_BEHAVIOUR_IDLE, 0.0f}};
    (void)state;
    for (uint32_t i = 0; i < 5; i++)
        entities[i] = (jolon_Entity){.id = 10 * (i + 1),
                                     .kind = rows[i].kind,
                                     .state = jolon_ENTITY_ACTIVE,
                                     .force = rows[i].force,
                                     .behaviour = rows[i].behaviour,
                                     .vx_mps = rows[i].speed,
                                     .x_m = 1000.0 * (double)i,
                                     .z_m = 2000.0 * (double)i,
                                     .rounds = 5 - i};
    mirror = (struct world_mirror){.has_batch = true, .batch = {.entity = entities, .count = 5}};
    screen_state_begin(&screen, SIDE_M);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    vehicle_table_free(&table);
    return 0;
}

/* The ids in the table, as one number a digit pair: 10, 20 -> 1020. */
static uint64_t ids(const char *filter, enum vehicle_table_column sort, bool descending)
{
    uint64_t all = 0;
    assert_true(vehicle_table_build(&table, &mirror, filter, sort, descending));
    for (uint32_t i = 0; i < table.count; i++)
        all = all * 100 + entities[table.row[i]].id;
    return all;
}

static void test_filters(void **state)
{
    (void)state;
    assert_int_equal(ids("", VEHICLE_TABLE_ID, false), 10203050); /* no shell */
    assert_int_equal(ids("red", VEHICLE_TABLE_ID, false), 2030);
    assert_int_equal(ids("  RED   tank ", VEHICLE_TABLE_ID, false), 30);
    assert_int_equal(ids("speed>10", VEHICLE_TABLE_ID, false), 1020);
    assert_int_equal(ids("speed<0.5 neutral", VEHICLE_TABLE_ID, false), 50);
    assert_int_equal(ids("20", VEHICLE_TABLE_ID, false), 20);
    assert_int_equal(ids("padre", VEHICLE_TABLE_ID, false), 30);
    assert_int_equal(ids("flight", VEHICLE_TABLE_ID, false), 40);
    assert_int_equal(ids("kind>3", VEHICLE_TABLE_ID, false), 0);
    assert_int_equal(ids("speed>fast", VEHICLE_TABLE_ID, false), 0);
    assert_int_equal(ids("submarine", VEHICLE_TABLE_ID, false), 0);
}

static void test_orders(void **state)
{
    (void)state;
    assert_int_equal(ids("", VEHICLE_TABLE_ID, true), 50302010);
    assert_int_equal(ids("", VEHICLE_TABLE_SPEED, true), 20103050); /* equal ones by their ids */
    assert_int_equal(ids("", VEHICLE_TABLE_KIND, false), 20501030);
    assert_int_equal(ids("", VEHICLE_TABLE_ROUNDS, false), 50302010);
}

static void test_lines_fit_a_terminal(void **state)
{
    char line[VEHICLE_TABLE_LINE_MAX];
    (void)state;
    for (int sort = 0; sort < VEHICLE_TABLE_COLUMNS; sort++) {
        vehicle_table_head(line, (enum vehicle_table_column)sort, true);
        assert_true(strlen(line) <= 81);
        assert_non_null(strchr(line, 'v'));
    }
    entities[0].x_m = entities[0].z_m = 50000.0;
    entities[0].fuel_l = 30000.0f;
    entities[0].rounds = UINT32_MAX;
    entities[0].behaviour = jolon_BEHAVIOUR_BACK_OFF;
    entities[0].damage = jolon_DAMAGE_DESTROYED;
    vehicle_table_line(line, &mirror, &entities[0]);
    assert_int_equal(strlen(line), 81); /* and the gap before its name */
}

static void test_choosing(void **state)
{
    (void)state;
    screen.page = SCREEN_STATE_VEHICLES;
    ids("", VEHICLE_TABLE_ID, false);
    screen_state_table(&screen, &table, &mirror, 2);
    screen_state_select(&screen, &table, &mirror,
                        screen_state_key(&screen, SCREEN_STATE_DOWN, SIDE_M));
    assert_int_equal(screen.selected, 10);
    screen_state_table(&screen, &table, &mirror, 2);
    screen_state_select(&screen, &table, &mirror,
                        screen_state_key(&screen, SCREEN_STATE_END, SIDE_M));
    assert_int_equal(screen.selected, 50);
    screen_state_table(&screen, &table, &mirror, 2);
    assert_int_equal(screen.first, 2); /* the last two rows */
    screen_state_select(&screen, &table, &mirror,
                        screen_state_key(&screen, SCREEN_STATE_UP, SIDE_M));
    assert_int_equal(screen.selected, 30);
    ids("blue", VEHICLE_TABLE_ID, false); /* the chosen one is no longer in it */
    screen_state_table(&screen, &table, &mirror, 2);
    assert_int_equal(screen.first, 0);
    screen_state_select(&screen, &table, &mirror, 1);
    assert_int_equal(screen.selected, 10);
}

static void test_typing_a_filter(void **state)
{
    (void)state;
    screen_state_key(&screen, '2', SIDE_M);
    assert_int_equal(screen.page, SCREEN_STATE_VEHICLES);
    screen_state_key(&screen, '/', SIDE_M);
    for (const char *key = "qx"; *key; key++)
        screen_state_key(&screen, *key, SIDE_M);
    assert_false(screen.quit);
    screen_state_key(&screen, SCREEN_STATE_BACKSPACE, SIDE_M);
    assert_string_equal(screen.filter[SCREEN_STATE_VEHICLES], "q");
    for (int i = 0; i < 200; i++)
        screen_state_key(&screen, 'a', SIDE_M);
    assert_int_equal(strlen(screen.filter[SCREEN_STATE_VEHICLES]), VEHICLE_TABLE_FILTER_MAX - 1);
    screen_state_key(&screen, SCREEN_STATE_ESCAPE, SIDE_M);
    assert_string_equal(screen.filter[SCREEN_STATE_VEHICLES], "");
    screen_state_key(&screen, 'q', SIDE_M);
    assert_true(screen.quit);
}

static void test_the_map_zooms_pans_and_follows(void **state)
{
    (void)state;
    screen.page = SCREEN_STATE_MAP;
    screen_state_key(&screen, '+', SIDE_M);
    screen_state_key(&screen, '+', SIDE_M);
    screen_state_key(&screen, SCREEN_STATE_LEFT, SIDE_M);
    struct character_map_area area = screen_state_area(&screen, &mirror, SIDE_M);
    assert_float_equal(area.across_m, 12500.0, 0.0);
    assert_float_equal(area.x, 25000.0 - 3125.0, 0.0);
    screen.selected = 30;
    screen_state_key(&screen, 'f', SIDE_M);
    area = screen_state_area(&screen, &mirror, SIDE_M);
    assert_float_equal(area.x, 2000.0, 0.0);
    assert_float_equal(area.z, 4000.0, 0.0);
    for (int i = 0; i < 30; i++)
        screen_state_key(&screen, SCREEN_STATE_UP,
                         SIDE_M); /* not beyond the edge, and no longer following */
    area = screen_state_area(&screen, &mirror, SIDE_M);
    assert_float_equal(area.z, 0.0, 0.0);
    for (int i = 0; i < 30; i++)
        screen_state_key(&screen, '+', SIDE_M);
    assert_int_equal(screen.zoom, SCREEN_STATE_ZOOM_MAX);
    screen_state_key(&screen, '0', SIDE_M);
    area = screen_state_area(&screen, &mirror, SIDE_M);
    assert_float_equal(area.x, 25000.0, 0.0);
    assert_float_equal(area.across_m, SIDE_M, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_filters, setup, teardown),
        cmocka_unit_test_setup_teardown(test_orders, setup, teardown),
        cmocka_unit_test_setup_teardown(test_lines_fit_a_terminal, setup, teardown),
        cmocka_unit_test_setup_teardown(test_choosing, setup, teardown),
        cmocka_unit_test_setup_teardown(test_typing_a_filter, setup, teardown),
        cmocka_unit_test_setup_teardown(test_the_map_zooms_pans_and_follows, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
