/* Constant course: vehicles hold it in all events. */
#include "tests/support/steps.h"
#include "world/terrain/crater.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double y, struct vec3 velocity)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {x, y, z}, .velocity = velocity});
}

static void test_hold_keeps_heading_and_speed_to_the_bit(void **state)
{
    steps_cover(&f, COVER_LAKE, 24000.0, 29000.0, 26000.0, 31000.0);
    uint32_t tank = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){11.0, 0.0, -7.0});
    uint32_t jet = put("jet", 20000.0, 25000.0, 900.0, (struct vec3){200.0, 3.0, 40.0});
    uint32_t ship = put("ship", 25000.0, 30000.0, 100.0, (struct vec3){-5.0, 0.0, 0.0});
    uint32_t rows[3] = {tank, jet, ship};
    double heading[3];
    (void)state;
    for (int n = 0; n < 3; n++)
        heading[n] = steps_rows(&f).row[rows[n]].heading;
    fixture_run(&f, 600);
    struct entities e = steps_rows(&f);
    for (int n = 0; n < 3; n++)
        assert_true(e.row[rows[n]].heading == heading[n]);
    assert_true(e.row[tank].vx == 11.0 && e.row[tank].vz == -7.0 && e.row[tank].vy == 0.0);
    assert_true(e.row[jet].vx == 200.0 && e.row[jet].vy == 3.0 && e.row[jet].vz == 40.0);
    assert_true(e.row[ship].vx == -5.0 && e.row[ship].vz == 0.0);
    assert_true(fabs(e.row[tank].x - 25110.0) < 1e-8 && fabs(e.row[tank].z - 24930.0) < 1e-8);
    assert_true(fabs(e.row[jet].x - 22000.0) < 1e-8 && fabs(e.row[jet].y - 930.0) < 1e-8);
}

static void test_hold_reacts_to_nothing(void **state)
{
    uint32_t row = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){10.0, 0.0, 0.0});
    uint32_t enemy = put("tank", 25100.0, 25300.0, 100.0, (struct vec3){0.0, 0.0, 0.0});
    struct entities e = steps_rows(&f);
    (void)state;
    e.row[row].force = FORCE_BLUE;
    e.row[enemy].force = FORCE_RED;
    e.row[row].flags = ENTITY_FLAG_FIRE_AT_WILL;
    e.row[row].threat_slot = enemy;
    e.row[row].threat_id = e.row[enemy].id;
    e.row[row].bumped = 1;
    e.row[row].fuel_l = 0.0;
    fixture_run(&f, 240);
    e = steps_rows(&f);
    assert_int_equal(e.row[row].behaviour, BEHAVIOUR_HOLD);
    assert_true(e.row[row].vx == 10.0 && fabs(e.row[row].x - 25040.0) < 1e-8);
    assert_true(e.row[row].threat_id == 0 && e.row[row].bumped == 0);
    assert_int_equal(fixture_event_count(&f, EVENT_NONE), 0);
}

static void test_hold_follows_the_ground_and_asks_nothing_of_it(void **state)
{
    (void)state;
    steps_plane(&f, 1.0, 0.0);                                   /* far too steep for a tank */
    steps_cover(&f, COVER_LAKE, 25060.0, 0.0, 50000.0, 50000.0); /* and then a lake */
    uint32_t row = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){10.0, 0.0, 0.0});
    for (int frame = 1; frame <= 600; frame++) {
        fixture_run(&f, 1);
        struct entities e = steps_rows(&f);
        assert_true(e.row[row].vx == 10.0);
        assert_true(e.row[row].y == steps_ground_at(&f, e.row[row].x, e.row[row].z));
        assert_true(fabs(e.row[row].vy - 10.0) < 1e-6 && fabs(e.row[row].pitch - PI / 4.0) < 1e-6);
    }
}

/* It keeps its speed up to the edge, and then it is gone. An event tells so. */
static void test_hold_leaves_the_world_at_its_edge(void **state)
{
    static const char *const kinds[] = {"jet", "helicopter", "ship", "jeep"};
    (void)state;
    for (uint32_t n = 0; n < 4; n++) {
        steps_empty(&f);
        steps_cover(&f, n == 2 ? COVER_LAKE : COVER_GRASS, 0.0, 24000.0, 1000.0, 26000.0);
        double y = n < 2 ? 900.0 : 100.0;
        uint32_t row = put(kinds[n], 40.0, 25000.0, y, (struct vec3){-50.0, 0.0, 0.0});
        uint32_t vehicles = fixture_state(&f).head->vehicles, frames = 0;
        while (steps_rows(&f).row[row].state != ENTITY_FREE && frames++ < 60) {
            assert_true(steps_rows(&f).row[row].vx == -50.0);
            fixture_run(&f, 1);
        }
        const struct event *event = fixture_event(&f, EVENT_AGENT, 0);
        assert_in_range(frames, 48, 49);
        assert_int_equal(fixture_state(&f).head->vehicles, vehicles - 1);
        assert_non_null(event);
        assert_int_equal(event->agent.because, REASON_LEFT_WORLD);
        assert_int_equal(event->agent.agent.id, row + 1);
        fixture_run(&f, 60);
        assert_int_equal(fixture_event_count(&f, EVENT_NONE), 1);
    }
}

/* A driven vehicle that is in the air, or leans on its springs, is told to hold its course. */
static void test_hold_begins_without_a_jump(void **state)
{
    double jump_m = 0.0, jump_mps = 0.0, jump_rad = 0.0;
    (void)state;
    uint32_t row = put("jeep", 25000.0, 25000.0, 100.25, (struct vec3){12.0, 0.0, 0.0});
    steps_rows(&f).row[row].behaviour = BEHAVIOUR_DRIVEN;
    for (uint32_t frame = 0; frame < 8; frame++)
        steps_drive(&f, row, 12.0 / 29.0, 0.5, 0.0);
    steps_rows(&f).row[row].behaviour = steps_rows(&f).row[row].order = BEHAVIOUR_HOLD;
    for (uint32_t frame = 0; frame < 1200; frame++) {
        struct entities e = steps_rows(&f);
        const struct vec3 at = entities_position(&e, row), v = entities_velocity(&e, row);
        double pitch = e.row[row].pitch, roll = e.row[row].roll;
        fixture_run(&f, 1);
        e = steps_rows(&f);
        struct vec3 way = vec3_sub(entities_position(&e, row), at),
                    after = entities_velocity(&e, row);
        double faster = vec3_length(vec3_sub(after, v));
        double off = vec3_length(vec3_sub(way, vec3_scale(vec3_add(v, after), 0.5 / 60.0)));
        jump_m = maths_max(jump_m, off);
        jump_mps = maths_max(jump_mps, faster);
        jump_rad =
            maths_max(jump_rad, fabs(e.row[row].pitch - pitch) + fabs(e.row[row].roll - roll));
    }
    struct entities e = steps_rows(&f);
    printf("hold after a drop: at most %.4f m, %.2f m/s, %.4f rad in a frame\n", jump_m, jump_mps,
           jump_rad);
    assert_true(jump_m < 0.01 && jump_mps < 1.0 && jump_rad < 0.02);
    assert_false(e.row[row].flags & ENTITY_FLAG_CHASSIS);
    assert_true(e.row[row].y == 100.0 && e.row[row].pitch == 0.0 && e.row[row].roll == 0.0);
    assert_true(steps_speed(&f, row) > 8.0);
}

/* Springs left a vehicle 5 cm deep in the rim of a crater, out of which the ground lifts it. */
static void test_hold_comes_out_of_the_ground_without_a_jump(void **state)
{
    (void)state;
    struct state now = fixture_state(&f);
    now.craters[0] = (struct crater){25006.0, 25000.0, 4.0f, 1.5f, 0};
    for (int buffer = 0; buffer < 2; buffer++)
        f.view.w[buffer].head->crater_count = 1;
    uint32_t row = put("tank", 25000.0, 25000.0, 100.0, (struct vec3){0.0, 0.0, 0.0});
    fixture_run(&f, 150); /* it is calm */
    const double stands_m = steps_rows(&f).row[row].y;
    assert_true(stands_m > 100.1);
    steps_rows(&f).row[row].y -= 0.05;
    steps_rows(&f).row[row].flags |= ENTITY_FLAG_CHASSIS;
    double most_m = 0.0, before_m = stands_m - 0.05;
    for (uint32_t frame = 0; frame < 120; frame++) {
        fixture_run(&f, 1);
        most_m = maths_max(most_m, steps_rows(&f).row[row].y - before_m);
        before_m = steps_rows(&f).row[row].y;
    }
    printf("at most %.3f mm in a frame\n", 1e3 * most_m);
    assert_true(most_m > 0.0 && most_m < 0.0015);
    assert_true(fabs(before_m - stands_m) < 1e-9);
    assert_false(steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_hold_keeps_heading_and_speed_to_the_bit),
        TEST(test_hold_reacts_to_nothing),
        TEST(test_hold_follows_the_ground_and_asks_nothing_of_it),
        TEST(test_hold_leaves_the_world_at_its_edge),
        TEST(test_hold_begins_without_a_jump),
        TEST(test_hold_comes_out_of_the_ground_without_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
