/* Builds the index by a counting sort in two parallel passes, and goes through it. */
#include "mover/query/neighbour_index.h"

#include "world/checksum.h"
#include "world/runtime/prefault.h"
#include "world/terrain/gridsquare.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Cells along an edge, of 781 m, 391 m or 195 m. More cells than vehicles only cost time. */
#define SIDE_FEW  64u
#define SIDE_MORE 128u
#define SIDE_MANY 256u
#define FEW_ROWS  4096u
#define MORE_ROWS 131072u

#define BLOCK_ROWS 2048u /* fit a second-level cache */
#define HUGE_PAGE  (UINT64_C(2) << 20)

static uint32_t blocks_of(uint32_t rows)
{
    return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
}

/* Queries read all parts of the entries. Large pages, where the kernel has them, cause fewer misses
 * of the translation buffer. */
static void *large(size_t bytes)
{
    if (bytes < HUGE_PAGE)
        return malloc(bytes);
    bytes = (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    void *memory = aligned_alloc(HUGE_PAGE, bytes);
    if (memory)
        madvise(memory, bytes,
                MADV_HUGEPAGE); /* a kernel without large pages refuses, which does no harm */
    return memory;
}

int neighbour_index_init(struct neighbour_index *index, uint32_t capacity)
{
    *index = (struct neighbour_index){.capacity = capacity};
    index->start = calloc(NEIGHBOUR_INDEX_LAYERS * SIDE_MANY * SIDE_MANY + 1, sizeof *index->start);
    index->entries = large(capacity * sizeof *index->entries);
    index->sorted = malloc(capacity * sizeof *index->sorted);
    index->slot = malloc(capacity * sizeof *index->slot);
    index->first = calloc(blocks_of(capacity) * (SIDE_MANY + 1), sizeof *index->first);
    index->band = calloc(SIDE_MANY + 1, sizeof *index->band);
    index->layers = calloc(SIDE_MANY, sizeof *index->layers);
    if (index->start && index->entries && index->sorted && index->slot && index->first &&
        index->band && index->layers)
        return 0;
    neighbour_index_free(index);
    return -1;
}

void neighbour_index_free(struct neighbour_index *index)
{
    free(index->start);
    free(index->entries);
    free(index->sorted);
    free(index->slot);
    free(index->first);
    free(index->band);
    free(index->layers);
    *index = (struct neighbour_index){0};
}

void neighbour_index_touch(const struct neighbour_index *index, uint32_t rows)
{
    prefault_own(index->entries, rows * sizeof *index->entries);
    prefault_own(index->sorted, rows * sizeof *index->sorted);
    prefault_own(index->slot, rows * sizeof *index->slot);
    prefault_own(index->first, blocks_of(rows) * (SIDE_MANY + 1) * sizeof *index->first);
}

static int32_t cell_axis(const struct neighbour_index *index, double metres)
{
    double cells = metres * index->cells_per_m;
    if (!(cells > 0.0))
        return 0;
    return cells >= (double)index->side ? (int32_t)index->side - 1 : (int32_t)cells;
}

/* --- first pass: the rows of a block, by row of cells ------------------------------------------*/

/* The row of cells of a table row; side: none. */
static uint32_t band_of(const struct neighbour_index *index, const struct entities *w, uint32_t i)
{
    if (w->state[i] == ENTITY_FREE || w->behaviour[i] == BEHAVIOUR_FLIGHT)
        return index->side;
    /* The position rounded as in the entry, so that the box of a query holds it. */
    return (uint32_t)cell_axis(index, (double)(float)w->z[i]);
}

static uint16_t slot_of(const struct neighbour_index *index, const struct entities *w, uint32_t i)
{
    uint32_t layer = w->force[i] < FORCE_COUNT ? w->force[i] : FORCE_NEUTRAL;
    if (w->state[i] == ENTITY_WRECK)
        layer = NEIGHBOUR_INDEX_WRECKS;
    return (uint16_t)((uint32_t)cell_axis(index, (double)(float)w->x[i]) * NEIGHBOUR_INDEX_LAYERS +
                      layer);
}

static struct neighbour_index_entry entry_of(const struct neighbour_index *index,
                                             const struct entities *w, uint32_t i)
{
    bool due = neighbour_index_divides(index->think_divisor, index->tick + w->id[i]) &&
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

static void sort_block(struct neighbour_index *index, uint32_t block)
{
    const struct entities *w = index->committed;
    uint32_t begin = block * BLOCK_ROWS;
    uint32_t end = begin + BLOCK_ROWS < index->used ? begin + BLOCK_ROWS : index->used;
    uint32_t *first = index->first + block * (SIDE_MANY + 1), next[SIDE_MANY + 2] = {0};
    uint16_t band[BLOCK_ROWS];
    for (uint32_t i = begin; i < end; i++) {
        band[i - begin] = (uint16_t)band_of(index, w, i);
        next[band[i - begin] + 1]++;
    }
    for (uint32_t b = 0; b <= index->side; b++) {
        first[b] = begin + next[b];
        next[b + 1] += next[b];
    }
    for (uint32_t i = begin; i < end; i++) {
        if (band[i - begin] == index->side)
            continue;
        uint32_t at = begin + next[band[i - begin]]++;
        index->sorted[at] = entry_of(index, w, i);
        index->slot[at] = slot_of(index, w, i);
    }
}

static void sort_blocks(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t block = begin; block < end; block++)
        sort_block(context, block);
}

/* --- second pass: the entries of a row of cells, by cell and layer -----------------------------*/

/* Counts the entries of each cell and layer of a band, and returns the layers that have one. */
static uint32_t count_slots(const struct neighbour_index *index, uint32_t band, uint32_t *count)
{
    uint32_t blocks = blocks_of(index->used), layers = 0;
    for (uint32_t p = 0; p < blocks; p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++) {
            count[index->slot[n]]++;
            layers |= 1u << index->slot[n] % NEIGHBOUR_INDEX_LAYERS;
        }
    }
    return layers;
}

/* The cells of a band without entries keep what an earlier frame left there: queries pass over the
 * band. Only its first cell is set, because it ends the band before it. */
static void fill_band(struct neighbour_index *index, uint32_t band)
{
    uint32_t slots = index->side * NEIGHBOUR_INDEX_LAYERS, blocks = blocks_of(index->used);
    uint32_t *start = index->start + band * slots, at = index->band[band];
    uint32_t next[SIDE_MANY * NEIGHBOUR_INDEX_LAYERS];
    start[0] = at;
    index->layers[band] = 0;
    if (index->band[band + 1] == at)
        return;
    memset(next, 0, slots * sizeof *next);
    index->layers[band] = count_slots(index, band, next);
    for (uint32_t s = 0; s < slots; s++) {
        uint32_t count = next[s];
        start[s] = next[s] = at;
        at += count;
    }
    for (uint32_t p = 0; p < blocks; p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++)
            index->entries[next[index->slot[n]]++] = index->sorted[n];
    }
}

static void fill_bands(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t band = begin; band < end; band++)
        fill_band(context, band);
}

void neighbour_index_build(struct neighbour_index *index, const struct entities *committed,
                           uint32_t used, uint32_t tick, uint32_t think_frames,
                           struct thread_pool *workers)
{
    index->side = used <= FEW_ROWS ? SIDE_FEW : used <= MORE_ROWS ? SIDE_MORE : SIDE_MANY;
    index->cells_per_m = (double)index->side / WORLD_SIDE_M;
    index->committed = committed;
    index->used = used;
    index->tick = tick;
    index->think_divisor = neighbour_index_divisor(think_frames);
    index->present = 0;
    workers = used > NEIGHBOUR_INDEX_ALONE ? workers : NULL;
    thread_pool_run(workers, sort_blocks, index, blocks_of(used), 1);
    memset(index->band, 0, (SIDE_MANY + 1) * sizeof *index->band);
    for (uint32_t p = 0; p < blocks_of(used); p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1);
        for (uint32_t b = 0; b < index->side; b++)
            index->band[b + 1] += first[b + 1] - first[b];
    }
    for (uint32_t b = 0; b < index->side; b++)
        index->band[b + 1] += index->band[b];
    thread_pool_run(workers, fill_bands, index, index->side, 1);
    index->start[index->side * index->side * NEIGHBOUR_INDEX_LAYERS] = index->band[index->side];
    for (uint32_t b = 0; b < index->side; b++)
        index->present |= index->layers[b];
}

/* --- queries -----------------------------------------------------------------------------------*/

struct neighbour_query neighbour_query_begin(const struct neighbour_index *index, uint32_t layers,
                                             double x, double z, double radius_m)
{
    struct neighbour_query query = {
        .index = index,
        .x = x,
        .z = z,
        .square = radius_m * radius_m,
        .x0 = cell_axis(index, x - radius_m),
        .x1 = cell_axis(index, x + radius_m),
        .z0 = cell_axis(index, z - radius_m),
        .z1 = cell_axis(index, z + radius_m),
        .left = layers & index->present,
    };
    query.row = query.z1 + 1;
    query.column = query.x0;
    if (query.left == index->present && query.left != 0) { /* all layers that there are */
        query.all = true;
        query.left = 0;
        query.row = query.z0;
    }
    return query;
}

/* Advances to the lowest of the remaining layers, and those that follow it without a gap. */
static bool next_layers(struct neighbour_query *query)
{
    if (query->left == 0)
        return false;
    query->low = (uint32_t)__builtin_ctz(query->left);
    query->high = query->low + (uint32_t)__builtin_ctz(~(query->left >> query->low));
    query->left &= ~((1u << query->high) - 1u);
    query->row = query->z0;
    return true;
}

bool neighbour_query_next_span(struct neighbour_query *query)
{
    const struct neighbour_index *index = query->index;
    do {
        for (; query->row <= query->z1; query->row++, query->column = query->x0) {
            if (index->layers[query->row] == 0)
                continue;
            uint32_t first = (uint32_t)query->row * index->side;
            while (query->column <= query->x1) {
                const uint32_t *cell =
                    index->start + (first + (uint32_t)query->column) * NEIGHBOUR_INDEX_LAYERS;
                uint32_t cells = query->all ? (uint32_t)(query->x1 - query->x0) + 1 : 1;
                query->column += (int32_t)cells;
                query->at = index->entries + cell[query->all ? 0 : query->low];
                query->end = index->entries + (query->all ? cell[cells * NEIGHBOUR_INDEX_LAYERS]
                                                          : cell[query->high]);
                if (query->at < query->end)
                    return true;
            }
        }
    } while (next_layers(query));
    return false;
}
