/* The statistics bar against the world table (row 13), and its warnings and alarms. */
#include "renderer/chart/statistics_bar.h"

#include "tests/support/map_stage.h"
#include "world/enum_names.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct statistics_bar_field *find(const struct statistics_bar_field *fields,
                                               uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, name) == 0)
            return &fields[i];
    fail_msg("there is no %s", name);
    return fields;
}

/* Returns the number that a field shows. */
static double number(const struct statistics_bar_field *fields, uint32_t count, const char *name)
{
    return strtod(find(fields, count, name)->value, NULL);
}

static void test_fields_equal_the_table(void **context)
{
    (void)context;
    struct map_stage stage;
    uint64_t seed = fixture_seed(13);
    map_stage_open(&stage, seed);
    struct entities *e = &stage.state.entities;
    for (uint32_t i = 0; i < 500; i++) {
        uint32_t slot = (uint32_t)fixture_uniform(&seed, 0.0, stage.state.head->used);
        const struct kind *kind = &stage.frame_view.world->kinds[e->row[slot].kind];
        e->row[slot].vx = fixture_uniform(&seed, -100.0, 100.0);
        e->row[slot].vz = fixture_uniform(&seed, -100.0, 100.0);
        e->row[slot].pitch = fixture_uniform(&seed, -1.5, 1.5);
        e->row[slot].roll = fixture_uniform(&seed, -1.5, 1.5);
        e->row[slot].y = fixture_uniform(&seed, -10.0, 2000.0);
        e->row[slot].rounds = (uint32_t)fixture_uniform(&seed, 0.0, 60.0);
        e->row[slot].fuel_l = fixture_uniform(&seed, 0.0, kind->fuel_l);
        e->row[slot].damage = (uint8_t)fixture_uniform(&seed, 0.0, DAMAGE_COUNT);
        e->row[slot].behaviour = (uint8_t)fixture_uniform(&seed, 0.0, BEHAVIOUR_COUNT);
        stage.state.head->frame = i;
        stage.state.head->tick = i;
        struct statistics s;
        struct statistics_bar_field fields[STATISTICS_BAR_MAX];
        statistics_of(&s, &stage.frame_view, slot);
        uint32_t n = statistics_bar_of(fields, &s, 59.94);
        double full = kind->fuel_l > 0.0 ? 100.0 * e->row[slot].fuel_l / kind->fuel_l : 100.0;
        double speed = 3.6 * hypot(e->row[slot].vx, e->row[slot].vz),
               turn = 180.0 / 3.14159265358979;
        assert_true(fabs(number(fields, n, "SPEED km/h") - speed) <= 0.0501);
        assert_true(fabs(remainder(number(fields, n, "HEADING") - e->row[slot].heading * turn,
                                   360.0)) <= 0.0501);
        assert_true(fabs(number(fields, n, "PITCH") - e->row[slot].pitch * turn) <= 0.0501);
        assert_true(fabs(number(fields, n, "ROLL") - e->row[slot].roll * turn) <= 0.0501);
        assert_true(fabs(number(fields, n, "ALTITUDE m") - e->row[slot].y) <= 0.501);
        assert_true(number(fields, n, "ROUNDS") == e->row[slot].rounds);
        assert_true(fabs(number(fields, n, "FUEL") - full) <= 0.501);
        assert_string_equal(find(fields, n, "DAMAGE")->value,
                            damage_name((enum damage)e->row[slot].damage));
        assert_string_equal(find(fields, n, "BEHAVIOUR")->value,
                            behaviour_name((enum behaviour)e->row[slot].behaviour));
        assert_true(fabs(number(fields, n, "TIME s") - i * world_dt_s(stage.frame_view.world)) <=
                    0.00501);
        assert_true(number(fields, n, "FRAME") == i);
        assert_string_equal(find(fields, n, "FPS")->value, "59.9");
    }
    map_stage_close(&stage);
}

static uint32_t state_of(const struct statistics *s, const char *name)
{
    struct statistics_bar_field fields[STATISTICS_BAR_MAX];
    uint32_t n = statistics_bar_of(fields, s, 0.0);
    return find(fields, n, name)->state;
}

static void test_alarms(void **context)
{
    (void)context;
    struct statistics s = {
        .damage = "none", .behaviour = "hold", .fuel_share = 1.0, .rounds = 50, .rounds_full = 50};
    static const char *const all[] = {"FUEL", "ROUNDS", "DAMAGE", "PITCH", "ROLL"};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        assert_int_equal(state_of(&s, all[i]), STATISTICS_BAR_GOOD);
    s.fuel_share = 0.2;
    assert_int_equal(state_of(&s, "FUEL"), STATISTICS_BAR_WARNING);
    s.fuel_share = 0.05;
    assert_int_equal(state_of(&s, "FUEL"), STATISTICS_BAR_ALARM);
    s.rounds = 9;
    assert_int_equal(state_of(&s, "ROUNDS"), STATISTICS_BAR_WARNING);
    s.rounds = 0;
    assert_int_equal(state_of(&s, "ROUNDS"), STATISTICS_BAR_ALARM);
    s.rounds_full = 0; /* its kind carries none */
    assert_int_equal(state_of(&s, "ROUNDS"), STATISTICS_BAR_GOOD);
    s.damage = "low";
    assert_int_equal(state_of(&s, "DAMAGE"), STATISTICS_BAR_WARNING);
    s.damage = "destroyed";
    assert_int_equal(state_of(&s, "DAMAGE"), STATISTICS_BAR_ALARM);
    s.pitch_deg = -30.0;
    assert_int_equal(state_of(&s, "PITCH"), STATISTICS_BAR_WARNING);
    s.roll_deg = 80.0;
    assert_int_equal(state_of(&s, "ROLL"), STATISTICS_BAR_ALARM);
}

static void test_what_is_not_known_is_left_out(void **context)
{
    (void)context;
    struct statistics s = {.damage = "none", .behaviour = "hold", .roll_deg = -0.01};
    struct statistics_bar_field fields[STATISTICS_BAR_MAX];
    uint32_t n = statistics_bar_of(fields, &s, 0.0);
    for (uint32_t i = 0; i < n; i++)
        assert_string_not_equal(fields[i].name, "FPS");
    assert_string_equal(find(fields, n, "ROLL")->value, "+0.0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_equal_the_table),
        cmocka_unit_test(test_alarms),
        cmocka_unit_test(test_what_is_not_known_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
