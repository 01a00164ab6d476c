/* The index of who is where: a counting sort a frame, in two passes of which all threads do a part.
 */
#include "mover/query/neighbour_index.h"

#include "world/checksum.h"
#include "world/terrain/gridsquare.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Cells along an edge: 781 m, 391 m or 195 m each. More cells than vehicles only cost. */
#define SIDE_FEW  64u
#define SIDE_MORE 128u
#define SIDE_MANY 256u
#define FEW_ROWS  4096u
#define MORE_ROWS 131072u

#define PIECE_ROWS 2048u /* of a piece: they fit a second-level cache */
#define HUGE_PAGE  (UINT64_C(2) << 20)

static uint32_t pieces_of(uint32_t rows)
{
    return (rows + PIECE_ROWS - 1) / PIECE_ROWS;
}

/* Walks come to any part of it at any time: in large pages, where there are, it costs fewer misses
 * of the table of pages. */
static void *large(size_t bytes)
{
    if (bytes < HUGE_PAGE)
        return malloc(bytes);
    bytes = (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    void *memory = aligned_alloc(HUGE_PAGE, bytes);
    if (memory)
        madvise(memory, bytes, MADV_HUGEPAGE); /* or else not */
    return memory;
}

int neighbour_index_init(struct neighbour_index *near, uint32_t capacity)
{
    *near = (struct neighbour_index){.capacity = capacity};
    near->start = calloc(NEIGHBOUR_INDEX_LAYERS * SIDE_MANY * SIDE_MANY + 1, sizeof *near->start);
    near->entries = large(capacity * sizeof *near->entries);
    near->sorted = malloc(capacity * sizeof *near->sorted);
    near->slot = malloc(capacity * sizeof *near->slot);
    near->first = calloc(pieces_of(capacity) * (SIDE_MANY + 1), sizeof *near->first);
    near->band = calloc(SIDE_MANY + 1, sizeof *near->band);
    near->layers = calloc(SIDE_MANY, sizeof *near->layers);
    if (near->start && near->entries && near->sorted && near->slot && near->first && near->band &&
        near->layers)
        return 0;
    neighbour_index_free(near);
    return -1;
}

void neighbour_index_free(struct neighbour_index *near)
{
    free(near->start);
    free(near->entries);
    free(near->sorted);
    free(near->slot);
    free(near->first);
    free(near->band);
    free(near->layers);
    *near = (struct neighbour_index){0};
}

static int32_t cell_axis(const struct neighbour_index *near, double metres)
{
    double cells = metres * near->cells_per_m;
    if (!(cells > 0.0))
        return 0;
    return cells >= (double)near->side ? (int32_t)near->side - 1 : (int32_t)cells;
}

/* --- rows by rows of cells ---------------------------------------------------------------------*/

/* Which row of cells a row belongs to; side: to none. */
static uint32_t band_of(const struct neighbour_index *near, const struct entities *w, uint32_t i)
{
    if (w->state[i] == ENTITY_FREE || w->behaviour[i] == BEHAVIOUR_FLIGHT)
        return near->side;
    /* By the position as the entry has it, so that a walk's box holds it. */
    return (uint32_t)cell_axis(near, (double)(float)w->z[i]);
}

static uint16_t slot_of(const struct neighbour_index *near, const struct entities *w, uint32_t i)
{
    uint32_t layer = w->force[i] < FORCE_COUNT ? w->force[i] : FORCE_NEUTRAL;
    if (w->state[i] == ENTITY_WRECK)
        layer = NEIGHBOUR_INDEX_WRECKS;
    return (uint16_t)((uint32_t)cell_axis(near, (double)(float)w->x[i]) * NEIGHBOUR_INDEX_LAYERS +
                      layer);
}

static struct neighbour_index_entry entry_of(const struct neighbour_index *near,
                                             const struct entities *w, uint32_t i)
{
    bool due = neighbour_index_divides(near->thoughts, near->tick + w->id[i]) &&
               w->state[i] == ENTITY_ACTIVE;
    return (struct neighbour_index_entry){.x = (float)w->x[i],
                                          .z = (float)w->z[i],
                                          .y = (float)w->y[i],
                                          .vx = (float)w->vx[i],
                                          .vz = (float)w->vz[i],
                                          .row = i & (CAPACITY_MAX - 1u),
                                          .kind = w->kind[i] & NEIGHBOUR_INDEX_KINDS,
                                          .due = due};
}

static void sort_piece(struct neighbour_index *near, uint32_t piece)
{
    const struct entities *w = near->committed;
    uint32_t begin = piece * PIECE_ROWS;
    uint32_t end = begin + PIECE_ROWS < near->used ? begin + PIECE_ROWS : near->used;
    uint32_t *first = near->first + piece * (SIDE_MANY + 1), next[SIDE_MANY + 2] = {0};
    uint16_t band[PIECE_ROWS];
    for (uint32_t i = begin; i < end; i++) {
        band[i - begin] = (uint16_t)band_of(near, w, i);
        next[band[i - begin] + 1]++;
    }
    for (uint32_t b = 0; b <= near->side; b++) {
        first[b] = begin + next[b];
        next[b + 1] += next[b];
    }
    for (uint32_t i = begin; i < end; i++) {
        if (band[i - begin] == near->side)
            continue;
        uint32_t at = begin + next[band[i - begin]]++;
        near->sorted[at] = entry_of(near, w, i);
        near->slot[at] = slot_of(near, w, i);
    }
}

static void sort_pieces(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t piece = begin; piece < end; piece++)
        sort_piece(context, piece);
}

/* --- a row of cells ----------------------------------------------------------------------------*/

static void fill_band(struct neighbour_index *near, uint32_t band)
{
    uint32_t slots = near->side * NEIGHBOUR_INDEX_LAYERS, pieces = pieces_of(near->used),
             layers = 0;
    uint32_t next[SIDE_MANY * NEIGHBOUR_INDEX_LAYERS + 1] = {0};
    uint32_t *start = near->start + band * slots;
    for (uint32_t p = 0; p < pieces; p++) {
        const uint32_t *first = near->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++)
            next[near->slot[n] + 1u]++;
    }
    next[0] = near->band[band];
    for (uint32_t s = 0; s < slots; s++) {
        start[s] = next[s];
        layers |= (next[s + 1] > 0 ? 1u : 0u) << s % NEIGHBOUR_INDEX_LAYERS;
        next[s + 1] += next[s];
    }
    near->layers[band] = layers;
    for (uint32_t p = 0; p < pieces; p++) {
        const uint32_t *first = near->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++)
            near->entries[next[near->slot[n]]++] = near->sorted[n];
    }
}

static void fill_bands(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t band = begin; band < end; band++)
        fill_band(context, band);
}

void neighbour_index_build(struct neighbour_index *near, const struct entities *committed,
                           uint32_t used, uint32_t tick, uint32_t think,
                           struct thread_pool *workers)
{
    near->side = used <= FEW_ROWS ? SIDE_FEW : used <= MORE_ROWS ? SIDE_MORE : SIDE_MANY;
    near->cells_per_m = (double)near->side / WORLD_SIDE_M;
    near->committed = committed;
    near->used = used;
    near->tick = tick;
    near->thoughts = neighbour_index_divisor(think);
    near->present = 0;
    thread_pool_run(workers, sort_pieces, near, pieces_of(used), 1);
    memset(near->band, 0, (SIDE_MANY + 1) * sizeof *near->band);
    for (uint32_t p = 0; p < pieces_of(used); p++) {
        const uint32_t *first = near->first + p * (SIDE_MANY + 1);
        for (uint32_t b = 0; b < near->side; b++)
            near->band[b + 1] += first[b + 1] - first[b];
    }
    for (uint32_t b = 0; b < near->side; b++)
        near->band[b + 1] += near->band[b];
    thread_pool_run(workers, fill_bands, near, near->side, 1);
    near->start[near->side * near->side * NEIGHBOUR_INDEX_LAYERS] = near->band[near->side];
    for (uint32_t b = 0; b < near->side; b++)
        near->present |= near->layers[b];
}

/* --- walks -------------------------------------------------------------------------------------*/

struct neighbour_query neighbour_index_begin(const struct neighbour_index *near, uint32_t layers,
                                             double x, double z, double radius_m)
{
    struct neighbour_query walk = {
        .near = near,
        .x = x,
        .z = z,
        .square = radius_m * radius_m,
        .x0 = cell_axis(near, x - radius_m),
        .x1 = cell_axis(near, x + radius_m),
        .z0 = cell_axis(near, z - radius_m),
        .z1 = cell_axis(near, z + radius_m),
        .left = layers & near->present,
    };
    walk.row = walk.z1 + 1;
    walk.column = walk.x0;
    if (walk.left == near->present && walk.left != 0) { /* it need not tell them apart */
        walk.all = true;
        walk.left = 0;
        walk.row = walk.z0;
    }
    return walk;
}

/* The lowest of the layers that are left, and those that follow it without a gap. */
static bool next_layers(struct neighbour_query *walk)
{
    if (walk->left == 0)
        return false;
    walk->low = (uint32_t)__builtin_ctz(walk->left);
    walk->high = walk->low + (uint32_t)__builtin_ctz(~(walk->left >> walk->low));
    walk->left &= ~((1u << walk->high) - 1u);
    walk->row = walk->z0;
    return true;
}

bool neighbour_index_turn(struct neighbour_query *walk)
{
    const struct neighbour_index *near = walk->near;
    do {
        for (; walk->row <= walk->z1; walk->row++, walk->column = walk->x0) {
            uint32_t first = (uint32_t)walk->row * near->side;
            while (walk->column <= walk->x1) {
                const uint32_t *cell =
                    near->start + (first + (uint32_t)walk->column) * NEIGHBOUR_INDEX_LAYERS;
                uint32_t cells = walk->all ? (uint32_t)(walk->x1 - walk->x0) + 1 : 1;
                walk->column += (int32_t)cells;
                walk->at = near->entries + cell[walk->all ? 0 : walk->low];
                walk->end = near->entries +
                            (walk->all ? cell[cells * NEIGHBOUR_INDEX_LAYERS] : cell[walk->high]);
                if (walk->at < walk->end)
                    return true;
            }
        }
    } while (next_layers(walk));
    return false;
}
