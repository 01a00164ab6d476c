/* Bodies of other simulators in the collider: ours feel them, nothing here moves or damages them.
 */
#include "collider/remote_rows.h"

#include "tests/support/remotes.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define REMOTE remote_id(7, 1, 9)

static struct fixture f;
static const struct vec3 there = {25030.0, FIXTURE_GROUND_M, 25000.0};

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; remotes_max = 8; }; vehicles = ();"
                     "collision = { shape = \"model\"; };");
    return 0;
}

static uint32_t put_track(uint64_t remote, struct vec3 at, const char *kind)
{
    struct remote_record record = remotes_track(&f, remote, at);
    record.kind = fixture_kind(&f, kind);
    remotes_send(&f, record);
    fixture_run(&f, 1);
    return remotes_row(&f, remote);
}

static void test_our_vehicle_collides_and_theirs_stays(void **state)
{
    uint32_t own =
        fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                .velocity = {15.0, 0.0, 0.0}});
    (void)state;
    uint32_t row = put_track(REMOTE, there, "tank");
    for (int i = 0; i < 240; i++) {
        fixture_run(&f, 1);
        const struct state now = fixture_state(&f);
        const struct entities *e = &now.entities;
        assert_true(e->row[row].x == there.x && e->row[row].y == there.y &&
                    e->row[row].z == there.z);
        assert_true(e->row[row].vx == 0.0 && e->row[row].spin_y == 0.0 &&
                    e->row[row].heading < 1e-12);
        assert_int_equal(e->row[row].damage, DAMAGE_NONE);
        assert_true(e->row[row].harm_j == 0.0 && e->row[row].flags == 0 && e->row[row].bumped == 0);
    }
    const struct event_collision *collision = &fixture_event(&f, EVENT_COLLISION, 0)->collision;
    uint32_t ids = collision->a.id + collision->b.id;
    assert_int_equal(ids, steps_rows(&f).row[own].id + steps_rows(&f).row[row].id);
    assert_true(collision->impulse_ns > 1e5f); /* two masses of 54 t share 15 m/s */
    assert_true(steps_rows(&f).row[own].harm_j > 0.0);
    assert_true(steps_speed(&f, own) < 8.0);
}

static void test_a_round_detonates_on_them(void **state)
{
    uint32_t row = put_track(REMOTE, there, "truck");
    (void)state;
    fixture_put(&f, (struct fixture_entity){.kind = "shell",
                                            .at = {25000.0, FIXTURE_GROUND_M + 1.5, 25000.0},
                                            .velocity = {1000.0, 0.0, 0.0}});
    fixture_run(&f, 10);
    const struct event_detonation *detonation = &fixture_event(&f, EVENT_DETONATION, 0)->detonation;
    assert_int_equal(detonation->struck, STRUCK_VEHICLE);
    assert_int_equal(detonation->struck_party.id, steps_rows(&f).row[row].id);
    assert_int_equal(detonation->remote, 0); /* we are the ones who tell it */
    assert_int_equal(steps_rows(&f).row[row].damage, DAMAGE_NONE);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
    assert_true(steps_rows(&f).row[row].x == there.x);
    assert_int_equal(fixture_state(&f).head->tally.destroyed, 0);
}

static void test_a_blast_moves_ours_alone(void **state)
{
    uint32_t own = fixture_put(
        &f, (struct fixture_entity){.kind = "jeep", .at = {25030.0, FIXTURE_GROUND_M, 25008.0}});
    uint32_t row = put_track(REMOTE, there, "jeep");
    (void)state;
    fixture_put(&f, (struct fixture_entity){.kind = "bomb",
                                            .at = {25030.0, FIXTURE_GROUND_M + 5.0, 25004.0},
                                            .velocity = {0.0, -200.0, 0.0}});
    fixture_run(&f, 30);
    assert_int_equal(steps_rows(&f).row[own].state, ENTITY_WRECK);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
    assert_true(steps_rows(&f).row[row].x == there.x && steps_rows(&f).row[row].z == there.z);
}

static void test_two_of_theirs_pass(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    (void)state;
    put_track(remote_id(7, 1, 1), (struct vec3){25060.0, FIXTURE_GROUND_M, 25000.0}, "tank");
    record.model = DEAD_RECKONING_FPW;
    record.velocity[0] = 20.0f;
    remotes_send(&f, record);
    fixture_run(&f, 180);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_true(fabs(steps_rows(&f).row[remotes_row(&f, REMOTE)].x - (there.x + 20.0 * 179 / 60)) <
                1e-6);
}

static void test_an_aircraft_may_fly_into_our_ground(void **state)
{
    struct remote_record record =
        remotes_track(&f, REMOTE, (struct vec3){25000.0, FIXTURE_GROUND_M + 10.0, 25000.0});
    (void)state;
    record.kind = fixture_kind(&f, "jet");
    record.model = DEAD_RECKONING_FPW;
    record.velocity[1] = -10.0f;
    remotes_send(&f, record);
    fixture_run(&f, 121);
    uint32_t row = remotes_row(&f, REMOTE);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
    assert_true(fabs(steps_rows(&f).row[row].y - (FIXTURE_GROUND_M - 10.0)) < 1e-6);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
}

/* Its owner has it elsewhere, at rest, on the other side of our vehicle or in it. */
static uint32_t correct(double from_x, double to_x, uint32_t own)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    record.position[0] = from_x;
    remotes_send(&f, record);
    fixture_run(&f, 10);
    record.slot = remotes_row(&f, REMOTE);
    record.position[0] = to_x;
    remotes_send(&f, record);
    fixture_run(&f, 120);
    assert_true(fabs(steps_rows(&f).row[record.slot].x - to_x) < 1e-4);
    assert_true(steps_rows(&f).row[own].harm_j == 0.0);
    assert_int_equal(steps_rows(&f).row[own].damage, DAMAGE_NONE);
    assert_true(steps_speed(&f, own) < 0.1);
    return record.slot;
}

static uint32_t put_own(const char *kind)
{
    return fixture_put(
        &f, (struct fixture_entity){.kind = kind, .at = {25000.0, FIXTURE_GROUND_M, 25000.0}});
}

static void test_what_is_corrected_at_once_passes(void **state)
{
    (void)state;
    uint32_t own = put_own("tank");
    correct(24900.0, 25100.0, own);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_true(steps_rows(&f).row[own].x == 25000.0);
}

static void test_what_is_corrected_has_no_speed_by_it(void **state)
{
    (void)state;
    uint32_t own = put_own("jeep");
    correct(24976.0, 25024.0, own); /* 48 m within a quarter of a second: 192 m/s */
    for (uint32_t i = 0; i < fixture_event_count(&f, EVENT_COLLISION); i++)
        assert_true(fixture_event(&f, EVENT_COLLISION, i)->collision.closing_mps < 0.1f);
    assert_int_equal(fixture_event_count(&f, EVENT_CONTACT_END),
                     fixture_event_count(&f, EVENT_COLLISION));
}

static void test_what_is_corrected_into_ours_parts_from_it(void **state)
{
    (void)state;
    uint32_t own = put_own("jeep");
    uint32_t row = correct(24990.0, 25001.0, own);
    const struct entities e = steps_rows(&f);
    assert_true(hypot(e.row[own].x - e.row[row].x, e.row[own].z - e.row[row].z) > 1.5);
    assert_true(e.row[own].y < FIXTURE_GROUND_M + 0.1); /* on the ground, not on the tank */
}

/* Its owner goes on while the world is paused, through our vehicle and beyond. It is led there when
 * the world goes on. */
static void test_what_passes_while_the_world_is_paused_strikes_nothing(void **state)
{
    struct vec3 at = {25000.0, FIXTURE_GROUND_M, 25000.0};
    uint32_t own = fixture_put(&f, (struct fixture_entity){.kind = "tank", .at = there});
    (void)state;
    uint32_t row = put_track(REMOTE, at, "tank");
    steps_send(&f, RING_CLIENTS, (struct command){.source = 1, .type = COMMAND_PAUSE});
    for (; at.x < 25045.0; at.x += 1.5) {
        remotes_send(&f, remotes_track(&f, REMOTE, at));
        fixture_run(&f, 1);
        assert_true(steps_rows(&f).row[row].x < 25000.0 + 1e-6);
    }
    steps_send(&f, RING_CLIENTS, (struct command){.source = 1, .type = COMMAND_RESUME});
    fixture_run(&f, 60);
    assert_true(fabs(steps_rows(&f).row[row].x - (at.x - 1.5)) < 1e-6);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_true(steps_rows(&f).row[own].x == there.x && steps_rows(&f).row[own].harm_j == 0.0);
}

int main(void)
{
#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_our_vehicle_collides_and_theirs_stays),
        TEST(test_a_round_detonates_on_them),
        TEST(test_a_blast_moves_ours_alone),
        TEST(test_two_of_theirs_pass),
        TEST(test_an_aircraft_may_fly_into_our_ground),
        TEST(test_what_is_corrected_at_once_passes),
        TEST(test_what_is_corrected_has_no_speed_by_it),
        TEST(test_what_is_corrected_into_ours_parts_from_it),
        TEST(test_what_passes_while_the_world_is_paused_strikes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
