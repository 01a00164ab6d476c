/* Counts how a battle goes: shots in every three minutes, at what they went, who was lost, and how
 * long vehicles pushed against something. */
#include "tests/bench/bench.h"
#include "tests/bench/world.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/frame_stepper.h"
#include "world/entity/kind.h"
#include "world/world.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PERIOD_S      180.0
#define PERIODS       32u
#define PUSHES_LEAST  0.15 /* of the full throttle */
#define PUSHES_MPS    0.3  /* slower than this it does not get on */
#define PUSHES_LONG_S 10.0

struct battle {
    uint64_t shots[PERIODS];
    uint64_t rounds[KIND_COUNT_MAX][DOMAIN_COUNT + 1]; /* by the shooter, and the target's domain */
    uint64_t fast[KIND_COUNT_MAX];                     /* of them at aircraft that cannot hover */
    uint32_t first[KIND_COUNT_MAX], lost[KIND_COUNT_MAX];
    uint32_t *stuck, *longest;                          /* frames, by row */
    uint8_t *begun;                                     /* the kind + 1 of a row at frame 0 */
    uint32_t hit[KIND_COUNT_MAX][KIND_COUNT_MAX];       /* by the round, and what it struck */
    uint32_t ended[KIND_COUNT_MAX][KIND_COUNT_MAX + 1]; /* destroyed by it; last: by a collision */
    uint32_t bumps;
};

static bool pushes(const struct view *view, const struct entities *e, uint32_t i)
{
    double speed = sqrt(e->vx[i] * e->vx[i] + e->vz[i] * e->vz[i]);
    return e->state[i] == ENTITY_ACTIVE && e->behaviour[i] != BEHAVIOUR_HOLD &&
           view->world.kinds[e->kind[i]].domain == DOMAIN_LAND &&
           fabs((double)e->throttle[i]) >= PUSHES_LEAST && speed < PUSHES_MPS;
}

static void take_event(const struct view *view, const struct event *event, struct battle *battle,
                       uint32_t period)
{
    const struct kind *kinds = view->world.kinds;
    if (event->type == EVENT_COLLISION) {
        battle->bumps++;
        if (event->collision.response == RESPONSE_DESTROYED &&
            event->collision.a.kind < KIND_COUNT_MAX)
            battle->ended[event->collision.a.kind][KIND_COUNT_MAX]++;
    }
    if (event->type == EVENT_DETONATION && event->detonation.struck == STRUCK_VEHICLE) {
        const struct event_detonation *end = &event->detonation;
        battle->hit[end->munition.kind][end->struck_party.kind]++;
        if (end->struck_party.damage == DAMAGE_DESTROYED)
            battle->ended[end->struck_party.kind][end->munition.kind]++;
    }
    if (event->type != EVENT_FIRE)
        return;
    const struct event_fire *fire = &event->fire;
    bool at = fire->target.id != 0;
    uint32_t domain = at ? kinds[fire->target.kind].domain : DOMAIN_COUNT;
    battle->shots[period < PERIODS ? period : PERIODS - 1]++;
    battle->rounds[fire->shooter.kind][domain]++;
    if (at && kinds[fire->target.kind].min_speed_mps > 0.0)
        battle->fast[fire->shooter.kind]++;
}

static void take(const struct view *view, const struct state *state, uint64_t from,
                 struct battle *battle)
{
    const struct entities *e = &state->entities;
    uint32_t period = (uint32_t)((double)state->head->tick * world_dt_s(&view->world) / PERIOD_S);
    for (uint64_t n = from; n < state->head->event_end; n++)
        take_event(view, &view->events[n & (view->header->event_slots - 1)], battle, period);
    for (uint32_t i = 0; i < state->head->used; i++) {
        battle->stuck[i] = pushes(view, e, i) ? battle->stuck[i] + 1 : 0;
        if (battle->stuck[i] > battle->longest[i])
            battle->longest[i] = battle->stuck[i];
    }
}

static void print_ends(const struct view *view, const struct battle *battle)
{
    const struct kind *kinds = view->world.kinds;
    for (uint32_t k = 0; k < view->world.counts.kinds; k++) {
        for (uint32_t n = 0; n <= KIND_COUNT_MAX && battle->first[k] > 0; n++) {
            if (battle->ended[k][n] > 0)
                printf("%s destroyed by %s: %u of %u hits\n", kinds[k].name,
                       n == KIND_COUNT_MAX ? "collision" : kinds[n].name, battle->ended[k][n],
                       n == KIND_COUNT_MAX ? 0 : battle->hit[n][k]);
        }
    }
}

static void print(const struct view *view, const struct state *state, struct battle *battle,
                  uint32_t frames)
{
    const struct entities *e = &state->entities;
    const struct kind *kinds = view->world.kinds;
    double dt_s = world_dt_s(&view->world);
    uint32_t periods = (uint32_t)ceil((double)frames * dt_s / PERIOD_S), pushed = 0, most = 0;
    printf("shots in every three minutes:");
    for (uint32_t n = 0; n < periods && n < PERIODS; n++)
        printf(" %llu", (unsigned long long)battle->shots[n]);
    printf("\nkind: lost of number; rounds at land, sea, air (jets), ground\n");
    for (uint32_t i = 0; i < state->head->used; i++) {
        if (battle->begun[i] && (e->state[i] != ENTITY_ACTIVE || e->id[i] != i + 1))
            battle->lost[battle->begun[i] - 1]++;
        pushed += battle->longest[i] * dt_s > PUSHES_LONG_S;
        most = battle->longest[i] > most ? battle->longest[i] : most;
    }
    for (uint32_t k = 0; k < view->world.counts.kinds; k++) {
        if (battle->first[k] > 0)
            printf("%s: %u of %u; %llu %llu %llu (%llu) %llu\n", kinds[k].name, battle->lost[k],
                   battle->first[k], (unsigned long long)battle->rounds[k][DOMAIN_LAND],
                   (unsigned long long)battle->rounds[k][DOMAIN_SEA],
                   (unsigned long long)battle->rounds[k][DOMAIN_AIR],
                   (unsigned long long)battle->fast[k],
                   (unsigned long long)battle->rounds[k][DOMAIN_COUNT]);
    }
    print_ends(view, battle);
    printf("%u vehicles pushed for more than %g s, one for %.1f s; %u collisions\n", pushed,
           PUSHES_LONG_S, most * dt_s, battle->bumps);
}

static void begin(const struct view *view, struct battle *battle)
{
    const struct state *state = &view->w[0];
    uint32_t capacity = state->entities.capacity;
    *battle = (struct battle){.stuck = calloc(capacity, sizeof(uint32_t)),
                              .longest = calloc(capacity, sizeof(uint32_t)),
                              .begun = calloc(capacity, 1)};
    if (!battle->stuck || !battle->longest || !battle->begun)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < state->head->used; i++) {
        battle->begun[i] = (uint8_t)(state->entities.kind[i] + 1);
        battle->first[state->entities.kind[i]]++;
    }
}

int bench_battle(struct bench_options options)
{
    struct view view;
    struct frame_stepper stepper;
    struct battle battle;
    bench_world_open(&view, options.file, BENCH_SCENARIO_VEHICLES);
    begin(&view, &battle);
    if (frame_stepper_init(&stepper, &view, options.threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < options.frames; i++) {
        uint64_t from = view.w[i & 1].head->event_end;
        frame_stepper_step(&stepper, NULL);
        take(&view, &view.w[(i + 1) & 1], from, &battle);
    }
    frame_stepper_free(&stepper);
    print(&view, &view.w[options.frames & 1], &battle, options.frames);
    free(battle.stuck);
    free(battle.longest);
    free(battle.begun);
    segment_abandon(&view);
    return EXIT_OK;
}
