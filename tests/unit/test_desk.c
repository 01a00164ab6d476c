/* The monitor's table and desk: who is shown, in which order, and what keys do. */
#include "monitor/desk.c" /* the unit tests are not linked with the processes */
#include "monitor/table.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SIDE_M 50000.0

static jolon_Entity entities[5];
static struct mirror mirror;
static struct table table;
static struct desk desk;

const char *mirror_kind_name(const struct mirror *from, uint32_t kind)
{
    (void)from;
    return kind == 0 ? "tank" : kind == 1 ? "jeep" : "shell";
}

const char *names_of(const struct names *names, uint32_t id)
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
    mirror = (struct mirror){.has_batch = true, .batch = {.entity = entities, .count = 5}};
    desk_begin(&desk, SIDE_M);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    table_free(&table);
    return 0;
}

/* The ids in the table, as one number a digit pair: 10, 20 -> 1020. */
static uint64_t ids(const char *filter, enum table_column sort, bool descending)
{
    uint64_t all = 0;
    assert_true(table_build(&table, &mirror, filter, sort, descending));
    for (uint32_t i = 0; i < table.count; i++)
        all = all * 100 + entities[table.row[i]].id;
    return all;
}

static void test_filters(void **state)
{
    (void)state;
    assert_int_equal(ids("", TABLE_ID, false), 10203050); /* no shell */
    assert_int_equal(ids("red", TABLE_ID, false), 2030);
    assert_int_equal(ids("  RED   tank ", TABLE_ID, false), 30);
    assert_int_equal(ids("speed>10", TABLE_ID, false), 1020);
    assert_int_equal(ids("speed<0.5 neutral", TABLE_ID, false), 50);
    assert_int_equal(ids("20", TABLE_ID, false), 20);
    assert_int_equal(ids("padre", TABLE_ID, false), 30);
    assert_int_equal(ids("flight", TABLE_ID, false), 40);
    assert_int_equal(ids("kind>3", TABLE_ID, false), 0);
    assert_int_equal(ids("speed>fast", TABLE_ID, false), 0);
    assert_int_equal(ids("submarine", TABLE_ID, false), 0);
}

static void test_orders(void **state)
{
    (void)state;
    assert_int_equal(ids("", TABLE_ID, true), 50302010);
    assert_int_equal(ids("", TABLE_SPEED, true), 20103050); /* equal ones by their ids */
    assert_int_equal(ids("", TABLE_KIND, false), 20501030);
    assert_int_equal(ids("", TABLE_ROUNDS, false), 50302010);
}

static void test_lines_fit_a_terminal(void **state)
{
    char line[TABLE_LINE_MAX];
    (void)state;
    for (int sort = 0; sort < TABLE_COLUMNS; sort++) {
        table_head(line, (enum table_column)sort, true);
        assert_true(strlen(line) <= 81);
        assert_non_null(strchr(line, 'v'));
    }
    entities[0].x_m = entities[0].z_m = 50000.0;
    entities[0].fuel_l = 30000.0f;
    entities[0].rounds = UINT32_MAX;
    entities[0].behaviour = jolon_BEHAVIOUR_BACK_OFF;
    entities[0].damage = jolon_DAMAGE_DESTROYED;
    table_line(line, &mirror, &entities[0]);
    assert_int_equal(strlen(line), 81); /* and the gap before its name */
}

static void test_choosing(void **state)
{
    (void)state;
    desk.page = DESK_VEHICLES;
    ids("", TABLE_ID, false);
    desk_table(&desk, &table, &mirror, 2);
    desk_choose(&desk, &table, &mirror, desk_key(&desk, DESK_DOWN, SIDE_M));
    assert_int_equal(desk.chosen, 10);
    desk_table(&desk, &table, &mirror, 2);
    desk_choose(&desk, &table, &mirror, desk_key(&desk, DESK_END, SIDE_M));
    assert_int_equal(desk.chosen, 50);
    desk_table(&desk, &table, &mirror, 2);
    assert_int_equal(desk.first, 2); /* the last two rows */
    desk_choose(&desk, &table, &mirror, desk_key(&desk, DESK_UP, SIDE_M));
    assert_int_equal(desk.chosen, 30);
    ids("blue", TABLE_ID, false); /* the chosen one is no longer in it */
    desk_table(&desk, &table, &mirror, 2);
    assert_int_equal(desk.first, 0);
    desk_choose(&desk, &table, &mirror, 1);
    assert_int_equal(desk.chosen, 10);
}

static void test_typing_a_filter(void **state)
{
    (void)state;
    desk_key(&desk, '2', SIDE_M);
    assert_int_equal(desk.page, DESK_VEHICLES);
    desk_key(&desk, '/', SIDE_M);
    for (const char *key = "qx"; *key; key++)
        desk_key(&desk, *key, SIDE_M);
    assert_false(desk.quit);
    desk_key(&desk, DESK_BACKSPACE, SIDE_M);
    assert_string_equal(desk.filter[DESK_VEHICLES], "q");
    for (int i = 0; i < 200; i++)
        desk_key(&desk, 'a', SIDE_M);
    assert_int_equal(strlen(desk.filter[DESK_VEHICLES]), TABLE_FILTER_MAX - 1);
    desk_key(&desk, DESK_ESCAPE, SIDE_M);
    assert_string_equal(desk.filter[DESK_VEHICLES], "");
    desk_key(&desk, 'q', SIDE_M);
    assert_true(desk.quit);
}

static void test_the_map_zooms_pans_and_follows(void **state)
{
    (void)state;
    desk.page = DESK_MAP;
    desk_key(&desk, '+', SIDE_M);
    desk_key(&desk, '+', SIDE_M);
    desk_key(&desk, DESK_LEFT, SIDE_M);
    struct map_area area = desk_area(&desk, &mirror, SIDE_M);
    assert_float_equal(area.across_m, 12500.0, 0.0);
    assert_float_equal(area.x, 25000.0 - 3125.0, 0.0);
    desk.chosen = 30;
    desk_key(&desk, 'f', SIDE_M);
    area = desk_area(&desk, &mirror, SIDE_M);
    assert_float_equal(area.x, 2000.0, 0.0);
    assert_float_equal(area.z, 4000.0, 0.0);
    for (int i = 0; i < 30; i++)
        desk_key(&desk, DESK_UP, SIDE_M); /* not beyond the edge, and no longer following */
    area = desk_area(&desk, &mirror, SIDE_M);
    assert_float_equal(area.z, 0.0, 0.0);
    for (int i = 0; i < 30; i++)
        desk_key(&desk, '+', SIDE_M);
    assert_int_equal(desk.zoom, DESK_ZOOM_MAX);
    desk_key(&desk, '0', SIDE_M);
    area = desk_area(&desk, &mirror, SIDE_M);
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
