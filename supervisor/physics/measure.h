/* The measures by which a replay is judged (docs/collisions.md, "Bounds"): for each its bound, and
 * the worst value of the run with its place and time. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_MEASURE_H
#define JOLON_SUPERVISOR_PHYSICS_MEASURE_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

#define NO_BOUND HUGE_VAL /* the measure is only reported */

/* X(NAME, word, unit, bound, meaning). Users' programs read the words: add rows, and
 * rename none. */
#define MEASURES(X)                                                                                \
    X(NOT_FINITE, not_finite, "numbers", 0.0, "not finite: position, velocity, pose or spin")      \
    X(OUTSIDE, outside, "m", 0.0, "beyond the edge of the world")                                  \
    X(HEIGHT, height, "m", 1e-6, "off the ground or the water: active land vehicles, ships")       \
    X(WRECK_HEIGHT, wreck_height, "m", 0.05, "lowest corner off the ground: wrecks at rest")       \
    X(UNDERGROUND, underground, "m", 1.5, "corner of a hull under the ground, ships excepted")     \
    X(SHELL_UNDERGROUND, shell_underground, "m", 0.02, "corner of the shell of a sprung vehicle")  \
    X(WRECK_UNDERGROUND, wreck_underground, "m", 0.5, "the same of wrecks, where it has grown")    \
    X(OVERLAP, overlap, "m", 1e-3, "two bodies that were apart before")                            \
    X(WALL_OVERLAP, wall_overlap, "m", 1e-3, "a body and a wall that were apart before")           \
    X(START_OVERLAP, start_overlap, "m", NO_BOUND, "bodies that have overlapped since the start")  \
    X(OVERLAP_GROWTH, overlap_growth, "m", 2e-5, "growth of an overlap in a frame")                \
    X(OVERLAPPING, overlapping, "pairs", NO_BOUND, "overlapping pairs in one frame")               \
    X(ENERGY, energy, "J/kg", 0.01, "energy that nothing gave, of bodies that touch")              \
    X(SPRUNG_ENERGY, sprung_energy, "J/kg", 2.0, "energy beyond the engine's: sprung vehicles")    \
    X(FLOATING, floating, "m/s2", 0.5, "acceleration beyond weight: sprung vehicles in the air")   \
    X(ACCELERATION, acceleration, "m/s2", 50.0, "without collision, explosion or command")         \
    X(SPEED, speed, "top speeds", 2.0, "speed on the map over the kind's top speed")               \
    X(SPIN, spin, "rad/s", 20.0, "spin by collisions")                                             \
    X(JUMP, jump, "m", 0.01, "way of a frame beyond its speed")                                    \
    X(SNAP, snap, "rad", 0.2, "rotation of a frame beyond its spin and steering: aircraft, wrecks")

/* clang-format off */
enum measure_kind {
#define X(name, word, unit, bound, meaning) MEASURE_OF_##name,
    MEASURES(X)
#undef X
    MEASURE_KINDS
};
/* clang-format on */

/* A body that a measure names. */
struct measured_body {
    uint32_t id; /* of an entity, or the number of a fixed object from 1 on; 0: none */
    bool fixed;
    uint16_t kind;
    struct vec3 at; /* [m, world] */
};

/* The worst value of one measure. */
struct measure {
    double worst;    /* meaningless while the measure was never taken */
    uint64_t frame;  /* of the worst value */
    double time_s;   /* the same, in simulated time */
    uint64_t taken;  /* how often the measure was taken */
    uint64_t beyond; /* how often it was beyond its bound */
    struct measured_body body[2];
    bool unbound; /* the scenario promises no bound: the value is only reported */
};

struct measures {
    struct measure of[MEASURE_KINDS];
    uint64_t frame; /* of the values that are being taken */
    double time_s;
};

const char *measure_word(enum measure_kind kind);
const char *measure_unit(enum measure_kind kind);
const char *measure_meaning(enum measure_kind kind);

/* Returns the bound of a measure, or NO_BOUND. */
double measure_bound(const struct measures *measures, enum measure_kind kind);

/* Takes a value. A NaN counts as infinite. b may be NULL. */
void measure_take(struct measures *measures, enum measure_kind kind, double value,
                  const struct measured_body *a, const struct measured_body *b);

/* Returns true if no value of the measure, or of any measure, was beyond its bound. */
bool measure_good(const struct measures *measures, enum measure_kind kind);
bool measures_good(const struct measures *measures);

#endif
