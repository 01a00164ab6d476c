/* Commands: every type and every answer. Each command is applied once and in order. */
#include "tests/support/steps.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define A_FRAME 256 /* commands that one ring gets through in one frame */

static struct fixture f;
static uint32_t tank, truck; /* rows 0 and 1, at rest */

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                   .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                   .force = FORCE_BLUE});
    truck = fixture_put(&f, (struct fixture_entity){.kind = "truck",
                                                    .at = {25500.0, FIXTURE_GROUND_M, 25000.0},
                                                    .force = FORCE_RED});
    return 0;
}

static enum command_result does(struct command command)
{
    return (enum command_result)steps_command(&f, command).result;
}

#define DOES(...) does((struct command){__VA_ARGS__})

static uint64_t tick(void)
{
    return fixture_state(&f).head->tick;
}

/* --- drive and release -------------------------------------------------------------------------*/

static void test_drive_takes_over_and_release_gives_back(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 2, .value = {0.5, -0.25, 1.0}),
                     COMMAND_DONE);
    struct entities e = steps_rows(&f);
    assert_int_equal(e.row[truck].behaviour, BEHAVIOUR_DRIVEN);
    assert_true(e.row[truck].throttle == 0.5f && e.row[truck].steer == -0.25f &&
                e.row[truck].climb == 1.0f);
    assert_true(steps_speed(&f, truck) > 0.0); /* in the same frame */
    const struct event *event = fixture_event(&f, EVENT_AGENT, 0);
    assert_int_equal(event->agent.because, REASON_COMMAND);
    assert_int_equal(event->agent.from, BEHAVIOUR_HOLD);
    assert_int_equal(event->agent.to, BEHAVIOUR_DRIVEN);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .entity = 2), COMMAND_DONE);
    assert_int_equal(steps_rows(&f).row[truck].behaviour, BEHAVIOUR_HOLD);
    assert_true(steps_rows(&f).row[truck].throttle == 0.0f);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .entity = 2), COMMAND_CANNOT);
}

static void test_drive_refuses_values_out_of_range_and_absent_vehicles(void **state)
{
    const double nan = (double)NAN;
    (void)state;
    for (int n = 0; n < 3; n++) {
        struct command command = {.type = COMMAND_DRIVE, .entity = 1};
        command.value[n] = 1.0000001;
        assert_int_equal(does(command), COMMAND_OUT_OF_RANGE);
        command.value[n] = nan;
        assert_int_equal(does(command), COMMAND_OUT_OF_RANGE);
        command.value[n] = -1.0;
        assert_int_equal(does(command), COMMAND_DONE);
    }
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 99), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 0), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .entity = 99), COMMAND_NO_SUCH_ENTITY);
    steps_rows(&f).row[truck].state = ENTITY_WRECK;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 2), COMMAND_CANNOT);
}

static void test_a_round_in_flight_takes_no_commands(void **state)
{
    uint32_t round = fixture_put(&f, (struct fixture_entity){.kind = "missile",
                                                             .at = {25000.0, 900.0, 25000.0},
                                                             .velocity = {100.0, 0.0, 0.0}});
    uint32_t id = steps_rows(&f).row[round].id;
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = id), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_REMOVE, .entity = id), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = id), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = id), COMMAND_NO_SUCH_ENTITY);
}

static void test_a_lease_keeps_others_out_and_ends(void **state)
{
    const struct command mine = {
        .type = COMMAND_DRIVE, .source = 7, .entity = 1, .amount = 10, .value = {0.5}};
    const struct command theirs = {.type = COMMAND_DRIVE, .source = 8, .entity = 1};
    (void)state;
    assert_int_equal(does(mine), COMMAND_DONE);
    assert_true(steps_rows(&f).row[tank].driver == 7);
    assert_int_equal(does(theirs), COMMAND_TAKEN);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .source = 8, .entity = 1), COMMAND_TAKEN);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .source = 8, .entity = 1), COMMAND_TAKEN);
    fixture_run(&f, 5);
    assert_int_equal(does(mine), COMMAND_DONE); /* renewed: ten more from here */
    fixture_run(&f, 10);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_DRIVEN);
    assert_int_equal(fixture_event_count(&f, EVENT_AGENT), 1);
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_HOLD);
    assert_true(steps_rows(&f).row[tank].driver == 0 && steps_rows(&f).row[tank].throttle == 0.0f);
    const struct event *event = fixture_event(&f, EVENT_AGENT, 1);
    assert_int_equal(event->agent.because, REASON_LEASE_OVER);
    assert_int_equal(does(theirs), COMMAND_DONE);
}

static void test_a_lease_is_kept_while_paused_and_ends_only_with_simulated_time(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .source = 7, .entity = 1, .amount = 5),
                     COMMAND_DONE);
    DOES(.type = COMMAND_PAUSE);
    fixture_run(&f, 50);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_DRIVEN);
    DOES(.type = COMMAND_RESUME);
    fixture_run(&f, 10);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_HOLD);
}

static void test_an_operator_releases_any_driver(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .source = 7, .entity = 1, .amount = 600),
                     COMMAND_DONE);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .source = 8, .entity = 1, .amount = 1),
                     COMMAND_DONE);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_HOLD);
    assert_true(steps_rows(&f).row[tank].driver == 0);
}

static void test_without_a_lease_anybody_drives_and_without_end(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .source = 7, .entity = 1), COMMAND_DONE);
    fixture_run(&f, 500);
    assert_int_equal(steps_rows(&f).row[tank].behaviour, BEHAVIOUR_DRIVEN);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .source = 8, .entity = 1, .amount = 60),
                     COMMAND_DONE); /* and now it is one's own */
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .source = 7, .entity = 1), COMMAND_TAKEN);
}

static void test_drive_sets_brake_gear_and_the_turrets_controls(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 1, .force = GEAR_LOW,
                          .value = {0.5, 0.0, 0.0, -1.0, 0.25, 0.75}),
                     COMMAND_DONE);
    struct entities e = steps_rows(&f);
    assert_int_equal(entity_gear(e.row[tank].flags), GEAR_LOW);
    assert_true(e.row[tank].brake == 0.75f && e.row[tank].traverse == -1.0f &&
                e.row[tank].elevate == 0.25f);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 1, .force = GEAR_COUNT),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 1, .value = {[5] = -0.1}),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 1, .amount = COMMAND_LEASE_MAX + 1),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_RELEASE, .entity = 1), COMMAND_DONE);
    e = steps_rows(&f);
    assert_int_equal(e.row[tank].flags & ~ENTITY_FLAG_CHASSIS, 0);
    assert_true(e.row[tank].brake == 0.0f && e.row[tank].traverse == 0.0f &&
                e.row[tank].elevate == 0.0f);
}

/* --- fire --------------------------------------------------------------------------------------*/

static void test_fire_answers(void **state)
{
    uint16_t bomb = fixture_kind(&f, "bomb"), wheels = fixture_kind(&f, "tank");
    uint16_t kinds = (uint16_t)f.view.world.counts.kinds;
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = 2), COMMAND_CANNOT);
    fixture_run(&f, 60 * 3); /* the gunner lays his gun: a quarter turn at 40 degrees a second */
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = 2), COMMAND_DONE);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = 2), COMMAND_CANNOT);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 2), COMMAND_CANNOT); /* unarmed */
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 99), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = 99), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = bomb, .value = {0.0, WORLD_SIDE_DEFAULT_M}),
                     COMMAND_DONE);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = bomb, .value = {-0.1, 10.0}),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = bomb, .value = {10.0, 50000.1}),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = wheels), COMMAND_NO_SUCH_KIND);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = kinds), COMMAND_NO_SUCH_KIND);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .kind = KIND_NONE), COMMAND_NO_SUCH_KIND);
}

static void test_no_vehicle_fires_at_itself(void **state)
{
    (void)state;
    assert_int_not_equal(DOES(.type = COMMAND_FIRE, .entity = 1, .target = 1), COMMAND_DONE);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
}

static void test_a_full_table_is_said_to_be_full(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 16; };");
    for (uint32_t n = 0; n < 16; n++)
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {24000.0 + 50.0 * n, 100.0, 25000.0}});
    uint16_t kind = fixture_kind(&f, "jeep");
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = kind, .value = {1.0, 1.0}),
                     COMMAND_TABLE_FULL);
    assert_int_equal(
        DOES(.type = COMMAND_FIRE, .kind = fixture_kind(&f, "bomb"), .value = {1.0, 1.0}),
        COMMAND_TABLE_FULL);
    assert_int_equal(DOES(.type = COMMAND_FIRE, .entity = 1), COMMAND_TABLE_FULL);
}

/* --- spawn and remove --------------------------------------------------------------------------*/

static void test_spawn_makes_what_was_asked_for(void **state)
{
    (void)state;
    struct event_command answer =
        steps_command(&f, (struct command){.type = COMMAND_SPAWN,
                                           .source = 7,
                                           .source_sequence = 42,
                                           .kind = fixture_kind(&f, "helicopter"),
                                           .force = FORCE_RED,
                                           .amount = BEHAVIOUR_HOLD,
                                           .value = {30000.0, 20000.0, 250.0, -HALF_PI, 30.0}});
    assert_int_equal(answer.result, COMMAND_DONE);
    assert_int_equal(answer.source, 7);
    assert_int_equal(answer.sequence, 42);
    assert_int_equal(answer.ring, RING_CLIENTS);
    uint32_t row = steps_find(&f, answer.entity);
    struct entities e = steps_rows(&f);
    assert_int_equal(row, 2);
    assert_true(e.row[row].x == 30000.0 && e.row[row].z == 20000.0 && e.row[row].y == 350.0);
    assert_true(fabs(e.row[row].vx + 30.0) < 1e-12 && fabs(e.row[row].vz) < 1e-12);
    assert_true(fabs(e.row[row].heading - 1.5 * PI) < 1e-12);
    assert_int_equal(e.row[row].force, FORCE_RED);
    assert_int_equal(e.row[row].behaviour, BEHAVIOUR_HOLD);
    assert_int_equal(e.row[row].state, ENTITY_ACTIVE);
    assert_int_equal(e.row[row].rounds, steps_kind(&f, "helicopter")->rounds);
    assert_int_equal(fixture_state(&f).head->vehicles, 3);
    fixture_run(&f, 1); /* it moves from the next frame on */
    assert_true(fabs(steps_rows(&f).row[row].x - (30000.0 - 0.5)) < 1e-9);
}

static double to_the_east(double x, double z, const void *context)
{
    (void)z;
    (void)context;
    return FIXTURE_GROUND_M + maths_clamp(x - 30000.0, 0.0, 300.0);
}

/* Unless it holds its course, a jet is spawned so high that it can climb over the slope ahead. */
static void test_spawn_puts_jets_over_what_is_ahead(void **state)
{
    static const enum behaviour behaviours[] = {BEHAVIOUR_PATROL, BEHAVIOUR_HOLD};
    double over[2];
    (void)state;
    steps_ground(&f, to_the_east, NULL);
    for (int n = 0; n < 2; n++) {
        struct event_command answer =
            steps_command(&f, (struct command){.type = COMMAND_SPAWN,
                                               .kind = fixture_kind(&f, "jet"),
                                               .amount = (uint32_t)behaviours[n],
                                               .value = {30000.0, 20000.0, 80.0, HALF_PI, 70.0}});
        assert_int_equal(answer.result, COMMAND_DONE);
        over[n] = steps_rows(&f).row[steps_find(&f, answer.entity)].y - FIXTURE_GROUND_M;
    }
    assert_true(over[0] > 200.0 && over[1] == 80.0);
}

static void test_spawn_refuses_what_is_out_of_range(void **state)
{
    uint16_t kind = fixture_kind(&f, "helicopter");
    static const double low[5] = {0.0, 0.0, 0.0, -TWO_PI, 0.0};
    static const double high[5] = {WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M, 20000.0, TWO_PI,
                                   10000.0};
    (void)state;
    for (int n = 0; n < 5; n++) {
        struct command command = {.type = COMMAND_SPAWN, .kind = kind, .value = {100.0, 100.0}};
        command.value[n] = low[n] - 0.001;
        assert_int_equal(does(command), COMMAND_OUT_OF_RANGE);
        command.value[n] = high[n] + 0.001;
        assert_int_equal(does(command), COMMAND_OUT_OF_RANGE);
        command.value[n] = (double)NAN;
        assert_int_equal(does(command), COMMAND_OUT_OF_RANGE);
        command.value[n] = high[n];
        assert_int_equal(does(command), COMMAND_DONE);
    }
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = kind, .force = FORCE_COUNT),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = kind, .amount = BEHAVIOUR_ROUTE),
                     COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = fixture_kind(&f, "tree")),
                     COMMAND_NO_SUCH_KIND);
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = fixture_kind(&f, "shell")),
                     COMMAND_NO_SUCH_KIND);
    assert_int_equal(DOES(.type = COMMAND_SPAWN, .kind = KIND_NONE), COMMAND_NO_SUCH_KIND);
}

static void test_remove_frees_the_row_and_its_id_is_gone(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_REMOVE, .entity = 2), COMMAND_DONE);
    assert_int_equal(steps_rows(&f).row[truck].state, ENTITY_FREE);
    assert_int_equal(fixture_state(&f).head->vehicles, 1);
    assert_int_equal(DOES(.type = COMMAND_REMOVE, .entity = 2), COMMAND_NO_SUCH_ENTITY);
    assert_int_equal(DOES(.type = COMMAND_DRIVE, .entity = 2), COMMAND_NO_SUCH_ENTITY);
}

/* --- time --------------------------------------------------------------------------------------*/

static void test_paused_frames_do_not_advance_time(void **state)
{
    uint32_t jet = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 900.0, 25000.0},
                                                           .velocity = {240.0, 0.0, 0.0}});
    (void)state;
    fixture_run(&f, 5);
    assert_int_equal(DOES(.type = COMMAND_PAUSE), COMMAND_DONE);
    double x = steps_rows(&f).row[jet].x;
    assert_int_equal(tick(), 5); /* the frame that pauses stands already */
    fixture_run(&f, 10);
    assert_int_equal(tick(), 5);
    assert_int_equal(fixture_state(&f).head->frame, 16);
    assert_int_equal(fixture_state(&f).head->advanced, 0);
    assert_true(steps_rows(&f).row[jet].x == x);
    assert_int_equal(DOES(.type = COMMAND_RESUME), COMMAND_DONE);
    assert_int_equal(tick(), 6);
    assert_int_equal(fixture_state(&f).head->advanced, 1);
    assert_true(fabs(steps_rows(&f).row[jet].x - (x + 4.0)) < 1e-9);
}

static void test_step_advances_just_so_many_frames(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_STEP, .amount = 1), COMMAND_CANNOT); /* it runs */
    assert_int_equal(DOES(.type = COMMAND_PAUSE), COMMAND_DONE);
    uint64_t before = tick();
    assert_int_equal(DOES(.type = COMMAND_STEP, .amount = 0), COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_STEP, .amount = 1000001), COMMAND_OUT_OF_RANGE);
    assert_int_equal(tick(), before);
    assert_int_equal(DOES(.type = COMMAND_STEP, .amount = 3), COMMAND_DONE);
    assert_int_equal(tick(), before + 1); /* at once */
    fixture_run(&f, 10);
    assert_int_equal(tick(), before + 3);
    assert_int_equal(fixture_state(&f).head->steps_left, 0);
    steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_STEP, .amount = 2});
    steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_STEP, .amount = 2});
    fixture_run(&f, 10);
    assert_int_equal(tick(), before + 7); /* they add up */
}

static void test_pausing_again_drops_the_steps_that_are_left(void **state)
{
    (void)state;
    DOES(.type = COMMAND_PAUSE);
    uint64_t before = tick();
    DOES(.type = COMMAND_STEP, .amount = 100);
    DOES(.type = COMMAND_PAUSE);
    fixture_run(&f, 5);
    assert_int_equal(tick(), before + 1);
}

static void test_steps_do_not_overflow(void **state)
{
    (void)state;
    DOES(.type = COMMAND_PAUSE);
    for (int n = 0; n < 4300; n++) { /* 4,295 times 1,000,000 is past 32 bits */
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_STEP, .amount = 1000000});
        if (n % A_FRAME == A_FRAME - 1)
            fixture_run(&f, 1);
    }
    fixture_run(&f, 1);
    assert_true(fixture_state(&f).head->steps_left > 4000000000u);
}

static void test_scale_and_quit_are_kept_in_the_head(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_SCALE, .value = {4.0}), COMMAND_DONE);
    assert_true(fixture_state(&f).head->time_scale == 4.0);
    assert_int_equal(DOES(.type = COMMAND_SCALE, .value = {0.009}), COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_SCALE, .value = {100.1}), COMMAND_OUT_OF_RANGE);
    assert_int_equal(DOES(.type = COMMAND_SCALE, .value = {(double)NAN}), COMMAND_OUT_OF_RANGE);
    assert_true(fixture_state(&f).head->time_scale == 4.0);
    assert_int_equal(DOES(.type = COMMAND_QUIT), COMMAND_DONE);
    assert_int_equal(fixture_state(&f).head->quit, 1);
}

static void test_what_is_no_type_is_unknown(void **state)
{
    (void)state;
    assert_int_equal(DOES(.type = COMMAND_NONE), COMMAND_UNKNOWN);
    assert_int_equal(DOES(.type = COMMAND_TYPE_COUNT), COMMAND_UNKNOWN);
    assert_int_equal(DOES(.type = UINT32_MAX), COMMAND_UNKNOWN);
}

static void test_commands_are_applied_while_paused(void **state)
{
    (void)state;
    DOES(.type = COMMAND_PAUSE);
    assert_int_equal(
        DOES(.type = COMMAND_SPAWN, .kind = fixture_kind(&f, "jeep"), .value = {100.0, 100.0}),
        COMMAND_DONE);
    assert_int_equal(DOES(.type = COMMAND_REMOVE, .entity = 2), COMMAND_DONE);
    assert_int_equal(fixture_state(&f).head->vehicles, 2);
}

/* --- once, in order ----------------------------------------------------------------------------*/

static void test_each_command_is_applied_exactly_once_in_its_rings_order(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 700; n++)
        steps_send(&f, RING_CLIENTS,
                   (struct command){.type = COMMAND_NONE, .source = 1, .source_sequence = n + 1});
    for (uint32_t n = 0; n < 40; n++)
        steps_send(&f, RING_RECORDER,
                   (struct command){.type = COMMAND_NONE, .source = 2, .source_sequence = n + 1});
    fixture_run(&f, 1);
    struct state now = fixture_state(&f);
    assert_int_equal(now.head->command_cursor[RING_CLIENTS], A_FRAME);
    assert_int_equal(now.head->command_cursor[RING_RECORDER], 40);
    assert_int_equal(now.head->tally.commands, A_FRAME + 40);
    fixture_run(&f, 5);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_CLIENTS], 700);
    assert_int_equal(fixture_event_count(&f, EVENT_COMMAND), 740);
    uint64_t next[3] = {0, 1, 1};
    for (uint32_t n = 0; n < 740; n++) {
        const struct event *event = fixture_event(&f, EVENT_COMMAND, n);
        assert_int_equal(event->command.sequence, next[event->command.source]++);
        assert_int_equal(event->command.ring,
                         event->command.source == 1 ? RING_CLIENTS : RING_RECORDER);
    }
}

static void test_commands_wait_while_a_frame_has_no_room_for_answers(void **state)
{
    (void)state;
    steps_params(&f)->intents_per_frame = 11;
    for (int n = 0; n < 30; n++)
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_NONE});
    fixture_run(&f, 1);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_CLIENTS], 10);
    fixture_run(&f, 2);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_CLIENTS], 30);
    assert_int_equal(fixture_event_count(&f, EVENT_COMMAND), 30);
}

static void test_and_while_it_has_no_room_for_events(void **state)
{
    (void)state;
    steps_params(&f)->events_per_frame = 5;
    for (int n = 0; n < 30; n++)
        steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_NONE});
    fixture_run(&f, 1);
    assert_int_equal(fixture_event_count(&f, EVENT_COMMAND), 4);
    fixture_run(&f, 7);
    assert_int_equal(fixture_event_count(&f, EVENT_COMMAND), 30);
    assert_int_equal(fixture_state(&f).head->tally.events_dropped, 0);
}

static void test_an_answer_carries_the_whole_command(void **state)
{
    const uint64_t odd = 0x7ff8dead0000beefu; /* a NaN that can be distinguished from others */
    struct command command = {.source = UINT64_MAX,
                              .source_sequence = UINT64_MAX - 1,
                              .type = 65536 + COMMAND_PAUSE, /* no type in any width */
                              .entity = 3000000000u,
                              .target = 4000000000u,
                              .amount = UINT32_MAX,
                              .kind = 65535,
                              .force = 65534,
                              .value = {0.1, -0.0, 1e-310, -1e308, 0.0, 3.0}};
    (void)state;
    memcpy(&command.value[4], &odd, sizeof odd);
    for (uint32_t number = 0; number < 3; number++) {
        struct event_command answer = steps_command(&f, command);
        assert_int_equal(answer.source, command.source);
        assert_int_equal(answer.sequence, command.source_sequence);
        assert_int_equal(answer.given, command.entity);
        assert_int_equal(answer.target, command.target);
        assert_int_equal(answer.amount, command.amount);
        assert_int_equal(answer.kind, command.kind);
        assert_int_equal(answer.force, command.force);
        assert_memory_equal(answer.value, command.value, sizeof command.value);
        assert_int_equal(answer.result, COMMAND_UNKNOWN);
        assert_int_equal(answer.number, number);
    }
    assert_int_equal(fixture_state(&f).head->paused, 0);
}

static void test_a_row_removed_and_used_again_in_one_frame_is_the_new_one(void **state)
{
    (void)state;
    uint16_t kind = fixture_kind(&f, "jet");
    steps_send(&f, RING_CLIENTS, (struct command){.type = COMMAND_REMOVE, .entity = 2});
    for (int n = 0; n < 62; n++) /* the search goes round: the last one gets the freed row */
        steps_send(&f, RING_CLIENTS,
                   (struct command){.type = COMMAND_SPAWN,
                                    .kind = kind,
                                    .amount = BEHAVIOUR_HOLD,
                                    .value = {1000.0 + 100.0 * n, 1000.0, 500.0, 0.0, 100.0}});
    steps_send(&f, RING_CLIENTS,
               (struct command){.type = COMMAND_SPAWN,
                                .kind = kind,
                                .amount = BEHAVIOUR_HOLD,
                                .value = {40000.0, 40000.0, 500.0, 0.0, 100.0}});
    fixture_run(&f, 1);
    struct entities e = steps_rows(&f);
    assert_int_equal(e.row[truck].id, 65);
    assert_true(e.row[truck].x == 40000.0 &&
                e.row[truck].z == 40000.0); /* not moved yet, nor swept */
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_drive_takes_over_and_release_gives_back),
        TEST(test_drive_refuses_values_out_of_range_and_absent_vehicles),
        TEST(test_a_lease_keeps_others_out_and_ends),
        TEST(test_a_lease_is_kept_while_paused_and_ends_only_with_simulated_time),
        TEST(test_an_operator_releases_any_driver),
        TEST(test_without_a_lease_anybody_drives_and_without_end),
        TEST(test_drive_sets_brake_gear_and_the_turrets_controls),
        TEST(test_a_round_in_flight_takes_no_commands),
        TEST(test_fire_answers),
        TEST(test_no_vehicle_fires_at_itself),
        TEST(test_a_full_table_is_said_to_be_full),
        TEST(test_spawn_makes_what_was_asked_for),
        TEST(test_spawn_puts_jets_over_what_is_ahead),
        TEST(test_spawn_refuses_what_is_out_of_range),
        TEST(test_remove_frees_the_row_and_its_id_is_gone),
        TEST(test_paused_frames_do_not_advance_time),
        TEST(test_step_advances_just_so_many_frames),
        TEST(test_pausing_again_drops_the_steps_that_are_left),
        TEST(test_steps_do_not_overflow),
        TEST(test_scale_and_quit_are_kept_in_the_head),
        TEST(test_what_is_no_type_is_unknown),
        TEST(test_commands_are_applied_while_paused),
        TEST(test_each_command_is_applied_exactly_once_in_its_rings_order),
        TEST(test_commands_wait_while_a_frame_has_no_room_for_answers),
        TEST(test_and_while_it_has_no_room_for_events),
        TEST(test_an_answer_carries_the_whole_command),
        TEST(test_a_row_removed_and_used_again_in_one_frame_is_the_new_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
