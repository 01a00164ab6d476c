/* Which vehicles begin to cruise, and what a stretch is. */
#include "mover/context/cruise_start.h"
#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/entity/table_write.h"
#include "world/cruise_pose.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define FRAMES 30u /* of a stretch */

static struct fixture f;
static uint32_t tank;

static uint32_t put(const char *kind, double x, enum behaviour behaviour)
{
    return fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                   .at = {x, FIXTURE_GROUND_M, 25000.0},
                                                   .velocity = {0.0, 0.0, -9.0},
                                                   .behaviour = behaviour});
}

static void open_with(const char *text)
{
    fixture_open(&f, text);
    tank = put("tank", 25000.0, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    e.row[tank].goal_x = 25000.0;
    e.row[tank].goal_z = 20000.0;
    e.row[tank].throttle = 0.75f;
}

static int open_world(void **state)
{
    (void)state;
    open_with("world = { cruise = true; };");
    return 0;
}

static bool cruises(uint32_t row)
{
    const struct state state = fixture_state(&f);
    return cruise_goes(&state.entities, row, state.head->tick);
}

/* Runs until the row cruises; false if it does not within three stretches. */
static bool begins(uint32_t row)
{
    for (uint32_t i = 0; i < 3 * FRAMES; i++) {
        fixture_run(&f, 1);
        if (cruises(row))
            return true;
    }
    return false;
}

/* Before its group has its turn it begins by a shorter stretch, which ends there. */
static void test_a_vehicle_on_its_way_cruises_for_half_a_second(void **state)
{
    (void)state;
    assert_true(begins(tank));
    struct state first = fixture_state(&f);
    uint32_t left = first.entities.row[tank].cruise_tick - (uint32_t)first.head->tick + 1;
    assert_true(left == FRAMES || left == 20 || left == 10);
    if (left < FRAMES)
        fixture_run(&f, left);
    struct state begun = fixture_state(&f);
    uint64_t tick = begun.head->tick;
    struct entities e = begun.entities;
    double x = e.row[tank].x, z = e.row[tank].z, fuel = e.row[tank].fuel_l;
    assert_int_equal(e.row[tank].cruise_tick, tick - 1 + FRAMES);
    for (uint32_t i = 1; i < FRAMES - 1; i++) { /* nothing writes to its row */
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_true(e.row[tank].x == x && e.row[tank].z == z && e.row[tank].fuel_l == fuel);
    }
    assert_true(cruises(tank));
    fixture_run(&f, 1);
    assert_false(cruises(tank));
    fixture_run(&f, 1); /* and the next stretch begins */
    assert_true(cruises(tank));
    assert_true(steps_rows(&f).row[tank].z < z - 4.0);
}

/* The stretch is the motion of the frames that it stands for. */
static void test_a_stretch_is_the_motion_of_its_frames(void **state)
{
    (void)state;
    assert_true(begins(tank));
    fixture_run(&f, 4 * FRAMES);
    struct state now = fixture_state(&f);
    uint64_t frame = now.head->frame;
    struct vec3 at = cruise_position(&now.entities, tank, now.head->tick, 1.0 / 60.0);
    double heading = cruise_heading(&now.entities, tank, now.head->tick, 1.0 / 60.0);
    fixture_close(&f);
    open_with("");
    fixture_run(&f, (uint32_t)frame);
    struct entities e = steps_rows(&f);
    assert_true(fabs(at.x - e.row[tank].x) < 0.05 && fabs(at.z - e.row[tank].z) < 0.3);
    assert_true(fabs(maths_wrap_half(heading - e.row[tank].heading)) < 0.01);
}

/* It does not wait for the next turn of its group. */
static void test_one_whose_stretch_has_ended_tries_again(void **state)
{
    (void)state;
    assert_true(begins(tank));
    fixture_run(&f, FRAMES);
    uint32_t moved = 0;
    struct entities e = steps_rows(&f);
    struct state now = fixture_state(&f);
    static uint64_t written[ROW_BLOCK_WORDS];
    const struct table_writer writer = {&e, NULL, written};
    assert_true(
        cruise_pose_end(&writer, &f.view.world, NULL, tank, now.head->tick, now.head->tick));
    for (; !cruises(tank) && moved < FRAMES; moved++)
        fixture_run(&f, 1);
    assert_in_range(moved, 1, 10);
    now = fixture_state(&f);
    assert_int_equal((now.entities.row[tank].cruise_tick + 1 - now.head->tick) % 10, 0);
}

/* One whose stretch was made shorter does not wait when it ends. */
static void test_one_whose_stretch_ends_by_itself_begins_anew(void **state)
{
    (void)state;
    assert_true(begins(tank));
    fixture_run(&f, FRAMES + 3);
    struct entities e = steps_rows(&f);
    const uint64_t tick = fixture_state(&f).head->tick;
    static uint64_t written[ROW_BLOCK_WORDS];
    const struct table_writer writer = {&e, NULL, written};
    assert_true(cruises(tank));
    assert_true(cruise_pose_end(&writer, &f.view.world, NULL, tank, tick + 6, tick));
    fixture_run(&f, 6);
    assert_false(cruises(tank));
    fixture_run(&f, 1);
    assert_true(cruises(tank));
}

static void test_without_the_key_nothing_cruises(void **state)
{
    (void)state;
    fixture_close(&f);
    open_with("");
    assert_false(begins(tank));
}

static void test_long_frames_have_no_stretches(void **state)
{
    (void)state;
    fixture_close(&f);
    open_with("world = { cruise = true; hz = 2.0; };");
    assert_false(begins(tank));
}

static void test_what_stands_fights_or_is_driven_does_not(void **state)
{
    (void)state;
    uint32_t held = put("tank", 25100.0, BEHAVIOUR_HOLD),
             idle = put("tank", 25200.0, BEHAVIOUR_IDLE);
    struct command drive = {.source = 1, .type = COMMAND_DRIVE, .entity = tank + 1};
    drive.value[0] = 0.5;
    steps_send(&f, RING_CLIENTS, drive);
    for (uint32_t i = 0; i < 3 * FRAMES; i++) {
        fixture_run(&f, 1);
        assert_false(cruises(held) || cruises(idle) || cruises(tank));
    }
}

/* A command for a vehicle that cruises takes effect in its frame. */
static void test_a_command_ends_the_stretch(void **state)
{
    (void)state;
    assert_true(begins(tank));
    fixture_run(&f, 5);
    struct state now = fixture_state(&f);
    struct vec3 at = cruise_position(&now.entities, tank, now.head->tick, 1.0 / 60.0);
    struct command drive = {.source = 1, .type = COMMAND_DRIVE, .entity = tank + 1};
    drive.value[5] = 1.0;
    steps_send(&f, RING_CLIENTS, drive);
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_false(cruises(tank));
    assert_int_equal(e.row[tank].behaviour, BEHAVIOUR_DRIVEN);
    assert_true(e.row[tank].z < at.z &&
                e.row[tank].z > at.z + 1.1 * now.entities.row[tank].vz / 60.0);
}

/* What comes into the way of a stretch ends it, in the frame in which it is there. */
static void test_what_comes_into_its_way_ends_it(void **state)
{
    (void)state;
    assert_true(begins(tank));
    fixture_run(&f, 3);
    struct command spawn = {.source = 1, .type = COMMAND_SPAWN, .kind = fixture_kind(&f, "truck")};
    spawn.value[0] = steps_rows(&f).row[tank].x;
    spawn.value[1] = steps_rows(&f).row[tank].z - 5.0;
    steps_send(&f, RING_CLIENTS, spawn);
    assert_true(steps_rows(&f).row[tank].cruise_tick > fixture_state(&f).head->tick + 10);
    fixture_run(&f, 1);
    assert_false(cruises(tank));
}

static void test_what_is_in_the_way_lets_none_begin(void **state)
{
    (void)state;
    uint32_t stands = put("truck", 25003.5, BEHAVIOUR_HOLD); /* beside it: no collision */
    struct entities e = steps_rows(&f);
    e.row[stands].vz = 0.0;
    e.row[tank].vz = e.row[tank].throttle = 0.0f;
    e.row[tank].flags |= ENTITY_FLAG_HOLD_FIRE;
    for (uint32_t i = 0; i < FRAMES; i++) {
        fixture_run(&f, 1);
        e = steps_rows(&f);
        assert_false(cruises(tank) && e.row[tank].z > 24996.0);
    }
}

/* One that goes around something decides as often as without stretches, and cruises in between. */
static void test_one_that_avoids_something_cruises_until_it_decides(void **state)
{
    uint32_t dodges = 0, went = 0;
    (void)state;
    fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                            .at = {25000.0, FIXTURE_GROUND_M, 24930.0},
                                            .behaviour = BEHAVIOUR_HOLD});
    for (uint32_t i = 0; i < 6 * FRAMES; i++) {
        fixture_run(&f, 1);
        struct state now = fixture_state(&f);
        if (now.entities.row[tank].dodge == 0.0f)
            continue;
        dodges++;
        if (!cruise_goes(&now.entities, tank, now.head->tick))
            continue;
        went++;
        assert_in_range(now.entities.row[tank].cruise_tick - now.head->tick, 1, 5);
    }
    assert_true(dodges > 2 * FRAMES);
    assert_true(went > dodges / 2);
}

#define IN_WORLD(test)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)

/* --- turns ------------------------------------------------------------------------------------*/

/* Returns for how many of its first frames a helicopter cruises that gains speed. */
static uint32_t cruised_of_helicopter(uint32_t decides_every)
{
    uint32_t cruised = 0;
    fixture_close(&f);
    open_with("world = { cruise = true; };");
    f.stepper.mover.decides_every = decides_every;
    uint32_t row = put("helicopter", 26000.0, BEHAVIOUR_PATROL);
    struct entities e = steps_rows(&f);
    e.row[row].y += 80.0;
    e.row[row].vz = 0.0;
    e.row[row].goal_x = 26000.0;
    e.row[row].goal_z = 20000.0;
    e.row[row].throttle = 0.75f;
    for (uint32_t i = 0; i < 8 * FRAMES; i++) {
        fixture_run(&f, 1);
        cruised += cruises(row);
    }
    return cruised;
}

/* Elsewhere it looks out in each of its turns instead. */
static void test_in_a_crowd_aircraft_cruise_for_less_than_half_a_second(void **state)
{
    (void)state;
    uint32_t crowd = cruised_of_helicopter(FRAMES + 2), alone = cruised_of_helicopter(0);
    print_message("a helicopter that gains speed cruises for %u frames of %u in a crowd, else %u\n",
                  crowd, 8 * FRAMES, alone);
    assert_true(crowd > alone + FRAMES / 2);
}

static void test_groups_are_blocks_in_large_worlds(void **state)
{
    (void)state;
    assert_int_equal(1u << cruise_start_group_bits(1), 16);
    assert_int_equal(1u << cruise_start_group_bits(4096), 16);
    assert_int_equal(1u << cruise_start_group_bits(4097), 32);
    assert_int_equal(1u << cruise_start_group_bits(200000), CHECKSUM_ROWS);
    assert_int_equal(1u << cruise_start_group_bits(UINT32_MAX), CHECKSUM_ROWS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_WORLD(test_a_vehicle_on_its_way_cruises_for_half_a_second),
        IN_WORLD(test_a_stretch_is_the_motion_of_its_frames),
        IN_WORLD(test_one_whose_stretch_has_ended_tries_again),
        IN_WORLD(test_one_whose_stretch_ends_by_itself_begins_anew),
        IN_WORLD(test_without_the_key_nothing_cruises),
        IN_WORLD(test_long_frames_have_no_stretches),
        IN_WORLD(test_what_stands_fights_or_is_driven_does_not),
        IN_WORLD(test_a_command_ends_the_stretch),
        IN_WORLD(test_what_comes_into_its_way_ends_it),
        IN_WORLD(test_what_is_in_the_way_lets_none_begin),
        IN_WORLD(test_one_that_avoids_something_cruises_until_it_decides),
        IN_WORLD(test_in_a_crowd_aircraft_cruise_for_less_than_half_a_second),
        cmocka_unit_test(test_groups_are_blocks_in_large_worlds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
