/* How vehicles that cruise stand on the ground, and how their stretches end. */
#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/params.h"
#include "world/cruise_pose.h"
#include "world/terrain/rest_pose.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static uint32_t tank;

/* A tank that cruises up a plane that rises to the east, 10 m/s. */
static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { cruise = true; };");
    steps_plane(&f, 0.1, 0.0);
    tank = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                   .at = {25000.0, 0.0, 25000.0},
                                                   .velocity = {10.0, 0.0, 0.0},
                                                   .behaviour = BEHAVIOUR_PATROL});
    struct state committed = fixture_state(&f);
    committed.entities.row[tank].y = steps_ground_at(&f, 25000.0, 25000.0);
    committed.entities.row[tank].cruise_tick = (uint32_t)committed.head->tick + 12;
    return 0;
}

static void test_its_pose_is_that_of_the_ground_on_the_way(void **state)
{
    const struct state committed = fixture_state(&f);
    (void)state;
    struct cruise_pose pose =
        cruise_pose_of(&f.view.world, NULL, &committed.entities, tank, committed.head->tick);
    struct rest_pose stands = rest_pose_of(&f.view.world.terrain, NULL,
                                           &f.view.world.kinds[committed.entities.row[tank].kind],
                                           24998.0, 25000.0, pose.heading_rad);
    assert_true(fabs(pose.at.x - 24998.0) < 1e-9);
    assert_true(fabs(pose.at.y - stands.y_m) < 1e-9 &&
                fabs(pose.pitch_rad - stands.pitch_rad) < 1e-9);
    assert_true(pose.pitch_rad > 0.09);
    pose =
        cruise_pose_of(&f.view.world, NULL, &committed.entities, tank, committed.head->tick + 12);
    assert_true(pose.at.x == 25000.0 && pose.pitch_rad == committed.entities.row[tank].pitch);
}

static void test_a_stretch_ends_where_it_is(void **state)
{
    struct state committed = fixture_state(&f);
    static uint64_t written[ROW_BLOCK_WORDS];
    const struct table_writer writer = {&committed.entities, NULL, written};
    uint64_t tick = committed.head->tick;
    (void)state;
    struct cruise_pose before =
        cruise_pose_of(&f.view.world, NULL, &committed.entities, tank, tick + 3);
    assert_true(cruise_pose_end(&writer, &f.view.world, NULL, tank, tick + 3, tick + 3));
    assert_true(committed.entities.row[tank].x == before.at.x);
    assert_true(committed.entities.row[tank].y == before.at.y);
    assert_false(cruise_goes(&committed.entities, tank, tick));
    assert_true(written[tank / 64] >> tank % 64 & 1);
    assert_false(cruise_pose_end(&writer, &f.view.world, NULL, tank, tick + 3, tick + 3));
}

/* A stretch that is made shorter leads the same way, and the fuel for what is left of it is not
 * burnt. */
static void test_a_shorter_stretch_leads_the_same_way(void **state)
{
    struct state committed = fixture_state(&f);
    struct entities *e = &committed.entities;
    static uint64_t written[ROW_BLOCK_WORDS];
    const struct table_writer writer = {e, NULL, written};
    const uint64_t tick = committed.head->tick;
    struct cruise_pose way[7];
    (void)state;
    e->row[tank].cruise_rps = 0.2, e->row[tank].cruise_mps2 = 1.5;
    const double off_m = cruise_off(0.2, 1.5, 12.0 * world_dt_s(&f.view.world));
    e->row[tank].throttle = 0.75F, e->row[tank].fuel_l = 100.0;
    for (uint64_t n = 0; n < 7; n++)
        way[n] = cruise_pose_of(&f.view.world, NULL, e, tank, tick + n);
    assert_true(cruise_pose_end(&writer, &f.view.world, NULL, tank, tick + 6, tick));
    assert_int_equal(e->row[tank].cruise_tick, tick + 6);
    assert_true(e->row[tank].x == way[6].at.x && e->row[tank].y == way[6].at.y);
    for (uint64_t n = 0; n < 7; n++) {
        struct cruise_pose pose = cruise_pose_of(&f.view.world, NULL, e, tank, tick + n);
        assert_true(vec3_length(vec3_sub(pose.at, way[n].at)) < off_m && off_m < CRUISE_OFF_M);
        assert_true(fabs(pose.heading_rad - way[n].heading_rad) < 1e-9);
    }
    const double burns_lps = 0.75 * f.view.world.kinds[e->row[tank].kind].fuel_lps;
    assert_true(burns_lps > 0.0 && fabs(e->row[tank].fuel_l - 100.0 - 0.1 * burns_lps) < 1e-9);
    assert_false(cruise_pose_end(&writer, &f.view.world, NULL, tank, tick + 6, tick));
}

static void test_a_copy_shows_all_where_they_are(void **state)
{
    struct state committed = fixture_state(&f);
    uint64_t tick = committed.head->tick;
    (void)state;
    cruise_pose_settle(&committed.entities, &f.view.world, NULL, committed.head->used, tick);
    assert_true(fabs(committed.entities.row[tank].x - 24998.0) < 1e-9);
    assert_int_equal(committed.entities.row[tank].cruise_tick, 0);
}

/* A helicopter leans into its turn and lowers its nose on the way. */
static void test_an_aircraft_leans_evenly(void **state)
{
    (void)state;
    uint32_t i = fixture_put(&f, (struct fixture_entity){.kind = "helicopter",
                                                         .at = {25000.0, 500.0, 26000.0},
                                                         .velocity = {40.0, 0.0, 0.0},
                                                         .behaviour = BEHAVIOUR_PATROL});
    struct state committed = fixture_state(&f);
    struct entities *e = &committed.entities;
    uint64_t tick = committed.head->tick;
    e->row[i].cruise_tick = (uint32_t)tick + 12; /* 0.2 s */
    e->row[i].pitch = -0.1, e->row[i].cruise_pitch_rps = -0.25f;
    e->row[i].roll = 0.2, e->row[i].cruise_roll_rps = 0.5f;
    struct cruise_pose pose = cruise_pose_of(&f.view.world, NULL, e, i, tick);
    assert_true(fabs(pose.pitch_rad + 0.05) < 1e-9 && fabs(pose.roll_rad - 0.1) < 1e-9);
    cruise_pose_settle_row(e, &f.view.world, NULL, i, tick + 6);
    assert_true(fabs(e->row[i].pitch + 0.075) < 1e-9 && fabs(e->row[i].roll - 0.15) < 1e-9);
    assert_int_equal(e->row[i].cruise_tick, 0);
}

#define IN_WORLD(test)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_WORLD(test_its_pose_is_that_of_the_ground_on_the_way),
        IN_WORLD(test_a_stretch_ends_where_it_is),
        IN_WORLD(test_a_shorter_stretch_leads_the_same_way),
        IN_WORLD(test_a_copy_shows_all_where_they_are),
        IN_WORLD(test_an_aircraft_leans_evenly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
