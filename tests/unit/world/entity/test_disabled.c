/* What damage stops: tracks and wheels, turret and gun. */
#include "world/entity/disabled.h"

#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 20

static struct fixture f;

/* The vehicles of the first column stand 300 m from a truck of the enemy, and aim at it. */
static const struct {
    const char *kind;
    enum damage damage;
    uint8_t flags;
    bool drives, fires;
} cases[] = {
    {"tank", DAMAGE_NONE, 0, true, true},
    {"tank", DAMAGE_LOW, 0, true, true},
    {"tank", DAMAGE_MED, 0, false, true},
    {"tank", DAMAGE_HIGH, 0, false, false},
    {"tank", DAMAGE_HIGH, ENTITY_FLAG_DISARMED, true, false},
    {"carrier", DAMAGE_MED, 0, false, true},
    {"jeep", DAMAGE_HIGH, 0, true, true},
};

#define COUNT (sizeof cases / sizeof cases[0])

static void open_case(size_t n, enum behaviour behaviour)
{
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 20.0; };");
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = cases[n].kind,
                                                           .at = {25000.0, 100.0, 25000.0},
                                                           .force = FORCE_BLUE,
                                                           .behaviour = behaviour});
    uint32_t target = fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                              .at = {25300.0, 100.0, 25000.0},
                                                              .force = FORCE_RED,
                                                              .behaviour = BEHAVIOUR_HOLD});
    struct entities e = steps_rows(&f);
    e.row[row].damage = (uint8_t)cases[n].damage;
    e.row[row].flags = cases[n].flags;
    e.row[row].behaviour = (uint8_t)behaviour;
    e.row[row].order = BEHAVIOUR_IDLE;
    steps_target(&f, row, target);
}

static void test_what_a_driver_can_do(void **state)
{
    (void)state;
    for (size_t n = 0; n < COUNT; n++) {
        open_case(n, BEHAVIOUR_DRIVEN);
        struct entities e = steps_rows(&f);
        e.row[0].until_tick = UINT32_MAX;
        e.row[0].throttle = 1.0f;
        fixture_run(&f, 4 * HZ);
        e = steps_rows(&f);
        assert_true((steps_speed(&f, 0) > 2.0) == cases[n].drives);
        uint32_t rounds = e.row[0].rounds;
        steps_aim(&f, 0, 1);
        steps_command(&f, (struct command){.type = COMMAND_FIRE, .entity = 1, .target = 2});
        assert_true((steps_rows(&f).row[0].rounds < rounds) == cases[n].fires);
        fixture_close(&f);
    }
}

static void test_what_a_crew_can_do(void **state)
{
    (void)state;
    for (size_t n = 0; n < COUNT; n++) {
        open_case(n, BEHAVIOUR_ATTACK);
        struct entities e = steps_rows(&f);
        e.row[0].until_tick = UINT32_MAX;
        e.row[0].flags |= ENTITY_FLAG_STAND;
        e.row[0].goal_x = e.row[1].x;
        e.row[0].goal_z = e.row[1].z;
        fixture_run(&f, 30 * HZ);
        assert_true((fixture_event_count(&f, EVENT_FIRE) > 0) == cases[n].fires);
        fixture_close(&f);
    }
}

/* A crew whose tracks are gone stays where it is, whatever fires at it. */
static void test_a_crew_that_cannot_drive_does_not_flee(void **state)
{
    (void)state;
    for (int immobile = 0; immobile < 2; immobile++) {
        open_case(immobile ? 2 : 1, BEHAVIOUR_IDLE);
        steps_kind(&f, "tank")->courage = 0.0;
        struct entities e = steps_rows(&f);
        e.row[0].threat_slot = 1;
        e.row[0].threat_id = e.row[1].id;
        fixture_run(&f, 3 * HZ);
        assert_int_equal(steps_rows(&f).row[0].behaviour,
                         immobile ? BEHAVIOUR_IDLE : BEHAVIOUR_FLEE);
        assert_true((steps_speed(&f, 0) > 1.0) == !immobile);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_a_driver_can_do),
        cmocka_unit_test(test_what_a_crew_can_do),
        cmocka_unit_test(test_a_crew_that_cannot_drive_does_not_flee),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
