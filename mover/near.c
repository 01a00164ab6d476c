/* The index of who is where: a counting sort a frame. */
#include "mover/near.h"

#include "world/square.h"

#include <stdlib.h>
#include <string.h>

/* Cells along an edge: 781 m, 391 m or 195 m each. More cells than vehicles only cost. */
#define SIDE_FEW  64u
#define SIDE_MORE 128u
#define SIDE_MANY 256u
#define FEW_ROWS  4096u
#define MORE_ROWS 131072u

#define NOWHERE UINT32_MAX

int near_init(struct near *near, uint32_t capacity)
{
    *near = (struct near){.side = SIDE_FEW, .cell_m = WORLD_SIDE_M / SIDE_FEW};
    near->capacity = capacity;
    near->start = calloc(NEAR_LAYERS * SIDE_MANY * SIDE_MANY + 2, sizeof *near->start);
    near->place = calloc(capacity, sizeof *near->place);
    near->entries = calloc(capacity, sizeof *near->entries);
    if (near->start && near->place && near->entries)
        return 0;
    near_free(near);
    return -1;
}

void near_free(struct near *near)
{
    free(near->start);
    free(near->place);
    free(near->entries);
    *near = (struct near){0};
}

static int32_t cell_axis(const struct near *near, double metres)
{
    double cells = metres / near->cell_m;
    if (!(cells > 0.0))
        return 0;
    return cells >= (double)near->side ? (int32_t)near->side - 1 : (int32_t)cells;
}

/* Which cell of which layer a row belongs to. */
static uint32_t place_of(const struct near *near, const struct entities *w, uint32_t i)
{
    uint32_t layer = w->force[i] < FORCE_COUNT ? w->force[i] : FORCE_NEUTRAL;
    if (w->state[i] == ENTITY_FREE || w->behaviour[i] == BEHAVIOUR_FLIGHT)
        return NOWHERE;
    if (w->state[i] == ENTITY_WRECK)
        layer = NEAR_WRECKS;
    /* By the position as the entry has it, so that a walk's box holds it. */
    uint32_t row = (uint32_t)cell_axis(near, (double)(float)w->z[i]);
    uint32_t column = (uint32_t)cell_axis(near, (double)(float)w->x[i]);
    return (layer * near->side + row) * near->side + column;
}

void near_build(struct near *near, const struct entities *committed, uint32_t used)
{
    const struct entities *w = committed;
    near->side = used <= FEW_ROWS ? SIDE_FEW : used <= MORE_ROWS ? SIDE_MORE : SIDE_MANY;
    near->cell_m = WORLD_SIDE_M / (double)near->side;
    uint32_t cells = near->side * near->side, places = NEAR_LAYERS * cells;
    /* Counted two further on: after the sums start[p + 1] is where place p begins, and filling it
     * moves that to where it ends, which is where p + 1 begins. */
    uint32_t *next = near->start + 1;
    memset(near->start, 0, (places + 2) * sizeof *near->start);
    for (uint32_t i = 0; i < used; i++) {
        near->place[i] = place_of(near, w, i);
        if (near->place[i] != NOWHERE)
            next[near->place[i] + 1]++;
    }
    for (uint32_t p = 0; p < places; p++)
        next[p + 1] += next[p];
    for (uint32_t i = 0; i < used; i++) {
        if (near->place[i] != NOWHERE)
            near->entries[next[near->place[i]]++] =
                (struct near_entry){(float)w->x[i], (float)w->z[i], i};
    }
    for (uint32_t layer = 0; layer < NEAR_LAYERS; layer++)
        near->count[layer] = near->start[(layer + 1) * cells] - near->start[layer * cells];
}

struct near_walk near_begin(const struct near *near, uint32_t layers, double x, double z,
                            double radius_m)
{
    return (struct near_walk){
        .near = near,
        .x = x,
        .z = z,
        .square = radius_m * radius_m,
        .x0 = cell_axis(near, x - radius_m),
        .x1 = cell_axis(near, x + radius_m),
        .z0 = cell_axis(near, z - radius_m),
        .z1 = cell_axis(near, z + radius_m),
        .row = cell_axis(near, z - radius_m),
        .layers = layers,
    };
}

bool near_turn(struct near_walk *walk)
{
    const struct near *near = walk->near;
    for (; walk->layer < NEAR_LAYERS; walk->layer++, walk->row = walk->z0) {
        if (!(walk->layers & NEAR_LAYER(walk->layer)) || near->count[walk->layer] == 0)
            continue;
        while (walk->row <= walk->z1) {
            uint32_t first = (walk->layer * near->side + (uint32_t)walk->row++) * near->side;
            walk->at = near->entries + near->start[first + (uint32_t)walk->x0];
            walk->end = near->entries + near->start[first + (uint32_t)walk->x1 + 1];
            if (walk->at < walk->end)
                return true;
        }
    }
    return false;
}
