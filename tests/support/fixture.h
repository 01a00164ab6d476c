/* A small world in private memory and the steps that compute its frames. Tests of world/, ipc/,
 * mover/ and collider/ share it.
 *
 *     struct fixture f;
 *     fixture_open(&f, "");
 *     uint32_t tank = fixture_put(&f, (struct fixture_entity){
 *         .kind = "tank", .at = {25000.0, 100.0, 25000.0}, .velocity = {10.0, 0.0, 0.0}});
 *     fixture_run(&f, 60);
 *     assert_true(fixture_state(&f).entities.x[tank] > 25009.0);
 *     fixture_close(&f);
 *
 * A failure in here fails the calling cmocka test. */
#ifndef JOLON_TESTS_SUPPORT_FIXTURE_H
#define JOLON_TESTS_SUPPORT_FIXTURE_H

#include "ipc/segment/segment.h"
#include "recorder/replay/frame_stepper.h"

#include <stdint.h>

#define FIXTURE_GROUND_M 100.0 /* height of the default scenario's level ground */

struct fixture {
    struct scenario *scenario;
    struct world_build *built;
    struct view view; /* private; mapped shared, so that forked children see it */
    struct frame_stepper stepper;
};

/* --- scenarios and worlds ----------------------------------------------------------------------*/

/* Returns a data folder with all shipped kinds. They share one small model, because reading all
 * models takes longer than a test. The folder is made at the first call and removed at exit. */
const char *fixture_data_dir(void);

/* Returns the shipped config/: JOLON_DATA, or a folder above the test's program. */
const char *fixture_shipped_dir(void);

/* Reads a scenario from text. Groups that the text does not mention are set so that tests are fast:
 *     world = { seed = 1; capacity = 64; cruise = false; };
 *     terrain = { source = "flat"; height_m = 100.0; spacing_m = 125.0; };   (so no objects)
 *     collision = { shape = "sphere"; };   (every kind has one small model: fixture_data_dir())
 * With shape = "model" in the text, the kinds are the shipped ones with their own models. */
void fixture_scenario(struct scenario *scenario, const char *text);

/* Makes a scenario's world at frame 0 in a private view, with a mover and a collider on one thread.
 */
void fixture_open(struct fixture *fixture, const char *text);
void fixture_close(struct fixture *fixture);

/* Tear-down for cmocka: closes the fixture that *state points to, which is the last argument of
 * cmocka_unit_test_prestate_setup_teardown(). */
int fixture_teardown(void **state);

/* Makes mover and collider again on this many threads, as a restart of both processes does. */
void fixture_threads(struct fixture *fixture, uint32_t threads);

/* --- entities ----------------------------------------------------------------------------------*/

struct fixture_entity {
    const char *kind;     /* required */
    struct vec3 at;       /* [m, world] */
    struct vec3 velocity; /* [m/s]; gives the heading unless it is vertical */
    double heading_rad;   /* heading of an entity without such a velocity */
    enum force force;
    enum behaviour behaviour;      /* 0: BEHAVIOUR_HOLD; BEHAVIOUR_FLIGHT for munitions */
    uint32_t owner_slot, owner_id; /* munitions */
};

/* Adds a row to the committed frame and returns it. Its id is row + 1. Fuel, rounds and a
 * munition's lifetime come from the kind. */
uint32_t fixture_put(struct fixture *fixture, struct fixture_entity entity);

/* Returns the index of the kind of this name. */
uint16_t fixture_kind(const struct fixture *fixture, const char *name);

/* --- frames ------------------------------------------------------------------------------------*/

/* Computes and commits this many frames with mover_step and collider_step, and checks each frame's
 * checksums against its rows. The test may have written to the tables before. */
void fixture_run(struct fixture *fixture, uint32_t frames);

/* Does the same as two running processes do: nothing else has written to the tables since the last
 * frame, so that unchanged rows are not copied. */
void fixture_continue(struct fixture *fixture, uint32_t frames);

/* Tells mover and collider that the test has written to the tables, so that they rely on no earlier
 * copy. */
void fixture_forget_copies(struct fixture *fixture);

/* Returns the buffer of the committed frame. */
struct state fixture_state(const struct fixture *fixture);

/* Returns the digest of the committed frame. */
uint64_t fixture_digest(const struct fixture *fixture);

/* Returns how many committed events of a type the ring still holds. EVENT_NONE counts all types. */
uint32_t fixture_event_count(const struct fixture *fixture, enum event_type type);

/* Returns the nth of these events, from 0, or NULL when there are fewer. */
const struct event *fixture_event(const struct fixture *fixture, enum event_type type,
                                  uint32_t nth);

/* --- random tests ------------------------------------------------------------------------------*/

/* Returns the seed of a property test: the environment's SEED, otherwise fallback. Prints it, so
 * that the test can be repeated. */
uint64_t fixture_seed(uint64_t fallback);

/* Random numbers for tests: splitmix64. */
uint64_t fixture_random(uint64_t *state);
double fixture_uniform(uint64_t *state, double low, double high);

/* Returns a unit vector. All directions are equally likely. */
struct vec3 fixture_direction(uint64_t *state);

/* Draws heights from -50 m to 1500 m and covers of all kinds for count posts. */
void fixture_roughen(float *posts, uint8_t *cover, uint32_t count, uint64_t *state);

#endif
