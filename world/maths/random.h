/* Random numbers as a function of (seed, frame, entity, purpose): they have no state and no order
 * of calls. A frame that is computed again, or by more threads, draws the same numbers. Pure; any
 * thread. */
#ifndef JOLON_WORLD_MATHS_RANDOM_H
#define JOLON_WORLD_MATHS_RANDOM_H

#include <stdint.h>

/* Each use of a number has its own purpose, so that two uses never draw the same number. */
enum random_purpose {
    RANDOM_PLACE_X = 1, /* creation: where a vehicle of a group starts */
    RANDOM_PLACE_Z,
    RANDOM_HEADING,
    RANDOM_GOAL_X, /* mover: the next patrol goal */
    RANDOM_GOAL_Z,
    RANDOM_DISPERSION_AZIMUTH, /* mover: a round's error */
    RANDOM_DISPERSION_ELEVATION,
    RANDOM_COURAGE,  /* mover: return fire or flee */
    RANDOM_NOISE,    /* creation: terrain */
    RANDOM_FOREST,   /* creation: where trees cluster */
    RANDOM_OBJECT_X, /* creation: a fixed object's place in its square */
    RANDOM_OBJECT_Z,
    RANDOM_OBJECT_SHAPE,
    RANDOM_SQUARE_SIZE,   /* creation: how many objects an occupied square holds */
    RANDOM_MISSION_RANGE, /* where a round of a fire mission falls */
    RANDOM_MISSION_AZIMUTH,
    RANDOM_ROUND_RANGE, /* mover: the error of a round on an arc */
    RANDOM_ROUND_AZIMUTH,
    RANDOM_MEAN_RANGE, /* mover: the error that all rounds of a fire mission share */
    RANDOM_MEAN_AZIMUTH,
    RANDOM_SURVEY_RANGE, /* mover: how well the place of a target is known */
    RANDOM_SURVEY_AZIMUTH,
    RANDOM_PENETRATION, /* collider: whether armour is penetrated, and with what effect */
    RANDOM_PENETRATED,
    RANDOM_REACTION,   /* mover: how soon a crew fires at a new target */
    RANDOM_FAILURE,    /* mover: does something in a missile fail, and when */
    RANDOM_DECOY,      /* and does a decoy take its seeker */
    RANDOM_SEARCH,     /* mover: whether a crew finds an enemy in its view */
    RANDOM_SUPPRESSED, /* mover: for how long a burst keeps a crew from firing */
    RANDOM_STUCK,      /* mover: where a vehicle turns that does not get on */
    RANDOM_GIVES_UP,   /* mover: whether such a vehicle gives up */
};

/* splitmix64's finaliser (Steele, Lea & Flood 2014). */
static inline uint64_t random_mix(uint64_t v)
{
    v ^= v >> 30;
    v *= 0xbf58476d1ce4e5b9u;
    v ^= v >> 27;
    v *= 0x94d049bb133111ebu;
    v ^= v >> 31;
    return v;
}

static inline uint64_t random_u64(uint64_t seed, uint64_t frame, uint64_t entity,
                                  enum random_purpose purpose)
{
    uint64_t v = random_mix(seed + 0x9e3779b97f4a7c15u);
    v = random_mix(v ^ (frame + 0x9e3779b97f4a7c15u));
    v = random_mix(v ^ (entity + 0x3c6ef372fe94f82bu));
    return random_mix(v ^ ((uint64_t)purpose * 0xdaa66d2c7ddf743fu));
}

/* Uniform in [0, 1), 53 bits. */
static inline double random_unit(uint64_t seed, uint64_t frame, uint64_t entity,
                                 enum random_purpose purpose)
{
    return (double)(random_u64(seed, frame, entity, purpose) >> 11) * 0x1.0p-53;
}

/* Uniform in [low, high); rounding may give high itself. */
static inline double random_between(uint64_t seed, uint64_t frame, uint64_t entity,
                                    enum random_purpose purpose, double low, double high)
{
    return low + (high - low) * random_unit(seed, frame, entity, purpose);
}

#endif
