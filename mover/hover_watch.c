/* Finds aircraft that move near those at rest. */
#include "mover/hover_watch.h"

#include "mover/agent/aircraft_separation.h"
#include "world/entity/row_words.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdlib.h>

#define NEAR_M 20.0 /* more than the index rounds */

#define FIND_FRAMES 64u /* from one time that the squares are found to the next */

int hover_watch_init(struct hover_watch *watch, uint32_t words, double side_m)
{
    *watch = (struct hover_watch){.hovers = calloc(words, sizeof *watch->hovers), .side_m = side_m};
    return watch->hovers ? 0 : -1;
}

void hover_watch_free(struct hover_watch *watch)
{
    free(watch->hovers);
    watch->hovers = NULL;
}

static uint32_t axis_of(const struct hover_watch *watch, double metres)
{
    double squares = metres * (HOVER_WATCH_SIDE / watch->side_m);
    if (!(squares > 0.0))
        return 0;
    return squares >= HOVER_WATCH_SIDE ? HOVER_WATCH_SIDE - 1 : (uint32_t)squares;
}

static void mark(struct hover_watch *watch, double x, double z)
{
    uint32_t square = axis_of(watch, z) * HOVER_WATCH_SIDE + axis_of(watch, x);
    atomic_fetch_or_explicit(&watch->squares[square / 64], (uint64_t)1 << square % 64,
                             memory_order_relaxed);
}

void hover_watch_note(struct hover_watch *watch, const struct step_context *context, uint32_t i,
                      bool hovers)
{
    const uint64_t bit = (uint64_t)1 << i % 64;
    if (!hovers) {
        watch->hovers[i / 64] &= ~bit;
        return;
    }
    watch->hovers[i / 64] |= bit;
    mark(watch, context->m->row[i].x, context->m->row[i].z);
}

bool hover_watch_alone(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    const struct neighbour_index_entry *entry;
    double reach_m = aircraft_separation_reach(context, w->row[i].kind, 0.0) + 0.5 * NEAR_M;
    struct neighbour_query query = neighbour_query_begin(
        context->neighbours, NEIGHBOUR_INDEX_LIVING, w->row[i].x, w->row[i].z, reach_m);
    while ((entry = neighbour_query_next(&query)) != NULL) {
        if (entry->row != i && context->world->kinds[entry->kind].domain == DOMAIN_AIR)
            return false;
    }
    return true;
}

/* --- waking ------------------------------------------------------------------------------------*/

static uint32_t words_of(uint32_t used)
{
    return (used + 63) / 64;
}

static bool any_hovers(const struct hover_watch *watch, const uint64_t *resting, uint32_t used)
{
    for (uint32_t w = 0; w < words_of(used); w++) {
        if (watch->hovers[w] & resting[w])
            return true;
    }
    return false;
}

/* Finds the squares again: rows that hover no longer are left out. */
static void find_squares(struct hover_watch *watch, const uint64_t *resting,
                         const struct step_context *context)
{
    const struct entities *w = &context->committed->entities;
    uint32_t words = words_of(context->committed->head->used);
    for (uint32_t s = 0; s < sizeof watch->squares / sizeof watch->squares[0]; s++)
        atomic_store_explicit(&watch->squares[s], 0, memory_order_relaxed);
    for (uint32_t n = 0; n < words; n++) {
        for (uint64_t left = watch->hovers[n] & resting[n]; left != 0; left &= left - 1) {
            uint32_t i = n * 64 + (uint32_t)__builtin_ctzll(left);
            mark(watch, w->row[i].x, w->row[i].z);
        }
    }
}

/* Returns true if a square within reach is marked. */
static bool is_marked(struct hover_watch *watch, double x, double z)
{
    uint32_t x0 = axis_of(watch, x - watch->reach_m), x1 = axis_of(watch, x + watch->reach_m);
    uint32_t z0 = axis_of(watch, z - watch->reach_m), z1 = axis_of(watch, z + watch->reach_m);
    for (uint32_t row = z0; row <= z1; row++) {
        for (uint32_t square = row * HOVER_WATCH_SIDE + x0; square <= row * HOVER_WATCH_SIDE + x1;
             square++) {
            if (atomic_load_explicit(&watch->squares[square / 64], memory_order_relaxed) >>
                    square % 64 &
                1)
                return true;
        }
    }
    return false;
}

static void wake_around(struct hover_watch *watch, uint64_t *resting,
                        const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    const struct neighbour_index_entry *entry;
    if (!is_marked(watch, w->row[i].x, w->row[i].z))
        return;
    struct neighbour_query query = neighbour_query_begin(
        context->neighbours, NEIGHBOUR_INDEX_LIVING, w->row[i].x, w->row[i].z, watch->reach_m);
    while ((entry = neighbour_query_next(&query)) != NULL) {
        const uint64_t bit = (uint64_t)1 << entry->row % 64;
        resting[entry->row / 64] &= ~(watch->hovers[entry->row / 64] & bit);
    }
}

/* The farthest reach of an aircraft that stands, and some more. */
static double reach_of(const struct step_context *context)
{
    double reach_m = 0.0;
    for (uint32_t kind = 0; kind < context->world->counts.kinds && kind < KIND_COUNT_MAX; kind++) {
        if (context->world->kinds[kind].domain == DOMAIN_AIR)
            reach_m = maths_max(reach_m, aircraft_separation_reach(context, kind, 0.0));
    }
    return reach_m + NEAR_M;
}

void hover_watch_wake(struct hover_watch *watch, uint64_t *resting, const uint64_t *cruising,
                      const struct step_context *context)
{
    const struct entities *w = &context->committed->entities;
    uint32_t used = context->committed->head->used;
    if (!any_hovers(watch, resting, used))
        return;
    watch->reach_m = reach_of(context);
    if (watch->frames++ % FIND_FRAMES == 0)
        find_squares(watch, resting, context);
    for (uint32_t n = 0; n < words_of(used); n++) {
        uint64_t there = row_words_below(n, used);
        for (uint64_t left = (~resting[n] | cruising[n]) & there; left != 0; left &= left - 1) {
            uint32_t i = n * 64 + (uint32_t)__builtin_ctzll(left);
            if (w->row[i].state != ENTITY_FREE &&
                context->world->kinds[w->row[i].kind].domain == DOMAIN_AIR)
                wake_around(watch, resting, context, i);
        }
    }
}
