/* Flow over a grid: priority flood for the order, steepest descent for the tree, the stream power
 * law for the heights. */
#include "world/making/stream_erosion.h"

#include "world/maths/random.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define NODE_NONE UINT32_MAX

/* The flood's queue holds nodes by height in steps of half a metre; all higher nodes share the last
 * step. Finer steps change little, since ties are broken by arrival. */
#define LEVEL_COUNT  4400
#define LEVELS_PER_M 2.0f

/* Above areas smaller than this creep shapes the ground, not water: slopes hardly change [m2]. */
#define HEAD_AREA_M2 150000.0f

static const int32_t neighbour_x[8] = {1, 1, 0, -1, -1, -1, 0, 1};
static const int32_t neighbour_z[8] = {0, 1, 1, 1, 0, -1, -1, -1};

int stream_erosion_init(struct stream_erosion *d, uint32_t side, double spacing_m)
{
    size_t n = (size_t)side * side;
    *d = (struct stream_erosion){.side = side, .spacing_m = spacing_m};
    d->height = calloc(n, sizeof *d->height);
    d->steepness = calloc(n, sizeof *d->steepness);
    d->slope_max = calloc(n, sizeof *d->slope_max);
    d->fixed = calloc(n, sizeof *d->fixed);
    d->receiver = calloc(n, sizeof *d->receiver);
    d->order = calloc(n, sizeof *d->order);
    d->area_m2 = calloc(n, sizeof *d->area_m2);
    d->base_m = calloc(n, sizeof *d->base_m);
    d->next = calloc(n, sizeof *d->next);
    d->head = calloc(LEVEL_COUNT, sizeof *d->head);
    d->tail = calloc(LEVEL_COUNT, sizeof *d->tail);
    d->seen = calloc(n, sizeof *d->seen);
    if (d->height && d->steepness && d->slope_max && d->fixed && d->receiver && d->order &&
        d->area_m2 && d->base_m && d->next && d->head && d->tail && d->seen)
        return 0;
    stream_erosion_free(d);
    return -1;
}

void stream_erosion_free(struct stream_erosion *d)
{
    free(d->height);
    free(d->steepness);
    free(d->slope_max);
    free(d->fixed);
    free(d->receiver);
    free(d->order);
    free(d->area_m2);
    free(d->base_m);
    free(d->next);
    free(d->head);
    free(d->tail);
    free(d->seen);
    *d = (struct stream_erosion){0};
}

static uint32_t level_of(float height)
{
    float level = height * LEVELS_PER_M;
    if (!(level > 0.0f))
        return 0;
    return level < (float)(LEVEL_COUNT - 1) ? (uint32_t)level : LEVEL_COUNT - 1;
}

static void push(struct stream_erosion *d, uint32_t level, uint32_t node)
{
    d->next[node] = NODE_NONE;
    if (d->head[level] == NODE_NONE)
        d->head[level] = node;
    else
        d->next[d->tail[level]] = node;
    d->tail[level] = node;
    d->seen[node] = 1;
}

/* A random weight of 0.45..1.55 for each node and direction, so that streams on uniform slopes do
 * not follow the eight directions of the grid. */
static float whim(uint64_t bits, uint32_t k)
{
    return 0.45f + (float)((bits >> (8 * k)) & 0xffu) * (1.1f / 255.0f);
}

/* Takes a node out of the flood: it drains to the steepest neighbour taken before it or, in a
 * hollow, to the one that flooded it. */
static void settle(struct stream_erosion *d, uint32_t node, uint32_t level, uint64_t seed)
{
    int32_t side = (int32_t)d->side;
    int32_t x = (int32_t)(node % d->side), z = (int32_t)(node / d->side);
    uint64_t bits = random_mix(seed + node);
    float steepest = 0.0f;
    for (uint32_t k = 0; k < 8; k++) {
        int32_t nx = x + neighbour_x[k], nz = z + neighbour_z[k];
        if (nx < 0 || nz < 0 || nx >= side || nz >= side)
            continue;
        uint32_t other = (uint32_t)(nz * side + nx);
        if (d->seen[other] == 0) {
            uint32_t own = level_of(d->height[other]);
            d->receiver[other] = node;
            push(d, own > level ? own : level, other);
        } else if (d->seen[other] == 2 && !d->fixed[node]) {
            float fall = (d->height[node] - d->height[other]) * ((k & 1u) ? 0.70710678f : 1.0f);
            fall *= whim(bits, k);
            if (fall > steepest) {
                steepest = fall;
                d->receiver[node] = other;
            }
        }
    }
    d->seen[node] = 2;
}

static void route(struct stream_erosion *d, uint64_t seed)
{
    uint32_t count = d->side * d->side, taken = 0;
    memset(d->seen, 0, count);
    for (uint32_t i = 0; i < LEVEL_COUNT; i++)
        d->head[i] = NODE_NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (d->fixed[i]) {
            d->receiver[i] = i;
            push(d, level_of(d->height[i]), i);
        }
    }
    for (uint32_t level = 0; level < LEVEL_COUNT; level++) {
        while (d->head[level] != NODE_NONE) {
            uint32_t node = d->head[level];
            d->head[level] = d->next[node];
            d->order[taken++] = node;
            settle(d, node, level, seed);
        }
    }
}

static void accumulate(struct stream_erosion *d)
{
    uint32_t count = d->side * d->side;
    float own = (float)(d->spacing_m * d->spacing_m);
    for (uint32_t i = 0; i < count; i++)
        d->area_m2[i] = own;
    for (uint32_t i = count; i-- > 0;) {
        uint32_t node = d->order[i];
        if (d->receiver[node] != node)
            d->area_m2[d->receiver[node]] += d->area_m2[node];
    }
}

static void raise_from_receivers(struct stream_erosion *d)
{
    uint32_t count = d->side * d->side;
    float straight = (float)d->spacing_m, diagonal = straight * 1.41421356f;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t node = d->order[i], to = d->receiver[node];
        if (to == node) {
            d->base_m[node] = d->height[node];
            continue;
        }
        bool aslant = node % d->side != to % d->side && node / d->side != to / d->side;
        float slope = d->steepness[node] / sqrtf(d->area_m2[node] + HEAD_AREA_M2);
        if (slope > d->slope_max[node])
            slope = d->slope_max[node];
        d->height[node] = d->height[to] + slope * (aslant ? diagonal : straight);
        d->base_m[node] = d->base_m[to];
    }
}

void stream_erosion_round(struct stream_erosion *d, uint64_t seed)
{
    route(d, seed);
    accumulate(d);
    raise_from_receivers(d);
}
