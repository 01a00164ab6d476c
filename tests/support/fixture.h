/* A small world in private memory, and the steps run on it: what tests of world/, ipc/, mover/ and
 * collider/ share.
 *
 *     struct fixture f;
 *     fixture_open(&f, "");
 *     uint32_t tank = fixture_put(&f, (struct fixture_entity){
 *         .kind = "tank", .at = {25000.0, 100.0, 25000.0}, .velocity = {10.0, 0.0, 0.0}});
 *     fixture_run(&f, 60);
 *     assert_true(fixture_state(&f).entities.x[tank] > 25009.0);
 *     fixture_close(&f);
 *
 * Whatever fails in here fails the cmocka test that called it. */
#ifndef JOLON_TESTS_SUPPORT_FIXTURE_H
#define JOLON_TESTS_SUPPORT_FIXTURE_H

#include "ipc/segment/segment.h"
#include "recorder/replay/frame_stepper.h"

#include <stdint.h>

#define FIXTURE_GROUND_M 100.0 /* height of the default scenario's level ground */

struct fixture {
    struct scenario *scenario;
    struct world_build *built;
    struct view view; /* private; mapped shared, so that children of fork see it */
    struct frame_stepper stepper;
};

/* --- scenarios and worlds ----------------------------------------------------------------------*/

/* A data folder with every shipped kind, all of one small shape, because reading every model takes
 * longer than all the rest. Made at the first call, removed at exit. */
const char *fixture_data_dir(void);

/* The shipped config/: JOLON_DATA, or in a folder above the test's program. */
const char *fixture_shipped_dir(void);

/* Reads a scenario from text. Groups that the text does not mention are, to be fast,
 *     world = { seed = 1; capacity = 64; };
 *     terrain = { source = "flat"; height_m = 100.0; spacing_m = 125.0; };   (so no objects)
 *     collision = { shape = "sphere"; };   (every kind has one small model: fixture_data_dir())
 * Where the text says shape = "model" the kinds are the shipped ones with their own models. */
void fixture_scenario(struct scenario *scenario, const char *text);

/* A scenario's world at frame 0 in a private view, with a mover and a collider on one thread. */
void fixture_open(struct fixture *fixture, const char *text);
void fixture_close(struct fixture *fixture);

/* Makes mover and collider anew, on this many threads: what a restart of both processes does. */
void fixture_threads(struct fixture *fixture, uint32_t threads);

/* --- entities ----------------------------------------------------------------------------------*/

struct fixture_entity {
    const char *kind;     /* needed */
    struct vec3 at;       /* [m, world] */
    struct vec3 velocity; /* [m/s]; where it is not vertical it gives the heading too */
    double heading_rad;   /* of one at rest */
    enum force force;
    enum behaviour behaviour;      /* 0: BEHAVIOUR_HOLD, of munitions BEHAVIOUR_FLIGHT */
    uint32_t owner_slot, owner_id; /* munitions */
};

/* Adds a row to the committed frame and returns it; its id is row + 1. Fuel, rounds and a
 * munition's life come from the kind. */
uint32_t fixture_put(struct fixture *fixture, struct fixture_entity entity);

/* Index of the kind called name. */
uint16_t fixture_kind(const struct fixture *fixture, const char *name);

/* --- frames ------------------------------------------------------------------------------------*/

/* Runs mover_step and collider_step and commits, this many times. Each frame's checksums must be
 * those of its rows. The tables may have been written to by hand before. */
void fixture_run(struct fixture *fixture, uint32_t frames);

/* The same as the two processes go on: nobody else has written to the tables since the last frame.
 * Rows that do not differ are then not copied. */
void fixture_go_on(struct fixture *fixture, uint32_t frames);

/* The tables were written to by hand: what the steps know of them is nothing. */
void fixture_written(struct fixture *fixture);

/* The committed frame's buffer. */
struct state fixture_state(const struct fixture *fixture);

/* state_digest() of the committed frame. */
uint64_t fixture_digest(const struct fixture *fixture);

/* Committed events of a type (EVENT_NONE: of any) that the ring still holds. */
uint32_t fixture_event_count(const struct fixture *fixture, enum event_type type);

/* The nth of them, from 0; NULL when there are fewer. */
const struct event *fixture_event(const struct fixture *fixture, enum event_type type,
                                  uint32_t nth);

/* --- random tests ------------------------------------------------------------------------------*/

/* The seed of a property test: the environment's SEED, else fallback. Printed, to run it again. */
uint64_t fixture_seed(uint64_t fallback);

/* A stream of numbers for tests: splitmix64 from the state on. */
uint64_t fixture_random(uint64_t *state);
double fixture_uniform(uint64_t *state, double low, double high);

#endif
