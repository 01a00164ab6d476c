/* Reads the events and the rows of each frame. */
#include "tests/bench/agents/battle_count.h"

#include "world/world.h"

#include <stdlib.h>

#define PUSHES_LEAST 0.15 /* of the full throttle */
#define PUSHES_MPS   0.3  /* slower than this it does not get on */
#define MOVING_MPS   1.0  /* slower than this a gun fires as one that stands */

bool battle_count_begin(struct battle_count *count, const struct view *view)
{
    const struct state *state = &view->w[0];
    const struct entities *e = &state->entities;
    *count = (struct battle_count){.dt_s = world_dt_s(&view->world),
                                   .stuck = calloc(e->capacity, sizeof(uint32_t)),
                                   .longest = calloc(e->capacity, sizeof(uint32_t)),
                                   .kind = calloc(e->capacity, 1),
                                   .force = calloc(e->capacity, 1),
                                   .gone = calloc(e->capacity, 1),
                                   .vehicles = state->head->used};
    if (!count->stuck || !count->longest || !count->kind || !count->force || !count->gone)
        return false;
    for (uint32_t i = 0; i < count->vehicles; i++) {
        count->kind[i] = (uint8_t)e->row[i].kind;
        count->force[i] = e->row[i].force % FORCE_COUNT;
        count->first[count->force[i]][count->kind[i]]++;
    }
    return true;
}

void battle_count_free(struct battle_count *count)
{
    free(count->stuck);
    free(count->longest);
    free(count->kind);
    free(count->force);
    free(count->gone);
}

static uint32_t minute_of(const struct battle_count *count, uint64_t tick)
{
    uint32_t minute = (uint32_t)((double)tick * count->dt_s / 60.0);
    return minute < BATTLE_MINUTES ? minute : BATTLE_MINUTES - 1;
}

uint32_t battle_count_sum(const uint32_t by_minute[BATTLE_MINUTES], uint32_t first,
                          uint32_t minutes)
{
    uint32_t sum = 0;
    for (uint32_t n = first; n < first + minutes && n < BATTLE_MINUTES; n++)
        sum += by_minute[n];
    return sum;
}

/* A vehicle of the scenario that the event's party is, and that was no wreck before. */
static bool was_active(const struct battle_count *count, const struct state *before,
                       const struct event_party *party)
{
    uint32_t row = party->id - 1;
    return party->id != 0 && !party->fixed && row < count->vehicles &&
           before->entities.row[row].id == party->id &&
           before->entities.row[row].state == ENTITY_ACTIVE;
}

/* Returns how accurate the shooter of a round is. */
static enum battle_shooter shooter_of(const struct view *view, const struct state *before,
                                      const struct event_fire *fire)
{
    const struct kind *round = &view->world.kinds[fire->munition.kind];
    uint32_t row = fire->shooter.id - 1;
    bool differs = round->dispersion_moving_rad > round->dispersion_rad;
    return fire->shooter.id != 0 && differs && row < before->entities.capacity &&
                   vec3_length(entities_velocity(&before->entities, row)) > MOVING_MPS
               ? BATTLE_MOVING
               : BATTLE_HALTED;
}

static void take_fire(struct battle_count *count, const struct view *view,
                      const struct state *before, const struct event *event)
{
    const struct event_fire *fire = &event->fire;
    uint16_t target = fire->target.id != 0 ? fire->target.kind : BATTLE_GROUND;
    enum battle_shooter shooter = shooter_of(view, before, fire);
    count->shots[minute_of(count, event->tick)]++;
    count->by[fire->munition.kind][target][shooter].fired++;
    count->flying[fire->munition.id % BATTLE_FLYING] =
        (struct battle_round){fire->munition.id, fire->target.id, target, (uint8_t)shooter};
    if (fire->shooter.id != 0)
        count->rounds[fire->shooter.kind][target]++;
}

static void take_detonation(struct battle_count *count, const struct state *before,
                            const struct event *event)
{
    const struct event_detonation *end = &event->detonation;
    const struct battle_round *round = &count->flying[end->munition.id % BATTLE_FLYING];
    if (round->id != end->munition.id)
        return;
    struct battle_tally *tally = &count->by[end->munition.kind][round->target_kind][round->shooter];
    struct event_party target = {.id = round->target};
    bool struck = end->struck == STRUCK_VEHICLE && was_active(count, before, &end->struck_party);
    bool own = struck && end->struck_party.id == round->target;
    tally->hits += own;
    tally->others += struck && !own;
    tally->late += !struck && round->target != 0 && !was_active(count, before, &target);
    tally->ended += struck && end->struck_party.damage == DAMAGE_DESTROYED;
}

/* Counts a pair of aircraft that touches. */
static void take_meeting(struct battle_count *count, const struct view *view,
                         const struct state *before, const struct event *event)
{
    const struct kind *kinds = view->world.kinds;
    const struct event_collision *hit = &event->collision;
    if (!hit->begins || !was_active(count, before, &hit->a) ||
        !was_active(count, before, &hit->b) || kinds[hit->a.kind].domain != DOMAIN_AIR ||
        kinds[hit->b.kind].domain != DOMAIN_AIR)
        return;
    if (count->force[hit->a.id - 1] != count->force[hit->b.id - 1]) {
        count->met_others++;
        return;
    }
    if (count->met_friends < BATTLE_MET_MAX)
        count->met[count->met_friends] = *event;
    count->met_friends++;
}

static void take_collision(struct battle_count *count, const struct view *view,
                           const struct state *before, const struct event *event)
{
    const struct event_party *parties[2] = {&event->collision.a, &event->collision.b};
    count->bumps++;
    take_meeting(count, view, before, event);
    for (int n = 0; n < 2; n++)
        count->crashes +=
            parties[n]->damage == DAMAGE_DESTROYED && was_active(count, before, parties[n]);
}

static void take_event(struct battle_count *count, const struct view *view,
                       const struct state *before, const struct event *event)
{
    if (event->type == EVENT_FIRE)
        take_fire(count, view, before, event);
    if (event->type == EVENT_DETONATION)
        take_detonation(count, before, event);
    if (event->type == EVENT_COLLISION)
        take_collision(count, view, before, event);
    if (event->type == EVENT_MISSION && count->news_count < BATTLE_NEWS_MAX)
        count->news[count->news_count++] = *event;
}

static bool pushes(const struct view *view, const struct entities *e, uint32_t i)
{
    double speed = sqrt(e->row[i].vx * e->row[i].vx + e->row[i].vz * e->row[i].vz);
    return e->row[i].state == ENTITY_ACTIVE && e->row[i].behaviour != BEHAVIOUR_HOLD &&
           view->world.kinds[e->row[i].kind].domain == DOMAIN_LAND &&
           fabs((double)e->row[i].throttle) >= PUSHES_LEAST && speed < PUSHES_MPS;
}

static void take_row(struct battle_count *count, const struct view *view, const struct state *state,
                     uint32_t i)
{
    const struct entities *e = &state->entities;
    count->stuck[i] = pushes(view, e, i) ? count->stuck[i] + 1 : 0;
    if (count->stuck[i] > count->longest[i])
        count->longest[i] = count->stuck[i];
    if (i >= count->vehicles || count->gone[i] ||
        (e->row[i].state == ENTITY_ACTIVE && e->row[i].id == i + 1))
        return;
    count->gone[i] = 1;
    count->losses[minute_of(count, state->head->tick)]++;
    count->lost[count->force[i]][count->kind[i]]++;
}

void battle_count_frame(struct battle_count *count, const struct view *view,
                        const struct state *before, const struct state *state, uint64_t from)
{
    for (uint64_t n = from; n < state->head->event_end; n++)
        take_event(count, view, before, &view->events[n & (view->header->event_slots - 1)]);
    for (uint32_t i = 0; i < state->head->used; i++)
        take_row(count, view, state, i);
}
