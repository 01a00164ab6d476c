/* Remote entities between two records: every model of dead reckoning frame by frame against its
 * formula, smoothing, clamping, and the end of an owner's silence. */
#include "mover/motion/remote_motion.h"

#include "tests/support/remotes.h"
#include "world/maths/rotation.h"
#include "world/params.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define REMOTE remote_id(7, 1, 9)

static struct fixture f;
static const struct vec3 start = {25000.0, 600.0, 25000.0};

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; remotes_max = 4; }; vehicles = ();");
    return 0;
}

static struct vec3 place(void)
{
    const struct state now = fixture_state(&f);
    return entities_position(&now.entities, remotes_row(&f, REMOTE));
}

static struct remote_record moving(unsigned model)
{
    struct remote_record record = remotes_track(&f, REMOTE, start);
    record.kind = fixture_kind(&f, "jet");
    record.model = (uint8_t)model;
    vec3_to_floats(record.velocity, (struct vec3){40.0, 3.0, -25.0});
    vec3_to_floats(record.acceleration, (struct vec3){1.5, -0.5, 2.0});
    vec3_to_floats(record.rates, (struct vec3){0.1, -0.4, 0.2});
    vec3_to_floats(record.attitude, (struct vec3){0.5, 0.25, -0.125});
    return record;
}

/* Returns the formula's state for a record: the axes of the body are those of the world. */
static struct dead_reckoning formula_of(const struct remote_record *record)
{
    const float *v = record->velocity, *a = record->acceleration, *w = record->rates;
    return (struct dead_reckoning){.model = record->model,
                                   .position = start,
                                   .velocity = {(double)v[0], (double)v[1], (double)v[2]},
                                   .acceleration = {(double)a[0], (double)a[1], (double)a[2]},
                                   .rates = {(double)w[0], (double)w[1], (double)w[2]},
                                   .matrix = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}}};
}

static void test_every_model_is_its_formula(void **state)
{
    (void)state;
    for (unsigned model = DEAD_RECKONING_STATIC; model <= DEAD_RECKONING_FVB; model++) {
        struct remote_record record = moving(model);
        struct dead_reckoning formula = formula_of(&record);
        struct vec3 at;
        struct mat3 since;
        remotes_send(&f, record);
        fixture_run(&f, 1); /* it is there, and moves from the next frame on */
        fixture_run(&f, 240);
        dead_reckoning_at(&formula, 4.0, &at, &since);
        const struct state now = fixture_state(&f);
        const struct entities *e = &now.entities;
        uint32_t row = remotes_row(&f, REMOTE);
        struct mat3 first = rotation_matrix(rotation_of(0.5, 0.25, -0.125));
        struct mat3 turn =
            rotation_matrix(rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll));
        struct mat3 expected = rotation_both(&since, &first);
        if (vec3_length(vec3_sub(place(), at)) > 1e-3)
            fail_msg("model %u: off by %g m", model, vec3_length(vec3_sub(place(), at)));
        for (int i = 0; i < 9; i++)
            assert_true(fabs(turn.m[i / 3][i % 3] - expected.m[i / 3][i % 3]) < 1e-6);
        remotes_send(
            &f, (struct remote_record){.remote = REMOTE, .type = REMOTE_LOST, .slot = SLOT_NONE});
        fixture_run(&f, 1);
        assert_int_equal(remotes_row(&f, REMOTE), SLOT_NONE);
    }
}

static void test_an_error_vanishes_smoothly(void **state)
{
    struct remote_record record = moving(DEAD_RECKONING_FPW);
    (void)state;
    remotes_send(&f, record);
    fixture_run(&f, 1);
    record.slot = remotes_row(&f, REMOTE);
    record.position[0] += 3.0; /* its owner has it elsewhere */
    record.position[1] -= 1.0;
    record.attitude[0] += 0.25f;
    remotes_send(&f, record);
    double most = 0.0;
    for (int i = 0; i < 15; i++) {
        struct vec3 before = place();
        fixture_run(&f, 1);
        struct vec3 step = vec3_sub(place(), before);
        most = maths_max(most, vec3_length(vec3_sub(
                                   step, (struct vec3){40.0 / 60.0, 3.0 / 60.0, -25.0 / 60.0})));
    }
    assert_true(most < 1.01 * sqrt(10.0) / 15.0); /* no frame takes more than its share */
    struct vec3 at = place();
    const struct state now = fixture_state(&f);
    const struct entities *e = &now.entities;
    assert_true(fabs(at.x - (start.x + 3.0 + 40.0 * 0.25)) < 1e-4);
    assert_true(fabs(at.y - (start.y - 1.0 + 3.0 * 0.25)) < 1e-4);
    assert_true(fabs(e->row[record.slot].heading - 0.75) < 1e-3);
    fixture_run(&f, 15); /* and the correction has ended */
    assert_true(fabs(place().x - (start.x + 3.0 + 40.0 * 0.5)) < 1e-4);
}

static void test_a_large_error_is_taken_at_once(void **state)
{
    struct remote_record record = remotes_track(&f, REMOTE, start);
    (void)state;
    remotes_send(&f, record);
    fixture_run(&f, 1);
    record.position[2] += 400.0;
    remotes_send(&f, record);
    fixture_run(&f, 1);
    assert_true(fabs(place().z - (start.z + 400.0)) < 1e-9);
}

static void test_land_vehicles_follow_our_ground(void **state)
{
    struct remote_record record =
        remotes_track(&f, REMOTE, (struct vec3){25000.0, FIXTURE_GROUND_M + 20.0, 25000.0});
    (void)state;
    steps_plane(&f, 0.1, 0.0);
    record.flags = REMOTE_FLAG_CLAMPED;
    record.model = DEAD_RECKONING_FPW;
    record.velocity[0] = 10.0f;
    remotes_send(&f, record);
    fixture_run(&f, 61);
    assert_true(fabs(place().x - 25010.0) < 1e-6);
    assert_true(fabs(place().y - (FIXTURE_GROUND_M + 1.0)) < 1e-6);
    record.position[1] = FIXTURE_GROUND_M + 45.0; /* too far from it: perhaps on a bridge */
    remotes_send(&f, record);
    fixture_run(&f, 60);
    assert_true(place().y > FIXTURE_GROUND_M + 40.0);
    record.kind = fixture_kind(&f, "helicopter");
    record.position[1] = FIXTURE_GROUND_M + 12.0;
    remotes_send(&f, record);
    fixture_run(&f, 30);
    assert_true(fabs(place().y - (FIXTURE_GROUND_M + 12.0)) < 0.1);
}

static void test_what_is_silent_stops(void **state)
{
    struct remote_record record = moving(DEAD_RECKONING_RPW);
    (void)state;
    record.velocity[0] = 4.0f;
    remotes_send(&f, record);
    fixture_run(&f, (uint32_t)(REMOTE_TRUST_S * 60.0) + 10);
    struct vec3 at = place();
    fixture_run(&f, 60);
    assert_true(vec3_length(vec3_sub(place(), at)) == 0.0);
    assert_true(at.x > start.x + 119.0);
}

/* Else its owner, who has slowed down meanwhile, would be refused for jumping. */
static void test_what_is_silent_and_fast_stops_sooner(void **state)
{
    struct remote_record record = moving(DEAD_RECKONING_FPW);
    (void)state;
    record.position[0] = 5000.0;
    vec3_to_floats(record.velocity, (struct vec3){600.0, 0.0, 0.0});
    remotes_send(&f, record);
    fixture_run(&f, 20 * 60);
    assert_true(place().x > 5000.0 + 0.99 * REMOTE_TRUST_M);
    assert_true(place().x < 5000.0 + 1.01 * REMOTE_TRUST_M);
    record.position[0] -= 0.49 * REMOTE_JUMP_M;
    remotes_send(&f, record);
    fixture_run(&f, 1);
    assert_true(fabs(place().x - record.position[0]) < 600.0 / 60.0 + 1e-3);
}

static void test_it_leaves_the_world_at_its_edge(void **state)
{
    struct remote_record record = moving(DEAD_RECKONING_FPW);
    (void)state;
    record.position[0] = 49990.0;
    remotes_send(&f, record);
    fixture_run(&f, 30);
    assert_int_equal(remotes_row(&f, REMOTE), SLOT_NONE);
    assert_int_equal(fixture_event(&f, EVENT_AGENT, 0)->agent.because, REASON_LEFT_WORLD);
}

int main(void)
{
#define TEST(test) cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_every_model_is_its_formula),
        TEST(test_an_error_vanishes_smoothly),
        TEST(test_a_large_error_is_taken_at_once),
        TEST(test_land_vehicles_follow_our_ground),
        TEST(test_what_is_silent_stops),
        TEST(test_what_is_silent_and_fast_stops_sooner),
        TEST(test_it_leaves_the_world_at_its_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
