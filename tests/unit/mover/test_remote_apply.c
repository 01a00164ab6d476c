/* Records of other simulators: what each does, what is refused and how it is told. */
#include "mover/remote_apply.h"

#include "tests/support/remotes.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define REMOTE remote_id(7, 1, 9)

static struct fixture f;
static uint32_t own;
static const struct vec3 there = {25300.0, FIXTURE_GROUND_M, 25000.0};

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; remotes_max = 3; }; vehicles = ();");
    own = fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                  .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                                  .force = FORCE_BLUE});
    return 0;
}

static const struct event_input *last_input(void)
{
    uint32_t count = fixture_event_count(&f, EVENT_INPUT);
    assert_true(count > 0);
    return &fixture_event(&f, EVENT_INPUT, count - 1)->input;
}

/* Sends a record and returns why it is refused. */
static enum remote_refusal does(struct remote_record record)
{
    remotes_send(&f, record);
    fixture_run(&f, 1);
    assert_int_equal(last_input()->count, 1);
    assert_int_equal(last_input()->refused, last_input()->because != REMOTE_TAKEN);
    return (enum remote_refusal)last_input()->because;
}

static void test_a_track_makes_a_row(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    (void)state;
    record.attitude[0] = 1.0f;
    record.turret = 8192;
    record.damage = DAMAGE_MED;
    assert_int_equal(does(record), REMOTE_TAKEN);
    const struct state now = fixture_state(&f);
    uint32_t row = remotes_row(&f, REMOTE);
    const struct entities *e = &now.entities;
    assert_int_equal(row, 1);
    assert_int_equal(e->row[row].id, 2);
    assert_int_equal(e->row[row].kind, fixture_kind(&f, "tank"));
    assert_int_equal(e->row[row].force, FORCE_RED);
    assert_int_equal(e->row[row].damage, DAMAGE_MED);
    assert_int_equal(e->row[row].state, ENTITY_ACTIVE);
    assert_true(e->row[row].x == there.x && e->row[row].z == there.z);
    assert_true(fabs(e->row[row].heading - 1.0) < 1e-6);
    assert_true(fabs((double)e->row[row].turret - 0.25 * PI) < 1e-3);
    assert_int_equal(now.head->vehicles, 2);
    assert_int_equal(now.head->command_cursor[RING_GATEWAY], 1);
    fixture_run(&f, 100);
    assert_int_equal(fixture_event_count(&f, EVENT_NONE), 1); /* the input alone */
}

static void test_it_keeps_row_and_id(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    (void)state;
    assert_int_equal(does(record), REMOTE_TAKEN);
    for (int i = 0; i < 5; i++) { /* whatever the sender believes of the row */
        record.slot = (uint32_t[]){SLOT_NONE, 1, 0, 63, 1000000}[i];
        record.position[0] += 1.0;
        assert_int_equal(does(record), REMOTE_TAKEN);
        assert_int_equal(remotes_row(&f, REMOTE), 1);
        assert_int_equal(steps_rows(&f).row[1].id, 2);
    }
    record.damage = DAMAGE_DESTROYED;
    assert_int_equal(does(record), REMOTE_TAKEN);
    assert_int_equal(steps_rows(&f).row[1].state, ENTITY_WRECK);
    fixture_run(&f, 30);
    assert_int_equal(remotes_row(&f, REMOTE), 1);
    record.damage = DAMAGE_NONE; /* repaired */
    assert_int_equal(does(record), REMOTE_TAKEN);
    assert_int_equal(steps_rows(&f).row[1].state, ENTITY_ACTIVE);
    record.type = REMOTE_LOST;
    assert_int_equal(does(record), REMOTE_TAKEN);
    assert_int_equal(remotes_row(&f, REMOTE), SLOT_NONE);
    assert_int_equal(does(record), REMOTE_NOBODY);
}

static void test_more_than_allowed_are_refused(void **state)
{
    (void)state;
    for (uint16_t i = 1; i <= 3; i++)
        assert_int_equal(does(remotes_track(&f, remote_id(7, 1, i), there)), REMOTE_TAKEN);
    for (uint32_t i = 4; i <= 40; i++)
        remotes_send(&f, remotes_track(&f, remote_id(7, 1, (uint16_t)i), there));
    fixture_run(&f, 1);
    assert_int_equal(last_input()->count, 37); /* one event for all of them */
    assert_int_equal(last_input()->refused, 37);
    assert_int_equal(last_input()->because, REMOTE_TOO_MANY);
    assert_true(last_input()->remote == remote_id(7, 1, 4));
    assert_int_equal(fixture_state(&f).head->vehicles, 4);
}

static void test_bad_tracks_are_refused(void **state)
{
    const double nan = (double)NAN, far = 1e300;
    struct remote_record good = remotes_track(&f, REMOTE, there), bad;
    (void)state;
#define REFUSES(member, value, refusal)                                                            \
    bad = good;                                                                                    \
    bad.member = (value);                                                                          \
    assert_int_equal(does(bad), refusal)
    REFUSES(position[0], nan, REMOTE_UNKNOWN);
    REFUSES(position[1], far, REMOTE_UNKNOWN);
    REFUSES(position[2], -1.0, REMOTE_UNKNOWN);
    REFUSES(velocity[2], (float)nan, REMOTE_UNKNOWN);
    REFUSES(acceleration[1], 1e9f, REMOTE_UNKNOWN);
    REFUSES(rates[0], -1e9f, REMOTE_UNKNOWN);
    REFUSES(attitude[0], 8.0f, REMOTE_UNKNOWN);
    REFUSES(force, FORCE_COUNT, REMOTE_UNKNOWN);
    REFUSES(damage, DAMAGE_COUNT, REMOTE_UNKNOWN);
    REFUSES(model, 0, REMOTE_UNKNOWN);
    REFUSES(model, 10, REMOTE_UNKNOWN);
    REFUSES(remote, 0, REMOTE_UNKNOWN);
    REFUSES(kind, KIND_NONE, REMOTE_NO_KIND);
    REFUSES(kind, fixture_kind(&f, "tree"), REMOTE_NO_KIND);
    assert_int_equal(remotes_row(&f, REMOTE), SLOT_NONE);
    assert_int_equal(fixture_state(&f).head->used, 1);
}

static void test_a_jump_is_refused(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    (void)state;
    assert_int_equal(does(record), REMOTE_TAKEN);
    record.position[0] = 1000.0;
    record.position[2] = 49000.0;
    assert_int_equal(does(record), REMOTE_JUMPS);
    assert_true(steps_rows(&f).row[1].x == there.x && steps_rows(&f).row[1].z == there.z);
}

/* Who owns an entity is for the gateway alone. */
static void test_an_owner_has_no_effect(void **state)
{
    struct remote_record track = remotes_track(&f, REMOTE, there);
    struct remote_record owner = {
        .remote = REMOTE, .type = REMOTE_OWNER, .slot = SLOT_NONE, .event = 4711};
    (void)state;
    assert_int_equal(does(owner), REMOTE_TAKEN); /* also of an entity that is not there */
    assert_int_equal(fixture_state(&f).head->vehicles, 1);
    assert_int_equal(does(track), REMOTE_TAKEN);
    struct entities e = steps_rows(&f);
    uint32_t row = remotes_row(&f, REMOTE), heard = e.row[row].seen_tick;
    assert_int_equal(does(owner), REMOTE_TAKEN);
    e = steps_rows(&f);
    assert_int_equal(remotes_row(&f, REMOTE), row);
    assert_int_equal(e.row[row].seen_tick, heard); /* its owner has said nothing of its place */
    assert_true(e.row[row].x == there.x && e.row[row].z == there.z);
}

static void test_nobody_drives_them(void **state)
{
    static const enum command_type types[] = {COMMAND_DRIVE, COMMAND_RELEASE, COMMAND_FIRE,
                                              COMMAND_REMOVE};
    (void)state;
    assert_int_equal(does(remotes_track(&f, REMOTE, there)), REMOTE_TAKEN);
    for (int i = 0; i < 4; i++)
        assert_int_equal(steps_command(&f, (struct command){.type = types[i], .entity = 2}).result,
                         COMMAND_REMOTE);
    assert_int_equal(remotes_row(&f, REMOTE), 1);
    /* Records are taken from the gateway's ring alone. */
    struct remote_record record = remotes_track(&f, remote_id(7, 1, 10), there);
    assert_int_equal(steps_command(&f, remote_record_slot(&record)).result, COMMAND_UNKNOWN);
    assert_int_equal(remotes_row(&f, record.remote), SLOT_NONE);
}

static void test_commands_and_records_keep_their_order(void **state)
{
    (void)state;
    remotes_send(&f, remotes_track(&f, remote_id(7, 1, 1), there));
    remotes_send(&f, remotes_track(&f, remote_id(7, 1, 2), there));
    steps_send(&f, RING_GATEWAY, (struct command){.type = COMMAND_PAUSE});
    remotes_send(&f, remotes_track(&f, remote_id(7, 1, 3), there));
    fixture_run(&f, 1);
    assert_int_equal(fixture_event_count(&f, EVENT_NONE), 3);
    assert_int_equal(fixture_event(&f, EVENT_NONE, 0)->type, EVENT_INPUT);
    assert_int_equal(fixture_event(&f, EVENT_NONE, 0)->input.count, 2);
    assert_int_equal(fixture_event(&f, EVENT_NONE, 1)->command.ring, RING_GATEWAY);
    assert_int_equal(fixture_event(&f, EVENT_NONE, 2)->input.first, 3);
    assert_int_equal(fixture_event(&f, EVENT_NONE, 2)->input.count, 1);
    assert_int_equal(fixture_state(&f).head->paused, 1);
    assert_int_equal(fixture_state(&f).head->tally.commands, 1);
}

static void test_a_shot_alarms_its_target(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    (void)state;
    assert_int_equal(does(record), REMOTE_TAKEN);
    steps_rows(&f).row[own].behaviour = steps_rows(&f).row[own].order = BEHAVIOUR_IDLE;
    record.type = REMOTE_FIRE;
    record.kind = fixture_kind(&f, "shell");
    record.entity = 1;
    assert_int_equal(does(record), REMOTE_TAKEN);
    const struct event_fire *fire = &fixture_event(&f, EVENT_FIRE, 0)->fire;
    assert_int_equal(fire->shooter.id, 2);
    assert_int_equal(fire->target.id, 1);
    assert_int_equal(fire->munition.id, 0);
    assert_int_equal(fire->munition.kind, record.kind);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
    assert_int_equal(fixture_event(&f, EVENT_AGENT, 0)->agent.because, REASON_FIRED_UPON);
    record.kind = fixture_kind(&f, "tank");
    assert_int_equal(does(record), REMOTE_NO_KIND);
}

static void test_a_hit_harms_by_our_rules(void **state)
{
    struct remote_record record = {.remote = REMOTE,
                                   .type = REMOTE_STRUCK,
                                   .slot = SLOT_NONE,
                                   .entity = 1,
                                   .kind = fixture_kind(&f, "shell"),
                                   .velocity = {-1200.0f, 0.0f, 0.0f},
                                   .position = {0.0, 1.0, 0.0}};
    (void)state;
    assert_int_equal(does(record), REMOTE_TAKEN);
    assert_int_equal(fixture_state(&f).head->munitions, 1);
    fixture_run(&f, 2);
    const struct event_detonation *detonation = &fixture_event(&f, EVENT_DETONATION, 0)->detonation;
    assert_int_equal(detonation->struck, STRUCK_VEHICLE);
    assert_int_equal(detonation->struck_party.id, 1);
    assert_int_equal(detonation->remote, 1);
    assert_true(steps_rows(&f).row[own].harm_j > 0.0);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 0);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
    record.entity = 77;
    assert_int_equal(does(record), REMOTE_NOBODY);
}

/* A sender that tells the target's speed, or that of a thrown charge: it still strikes whom it
 * names, and not the ground before it. */
static void test_a_slow_round_strikes_whom_it_names(void **state)
{
    static const float speeds_mps[] = {0.0f, 1.5f, 6.0f, 40.0f, 99.0f};
    (void)state;
    for (unsigned i = 0; i < sizeof speeds_mps / sizeof *speeds_mps; i++) {
        struct remote_record record = {.remote = REMOTE,
                                       .type = REMOTE_STRUCK,
                                       .slot = SLOT_NONE,
                                       .entity = 1,
                                       .kind = fixture_kind(&f, "shell"),
                                       .velocity = {-speeds_mps[i], 0.0f, 0.0f},
                                       .position = {0.0, 1.0, 0.0}};
        assert_int_equal(does(record), REMOTE_TAKEN);
        fixture_run(&f, 30);
        const struct event_detonation *detonation =
            &fixture_event(&f, EVENT_DETONATION, i)->detonation;
        assert_int_equal(detonation->struck, STRUCK_VEHICLE);
        assert_int_equal(detonation->struck_party.id, 1);
    }
}

/* The sender's vehicle may be larger than ours, and its numbers odd. */
static void test_a_round_beside_the_hull_strikes_whom_it_names(void **state)
{
    static const double points[][3] = {{4.5, 0.0, 0.0}, {1e9, 0.0, 0.0}, {0.0, 40.0, 3.0}};
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        struct remote_record record = {.remote = REMOTE,
                                       .type = REMOTE_STRUCK,
                                       .slot = SLOT_NONE,
                                       .entity = 1,
                                       .kind = fixture_kind(&f, "shell"),
                                       .velocity = {0.0f, 0.0f, -900.0f}};
        memcpy(record.position, points[i], sizeof record.position);
        enum remote_refusal refusal = does(record);
        assert_int_equal(refusal, points[i][0] > 1e6 ? REMOTE_UNKNOWN : REMOTE_TAKEN);
        if (refusal != REMOTE_TAKEN)
            continue;
        fixture_run(&f, 30);
        assert_int_equal(
            fixture_event(&f, EVENT_DETONATION, i > 0 ? 1 : 0)->detonation.struck_party.id, 1);
    }
}

static void test_a_shell_digs_a_crater(void **state)
{
    struct remote_record record = remotes_track(&f, 0, there);
    (void)state;
    record.type = REMOTE_STRUCK;
    record.kind = fixture_kind(&f, "artillery");
    record.position[1] += 5.0; /* their ground is a little higher than ours */
    assert_int_equal(does(record), REMOTE_TAKEN);
    fixture_run(&f, 2);
    assert_int_equal(fixture_event(&f, EVENT_DETONATION, 0)->detonation.struck, STRUCK_GROUND);
    const struct event_crater *crater = &fixture_event(&f, EVENT_CRATER, 0)->crater;
    assert_true(fabs(crater->point[0] - there.x) < 0.1 && fabs(crater->point[2] - there.z) < 0.1);
}

/* High above the ground, or near it when it is told to burst in the air, it bursts where it is told
 * and digs nothing. Below our ground it cannot. */
static void test_a_burst_in_the_air(void **state)
{
    static const struct {
        double high_m;
        uint8_t model;
        enum struck struck;
    } cases[] = {{200.0, 0, STRUCK_AIR},
                 {200.0, REMOTE_BURST_IN_AIR, STRUCK_AIR},
                 {5.0, REMOTE_BURST_IN_AIR, STRUCK_AIR},
                 {-2.0, REMOTE_BURST_IN_AIR, STRUCK_GROUND}};
    struct remote_record record = remotes_track(&f, 0, there);
    (void)state;
    record.type = REMOTE_STRUCK;
    record.kind = fixture_kind(&f, "artillery");
    for (uint32_t i = 0; i < 4; i++) {
        record.position[1] = FIXTURE_GROUND_M + cases[i].high_m;
        record.model = cases[i].model;
        assert_int_equal(does(record), REMOTE_TAKEN);
        fixture_run(&f, 2);
        const struct event_detonation *burst = &fixture_event(&f, EVENT_DETONATION, i)->detonation;
        assert_int_equal(burst->struck, cases[i].struck);
        double high_m = maths_max(cases[i].high_m, 0.0);
        assert_true(fabs(burst->point[1] - FIXTURE_GROUND_M - high_m) < 1.0);
        assert_int_equal(fixture_event_count(&f, EVENT_CRATER), i == 3 ? 1 : 0);
    }
}

/* What a round still penetrates goes by how far it has flown, not by where it appears: the harm of
 * a round from so far away is that of the one that our rules make after as long a flight. */
static double harm_after(float flown_m)
{
    struct remote_record record = {.remote = REMOTE,
                                   .type = REMOTE_STRUCK,
                                   .slot = SLOT_NONE,
                                   .entity = 1,
                                   .kind = fixture_kind(&f, "shell"),
                                   .velocity = {0.0f, 0.0f, 1500.0f}, /* at its front */
                                   .position = {0.0, 1.0, 0.0},
                                   .flown_m = flown_m};
    steps_rows(&f).row[own].harm_j = 0.0;
    steps_rows(&f).row[own].damage = DAMAGE_NONE;
    steps_rows(&f).row[own].state = ENTITY_ACTIVE;
    steps_rows(&f).row[own].born_tick = 0;
    assert_int_equal(does(record), REMOTE_TAKEN);
    fixture_run(&f, 2);
    return steps_rows(&f).row[own].harm_j;
}

static void test_a_far_round_pierces_less(void **state)
{
    (void)state;
    struct kind *kinds = (struct kind *)(uintptr_t)f.view.world.kinds;
    struct kind *shell = &kinds[fixture_kind(&f, "shell")];
    const double armour_mm = kinds[fixture_kind(&f, "tank")].armour_mm[0];
    shell->penetration_mm = 2.0 * armour_mm;
    shell->penetration_loss = 0.5 * armour_mm; /* half of it is left after two kilometres */
    double near_j = harm_after(0.0f), far_j = harm_after(3000.0f);
    print_message("harm of a round: %.0f J at the muzzle, %.0f J after 3 km\n", near_j, far_j);
    assert_true(near_j > 2.0 * far_j);
    assert_true(far_j > 0.0);
}

/* A Collision of which only the other simulator knows: the tank gets the impulse of two masses. */
static void test_a_body_strikes(void **state)
{
    struct remote_record body = {.remote = REMOTE,
                                 .type = REMOTE_STRUCK,
                                 .slot = SLOT_NONE,
                                 .entity = 1,
                                 .kind = KIND_NONE,
                                 .velocity = {0.0f, 0.0f, 20.0f}, /* from the north */
                                 .position = {3.0, 0.0, 0.0}}; /* at its front: it points north */
    (void)state;
    const struct kind *tank = &f.view.world.kinds[fixture_kind(&f, "tank")];
    body.mass_kg = (float)tank->mass_kg;
    assert_int_equal(does(body), REMOTE_TAKEN);
    struct entities e = steps_rows(&f);
    assert_true(fabs(e.row[own].vz - 10.0) < 0.5); /* inelastic, and as heavy */
    assert_true(e.row[own].harm_j > 0.0);
    const struct event_collision *told = &fixture_event(&f, EVENT_COLLISION, 0)->collision;
    assert_int_equal(told->a.id, 1);
    assert_int_equal(told->remote, 1);
    assert_true(fabs((double)told->closing_mps - 20.0) < 0.5);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    /* What parts already is struck no more. */
    body.velocity[2] = 5.0f;
    double vz = steps_rows(&f).row[own].vz;
    assert_int_equal(does(body), REMOTE_TAKEN);
    assert_true(steps_rows(&f).row[own].vz <= vz);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    body.mass_kg = 0.0f;
    assert_int_equal(does(body), REMOTE_UNKNOWN);
    body.mass_kg = 1.0f;
    body.entity = 77;
    assert_int_equal(does(body), REMOTE_NOBODY);
}

/* A guided missile of another simulator flies here, meets nothing, and is no vehicle. */
static void test_a_munition_flies(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, (struct vec3){25000.0, 101.0, 24800.0});
    (void)state;
    record.kind = fixture_kind(&f, "missile");
    record.model = DEAD_RECKONING_FPW;
    record.velocity[2] = 200.0f; /* through our tank */
    memcpy(record.marking, "HELLFIRE", 8);
    assert_int_equal(does(record), REMOTE_TAKEN);
    uint32_t row = remotes_row(&f, REMOTE);
    char marking[REMOTE_MARKING_MAX + 1];
    struct entities e = steps_rows(&f);
    remote_marking(&e, row, marking);
    assert_string_equal(marking, "HELLFIRE");
    assert_int_equal(e.row[row].behaviour, BEHAVIOUR_FLIGHT);
    assert_int_equal(fixture_state(&f).head->munitions, 1);
    assert_int_equal(fixture_state(&f).head->vehicles, 1);
    fixture_run(&f, 120);
    e = steps_rows(&f);
    assert_int_equal(remotes_row(&f, REMOTE), row);
    assert_true(fabs(e.row[row].z - (24800.0 + 200.0 * 121.0 / 60.0)) < 5.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 0);
    assert_int_equal(fixture_event_count(&f, EVENT_DETONATION), 0);
    assert_true(e.row[own].harm_j == 0.0);
    record.kind = fixture_kind(&f, "tank"); /* no munition becomes a vehicle */
    assert_int_equal(does(record), REMOTE_NO_KIND);
    record.type = REMOTE_LOST;
    assert_int_equal(does(record), REMOTE_TAKEN);
    assert_int_equal(fixture_state(&f).head->munitions, 0);
    assert_int_equal(fixture_state(&f).head->vehicles, 1);
}

static void test_a_marking_is_its_name(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, there);
    char marking[REMOTE_MARKING_MAX + 1];
    (void)state;
    memcpy(record.marking, "ABRAMS 1\x01%n", 11);
    assert_int_equal(does(record), REMOTE_TAKEN);
    struct entities e = steps_rows(&f);
    uint32_t row = remotes_row(&f, REMOTE);
    assert_string_equal(world_row_name(&f.view.world, &e, row, marking), "ABRAMS 1?%n");
    assert_string_equal(world_row_name(&f.view.world, &e, own, marking), "");
}

static void test_a_frame_without_room_waits(void **state)
{
    (void)state;
    steps_params(&f)->intents_per_frame = 2;
    for (uint16_t i = 0; i < 3; i++) {
        struct remote_record record = remotes_track(&f, remote_id(7, 1, 1), there);
        record.type = REMOTE_FIRE;
        record.kind = fixture_kind(&f, "shell");
        remotes_send(&f, record);
    }
    fixture_run(&f, 1);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_GATEWAY], 1);
    fixture_run(&f, 2);
    assert_int_equal(fixture_state(&f).head->command_cursor[RING_GATEWAY], 3);
    assert_int_equal(fixture_event_count(&f, EVENT_FIRE), 3);
    assert_int_equal(fixture_state(&f).head->tally.events_dropped, 0);
}

int main(void)
{
#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_a_track_makes_a_row),
        TEST(test_it_keeps_row_and_id),
        TEST(test_more_than_allowed_are_refused),
        TEST(test_bad_tracks_are_refused),
        TEST(test_a_jump_is_refused),
        TEST(test_an_owner_has_no_effect),
        TEST(test_nobody_drives_them),
        TEST(test_commands_and_records_keep_their_order),
        TEST(test_a_shot_alarms_its_target),
        TEST(test_a_hit_harms_by_our_rules),
        TEST(test_a_slow_round_strikes_whom_it_names),
        TEST(test_a_round_beside_the_hull_strikes_whom_it_names),
        TEST(test_a_shell_digs_a_crater),
        TEST(test_a_burst_in_the_air),
        TEST(test_a_far_round_pierces_less),
        TEST(test_a_body_strikes),
        TEST(test_a_munition_flies),
        TEST(test_a_marking_is_its_name),
        TEST(test_a_frame_without_room_waits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
