/* Counts what happens in a battle. One thread. */
#ifndef JOLON_TESTS_BENCH_AGENTS_BATTLE_COUNT_H
#define JOLON_TESTS_BENCH_AGENTS_BATTLE_COUNT_H

#include "ipc/segment/segment.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"

#include <stdint.h>

#define BATTLE_MINUTES  96u /* later ones count to the last */
#define BATTLE_NEWS_MAX 512u
#define BATTLE_MET_MAX  16u
#define BATTLE_FLYING   4096u          /* rounds of vehicles in the air at a time, at most */
#define BATTLE_GROUND   KIND_COUNT_MAX /* as a target: a point, or the sky */

/* What became of the rounds of a munition that were fired at vehicles of a kind. A round is late if
 * its target was lost or gone before it arrived, and it struck no other vehicle. */
struct battle_tally {
    uint32_t fired, late, hits, others; /* hits: on the target itself; others: on other vehicles */
    uint32_t ended;                     /* vehicles destroyed by either */
};

/* Who fired. Guns that are less accurate on the move have rows of their own in the report. */
enum battle_shooter { BATTLE_HALTED, BATTLE_MOVING, BATTLE_SHOOTERS };

struct battle_round {
    uint32_t id, target; /* entity ids; 0: none */
    uint16_t target_kind;
    uint8_t shooter; /* enum battle_shooter */
};

struct battle_count {
    double dt_s;
    uint32_t shots[BATTLE_MINUTES];
    uint32_t losses[BATTLE_MINUTES]; /* vehicles of the scenario */
    /* By munition, then target, then shooter. */
    struct battle_tally by[KIND_COUNT_MAX][KIND_COUNT_MAX + 1][BATTLE_SHOOTERS];
    struct battle_round flying[BATTLE_FLYING];           /* by the last bits of the id */
    uint32_t rounds[KIND_COUNT_MAX][KIND_COUNT_MAX + 1]; /* by shooter, then target */
    uint32_t first[FORCE_COUNT][KIND_COUNT_MAX];         /* vehicles at the beginning ... */
    uint32_t lost[FORCE_COUNT][KIND_COUNT_MAX];          /* ... and how many are wrecks */
    uint32_t bumps, crashes;                             /* collisions; ending a vehicle */
    uint32_t met_friends, met_others; /* pairs of aircraft that touched: of one force; others */
    struct event met[BATTLE_MET_MAX]; /* the first collisions of those of one force */
    uint32_t *stuck, *longest;        /* frames in which a row pushed, by row; NULL: no memory */
    uint8_t *kind, *force;            /* of the vehicles of the scenario, by row */
    uint8_t *gone;                    /* 1: it is lost */
    uint32_t vehicles, news_count;
    struct event news[BATTLE_NEWS_MAX]; /* of missions */
};

/* Begins to count a world at frame 0. Returns false if there is no memory. */
bool battle_count_begin(struct battle_count *count, const struct view *view);

/* Takes a frame: its state, the one before it, and its events, of which the first has this number.
 */
void battle_count_frame(struct battle_count *count, const struct view *view,
                        const struct state *before, const struct state *state, uint64_t from);

/* Sums `minutes` minutes of a count, of which the first has this number. */
uint32_t battle_count_sum(const uint32_t by_minute[BATTLE_MINUTES], uint32_t first,
                          uint32_t minutes);

void battle_count_free(struct battle_count *count);

#endif
