/* Which rows come to rest, and what wakes them. */
#include "mover/resting_rows.h"
#include "tests/support/fixture.h"
#include "tests/support/remotes.h"
#include "tests/support/steps.h"
#include "world/maths/dead_reckoning.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define SECOND 60u

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { remotes_max = 20; cruise = false; };");
    return 0;
}

static uint32_t put(const char *kind, double z, enum behaviour behaviour)
{
    return steps_put(&f, kind, (struct vec3){25000.0, 100.0, z}, FORCE_RED, behaviour);
}

static bool rests(uint32_t row)
{
    return f.stepper.mover.resting.resting[row / 64] >> row % 64 & 1;
}

static bool has_turns(uint32_t row)
{
    return f.stepper.mover.resting.turns[row / 64] >> row % 64 & 1;
}

static void test_what_has_nothing_to_do_rests(void **state)
{
    uint32_t tank = put("tank", 25000.0, BEHAVIOUR_IDLE);
    uint32_t looks = put("tank", 25100.0, BEHAVIOUR_IDLE);
    uint32_t hovers = put("helicopter", 25200.0, BEHAVIOUR_IDLE);
    uint32_t holds = put("jeep", 25300.0, BEHAVIOUR_HOLD);
    uint32_t patrols = put("truck", 25400.0, BEHAVIOUR_PATROL);
    uint32_t drives = fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                              .at = {25000.0, 100.0, 25500.0},
                                                              .velocity = {5.0, 0.0, 0.0}});
    (void)state;
    steps_rows(&f).row[looks].flags = ENTITY_FLAG_FIRE_AT_WILL;
    steps_rows(&f).row[hovers].y += steps_kind(&f, "helicopter")->cruise_altitude_m;
    fixture_run(&f, 1); /* it tells mover and collider that the test has written */
    fixture_continue(&f, 20 * SECOND);
    while (f.stepper.mover.neighbours.tick % 6 != 1) /* nobody has just decided */
        fixture_continue(&f, 1);
    assert_true(rests(tank) && !has_turns(tank));
    assert_true(rests(looks) && has_turns(looks));
    assert_true(rests(hovers) && !has_turns(hovers));
    assert_true(rests(holds));
    assert_false(rests(patrols));
    assert_false(rests(drives));
}

static void test_a_restarted_mover_knows_no_row_at_rest(void **state)
{
    uint32_t tank = put("tank", 25000.0, BEHAVIOUR_IDLE);
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, SECOND);
    assert_true(rests(tank));
    fixture_threads(&f, 1);
    assert_false(rests(tank));
    fixture_continue(&f, SECOND);
    assert_true(rests(tank));
}

static void test_a_crater_wakes_what_stands_at_its_rim(void **state)
{
    uint32_t tank = put("tank", 25000.0, BEHAVIOUR_IDLE),
             far = put("tank", 30000.0, BEHAVIOUR_IDLE);
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, SECOND);
    assert_true(rests(tank) && rests(far));
    double before = steps_rows(&f).row[tank].pitch;
    struct state now = fixture_state(&f);
    now.craters[0] = (struct crater){25000.0, 25008.0, 6.0f, 2.0f, 1};
    now.head->crater_count = 1;
    fixture_continue(&f, 2); /* in the first frame it takes to its springs as it stood */
    assert_true(steps_rows(&f).row[tank].pitch != before);
    assert_true(rests(far));
}

static void test_a_command_wakes_the_row(void **state)
{
    uint32_t tank = put("tank", 25000.0, BEHAVIOUR_IDLE);
    (void)state;
    fixture_run(&f, 1);
    fixture_continue(&f, SECOND);
    steps_send(&f, RING_CLIENTS,
               (struct command){.source = 1,
                                .type = COMMAND_DRIVE,
                                .entity = steps_rows(&f).row[tank].id,
                                .value = {1.0}});
    fixture_continue(&f, SECOND);
    assert_false(rests(tank));
    assert_true(steps_speed(&f, tank) > 1.0);
}

/* A tank stands and fires at a truck, which no round harms. It rests while it loads. */
static void test_a_laid_gun_rests_until_it_fires(void **state)
{
    uint32_t red = put("tank", 25000.0, BEHAVIOUR_IDLE),
             blue = put("truck", 24500.0, BEHAVIOUR_HOLD);
    uint32_t rested = 0, loaded;
    (void)state;
    steps_kind(&f, "truck")->resistance_j = 1e12;
    struct entities e = steps_rows(&f);
    e.row[blue].force = FORCE_BLUE;
    e.row[red].flags = ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_STAND;
    fixture_run(&f, 1);
    fixture_continue(&f, 20 * SECOND);
    loaded = steps_rows(&f).row[red].rounds;
    for (uint32_t frame = 0; frame < 30 * SECOND; frame++) {
        fixture_continue(&f, 1);
        rested += rests(red) && has_turns(red) && steps_rows(&f).row[red].target_id != 0;
    }
    print_message("rested in %u of %u frames, fired %u rounds\n", rested, 30 * SECOND,
                  loaded - steps_rows(&f).row[red].rounds);
    assert_true(loaded - steps_rows(&f).row[red].rounds >= 2);
    assert_true(rested > 20 * SECOND);
}

static void test_a_remote_row_that_stands_rests(void **state)
{
    const struct vec3 place = {25000.0, 100.0, 26000.0}, beside = {25000.0, 100.0, 26100.0};
    struct remote_record stands = remotes_track(&f, remote_id(7, 1, 1), place);
    struct remote_record drives = remotes_track(&f, remote_id(7, 1, 2), beside);
    (void)state;
    stands.model = DEAD_RECKONING_STATIC;
    drives.model = DEAD_RECKONING_FPW;
    drives.velocity[0] = 5.0f;
    for (uint16_t n = 3; n <= 12; n++) { /* whole words of rows of others */
        remotes_send(&f, remotes_track(&f, remote_id(7, 1, n),
                                       (struct vec3){25000.0 + 20.0 * n, 100.0, 27000.0}));
    }
    remotes_send(&f, stands);
    remotes_send(&f, drives);
    fixture_run(&f, 1);
    fixture_continue(&f, SECOND);
    uint32_t row = remotes_row(&f, stands.remote);
    assert_true(rests(row));
    assert_false(rests(remotes_row(&f, drives.remote)));
    stands.position[0] += 1.0; /* its owner corrects it, a little in each frame */
    remotes_send(&f, stands);
    fixture_continue(&f, 3);
    assert_true(steps_rows(&f).row[row].x > 25000.01 && steps_rows(&f).row[row].x < 25000.9);
    fixture_continue(&f, SECOND);
    assert_true(rests(row));
    assert_true(fabs(steps_rows(&f).row[row].x - 25001.0) < 1e-6);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_what_has_nothing_to_do_rests),
        TEST(test_a_restarted_mover_knows_no_row_at_rest),
        TEST(test_a_crater_wakes_what_stands_at_its_rim),
        TEST(test_a_command_wakes_the_row),
        TEST(test_a_laid_gun_rests_until_it_fires),
        TEST(test_a_remote_row_that_stands_rests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
