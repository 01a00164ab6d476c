/* Builds the index by a counting sort in two parallel passes, changes it, and goes through it. */
#include "mover/query/neighbour_index.h"

#include "world/checksum.h"
#include "world/entity/remote.h"
#include "world/entity/row_words.h"
#include "world/runtime/prefault.h"
#include "world/terrain/gridsquare.h"

#include <stdlib.h>
#include <string.h>

/* Cells along an edge, of 781 m, 391 m or 195 m. More cells than vehicles only cost time. */
#define SIDE_FEW  64u
#define SIDE_MORE 128u
#define SIDE_MANY NEIGHBOUR_INDEX_SIDE_MOST
#define FEW_ROWS  4096u
#define MORE_ROWS 131072u

#define BLOCK_ROWS 2048u /* fit a second-level cache */

/* A row of cells has room for an eighth more entries than it holds when the index is built, and for
 * some more. */
#define ROOM_SHARE 8u
#define ROOM_LEAST 16u

/* When more rows than one in so many are awake, building the index is quicker than to write their
 * entries all over it. The same is true when more have entered another cell. */
#define AWAKE_SHARE 4u
#define MOVED_SHARE 256u
#define MOVED_LEAST 16u

static uint32_t blocks_of(uint32_t rows)
{
    return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
}

uint32_t neighbour_index_room(uint32_t rows)
{
    return rows + rows / ROOM_SHARE + SIDE_MANY * ROOM_LEAST;
}

int neighbour_index_init(struct neighbour_index *index, uint32_t capacity)
{
    uint32_t room = neighbour_index_room(capacity);
    *index = (struct neighbour_index){.capacity = capacity};
    index->start =
        calloc((NEIGHBOUR_INDEX_LAYERS * SIDE_MANY + 1) * SIDE_MANY, sizeof *index->start);
    index->entries = malloc(room * sizeof *index->entries);
    index->agent = malloc(room * sizeof *index->agent);
    index->room = calloc(SIDE_MANY + 1, sizeof *index->room);
    index->held = calloc(SIDE_MANY, sizeof *index->held);
    index->key = malloc(capacity * sizeof *index->key);
    index->place = malloc(capacity * sizeof *index->place);
    index->moved = malloc(capacity * sizeof *index->moved);
    index->sorted = malloc(capacity * sizeof *index->sorted);
    index->sorted_agent = malloc(capacity * sizeof *index->sorted_agent);
    index->slot = malloc(capacity * sizeof *index->slot);
    index->first = calloc(blocks_of(capacity) * (SIDE_MANY + 1), sizeof *index->first);
    if (index->start && index->entries && index->agent && index->room && index->held &&
        index->key && index->place && index->moved && index->sorted && index->sorted_agent &&
        index->slot && index->first)
        return 0;
    neighbour_index_free(index);
    return -1;
}

void neighbour_index_free(struct neighbour_index *index)
{
    free(index->start);
    free(index->entries);
    free(index->agent);
    free(index->room);
    free(index->held);
    free(index->key);
    free(index->place);
    free(index->moved);
    free(index->sorted);
    free(index->sorted_agent);
    free(index->slot);
    free(index->first);
    *index = (struct neighbour_index){0};
}

void neighbour_index_touch(const struct neighbour_index *index, uint32_t rows)
{
    prefault_own(index->entries, rows * sizeof *index->entries);
    prefault_own(index->agent, rows * sizeof *index->agent);
    prefault_own(index->key, rows * sizeof *index->key);
    prefault_own(index->place, rows * sizeof *index->place);
    prefault_own(index->sorted, rows * sizeof *index->sorted);
    prefault_own(index->sorted_agent, rows * sizeof *index->sorted_agent);
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

static uint32_t slots_of(const struct neighbour_index *index)
{
    return index->side * NEIGHBOUR_INDEX_LAYERS;
}

static bool row_rests(const struct neighbour_index *index, uint32_t i)
{
    return index->resting && (index->resting[i / 64] >> i % 64 & 1);
}

/* The row of cells of a table row; side: none. */
static inline uint32_t band_of(const struct neighbour_index *index, const struct entities *w,
                               uint32_t i)
{
    if (w->row[i].state == ENTITY_FREE || w->row[i].behaviour == BEHAVIOUR_FLIGHT)
        return index->side;
    /* The position rounded as in the entry, so that the box of a query holds it. */
    return (uint32_t)cell_axis(index, (double)(float)w->row[i].z);
}

static inline uint16_t slot_of(const struct neighbour_index *index, const struct entities *w,
                               uint32_t i)
{
    uint32_t layer = w->row[i].force < FORCE_COUNT ? w->row[i].force : FORCE_NEUTRAL;
    if (w->row[i].state == ENTITY_WRECK)
        layer = NEIGHBOUR_INDEX_WRECKS;
    return (uint16_t)((uint32_t)cell_axis(index, (double)(float)w->row[i].x) *
                          NEIGHBOUR_INDEX_LAYERS +
                      layer);
}

static uint32_t key_of(const struct neighbour_index *index, const struct entities *w, uint32_t i)
{
    uint32_t band = band_of(index, w, i);
    return band == index->side ? NEIGHBOUR_INDEX_NO_KEY
                               : band * slots_of(index) + slot_of(index, w, i);
}

static inline struct neighbour_index_entry entry_of(const struct entities *w, uint32_t i)
{
    return (struct neighbour_index_entry){.x = (float)w->row[i].x,
                                          .z = (float)w->row[i].z,
                                          .y = (float)w->row[i].y,
                                          .vx = (float)w->row[i].vx,
                                          .vz = (float)w->row[i].vz,
                                          .row = i & (CAPACITY_MAX - 1u),
                                          .kind = w->row[i].kind & NEIGHBOUR_INDEX_KINDS};
}

/* The id of the row's agent if it decides in its turn, else 0. */
static inline uint32_t agent_of(const struct neighbour_index *index, uint32_t i)
{
    const struct entities *w = index->committed;
    return w->row[i].state == ENTITY_ACTIVE && !row_rests(index, i) && !remote_is(w, i)
               ? w->row[i].id
               : 0;
}

static void note_agent(struct neighbour_index *index, uint32_t band)
{
    atomic_store_explicit(&index->decides[band], 1, memory_order_relaxed);
}

/* --- building: the rows of a block, by row of cells --------------------------------------------*/

static void sort_block(struct neighbour_index *index, uint32_t block)
{
    const struct entities *w = index->committed;
    uint32_t begin = block * BLOCK_ROWS, slots = slots_of(index);
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
        uint32_t b = band[i - begin];
        if (index->placed)
            index->key[i] = NEIGHBOUR_INDEX_NO_KEY;
        if (b == index->side)
            continue;
        uint32_t at = begin + next[b]++;
        index->sorted[at] = entry_of(w, i);
        index->sorted_agent[at] = agent_of(index, i);
        index->slot[at] = slot_of(index, w, i);
        if (index->placed)
            index->key[i] = b * slots + index->slot[at];
    }
}

static void sort_blocks(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t block = begin; block < end; block++)
        sort_block(context, block);
}

/* --- building: the entries of a row of cells, by cell and layer --------------------------------*/

/* Counts the entries of each cell and layer of a band. */
static void count_slots(const struct neighbour_index *index, uint32_t band, uint32_t *count)
{
    uint32_t blocks = blocks_of(index->used);
    memset(count, 0, slots_of(index) * sizeof *count);
    for (uint32_t p = 0; p < blocks; p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++)
            count[index->slot[n]]++;
    }
}

static void fill_band(struct neighbour_index *index, uint32_t band)
{
    uint32_t slots = slots_of(index), blocks = blocks_of(index->used);
    uint32_t *start = index->start + band * index->stride, at = index->room[band];
    uint32_t next[SIDE_MANY * NEIGHBOUR_INDEX_LAYERS], *layers = index->band_count[band];
    memset(layers, 0, sizeof index->band_count[band]);
    if (index->held[band] == 0)
        return;
    count_slots(index, band, next);
    for (uint32_t s = 0; s < slots; s++) {
        uint32_t count = next[s];
        start[s] = next[s] = at;
        at += count;
        layers[s % NEIGHBOUR_INDEX_LAYERS] += count;
    }
    start[slots] = at;
    for (uint32_t p = 0; p < blocks; p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1) + band;
        for (uint32_t n = first[0]; n < first[1]; n++) {
            uint32_t to = next[index->slot[n]]++;
            index->entries[to] = index->sorted[n];
            index->agent[to] = index->sorted_agent[n];
            if (index->placed)
                index->place[index->sorted[n].row] = to;
        }
    }
    note_agent(index, band);
}

static void fill_bands(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t band = begin; band < end; band++)
        fill_band(context, band);
}

/* Gives each row of cells its room. */
static void lay_out(struct neighbour_index *index)
{
    memset(index->held, 0, SIDE_MANY * sizeof *index->held);
    for (uint32_t p = 0; p < blocks_of(index->used); p++) {
        const uint32_t *first = index->first + p * (SIDE_MANY + 1);
        for (uint32_t b = 0; b < index->side; b++)
            index->held[b] += first[b + 1] - first[b];
    }
    for (uint32_t b = 0; b < index->side; b++)
        index->room[b + 1] =
            index->room[b] + index->held[b] + index->held[b] / ROOM_SHARE + ROOM_LEAST;
}

static void find_present(struct neighbour_index *index)
{
    index->present = 0;
    for (uint32_t layer = 0; layer < NEIGHBOUR_INDEX_LAYERS; layer++)
        index->present |= index->count[layer] > 0 ? NEIGHBOUR_INDEX_LAYER(layer) : 0;
}

static void count_layers(struct neighbour_index *index)
{
    memset(index->count, 0, sizeof index->count);
    for (uint32_t band = 0; band < index->side; band++) {
        for (uint32_t layer = 0; layer < NEIGHBOUR_INDEX_LAYERS; layer++)
            index->count[layer] += index->band_count[band][layer];
    }
    find_present(index);
}

static uint32_t side_for(uint32_t used)
{
    return used <= FEW_ROWS ? SIDE_FEW : used <= MORE_ROWS ? SIDE_MORE : SIDE_MANY;
}

static void take_frame(struct neighbour_index *index, const struct neighbour_index_frame *frame)
{
    index->committed = frame->committed;
    index->resting = frame->resting;
    index->fresh = frame->fresh;
    index->used = frame->used;
    index->tick = frame->tick;
    index->think_divisor = neighbour_index_divisor(frame->think_frames);
}

void neighbour_index_build(struct neighbour_index *index, const struct neighbour_index_frame *frame,
                           bool places, struct thread_pool *workers)
{
    take_frame(index, frame);
    index->side = side_for(index->used);
    index->cells_per_m = (double)index->side / frame->side_m;
    index->stride = slots_of(index) + 1;
    index->placed = places;
    workers = index->used > NEIGHBOUR_INDEX_ALONE ? workers : NULL;
    thread_pool_run(workers, sort_blocks, index, blocks_of(index->used), 1);
    lay_out(index);
    thread_pool_run(workers, fill_bands, index, index->side, 1);
    count_layers(index);
}

/* --- changing ----------------------------------------------------------------------------------*/

/* Shifts the entries at .. end - 1 by one, and notes their places. */
static void shift(struct neighbour_index *index, uint32_t at, uint32_t end, int by)
{
    uint32_t to = at + (uint32_t)by, count = end - at;
    memmove(&index->entries[to], &index->entries[at], count * sizeof *index->entries);
    memmove(&index->agent[to], &index->agent[at], count * sizeof *index->agent);
    for (uint32_t n = to; n < to + count; n++)
        index->place[index->entries[n].row] = n;
}

static void take_out(struct neighbour_index *index, uint32_t i)
{
    uint32_t slots = slots_of(index), key = index->key[i], band = key / slots, slot = key % slots;
    uint32_t *start = index->start + band * index->stride;
    shift(index, index->place[i] + 1, start[slots], -1);
    for (uint32_t s = slot + 1; s <= slots; s++)
        start[s]--;
    index->held[band]--;
    index->count[key % NEIGHBOUR_INDEX_LAYERS]--;
    index->key[i] = NEIGHBOUR_INDEX_NO_KEY;
}

/* Returns false if the row of cells has no room. */
static bool put_in(struct neighbour_index *index, uint32_t i, uint32_t key)
{
    uint32_t slots = slots_of(index), band = key / slots, slot = key % slots;
    uint32_t *start = index->start + band * index->stride;
    if (index->room[band] + index->held[band] == index->room[band + 1])
        return false;
    for (uint32_t s = 0; index->held[band] == 0 && s <= slots; s++)
        start[s] = index->room[band];
    uint32_t at = start[slot];
    while (at < start[slot + 1] && index->entries[at].row < i)
        at++;
    shift(index, at, start[slots], 1);
    for (uint32_t s = slot + 1; s <= slots; s++)
        start[s]++;
    index->entries[at] = entry_of(index->committed, i);
    index->agent[at] = agent_of(index, i);
    index->place[i] = at;
    index->key[i] = key;
    index->held[band]++;
    index->count[key % NEIGHBOUR_INDEX_LAYERS]++;
    note_agent(index, band);
    return true;
}

/* Writes the entry of a row again where it is. A row that has entered another cell, or has come or
 * gone, is listed. */
static void renew(struct neighbour_index *index, uint32_t i)
{
    uint32_t key = key_of(index, index->committed, i);
    if (key != index->key[i]) {
        uint32_t n = atomic_fetch_add_explicit(&index->moved_count, 1, memory_order_relaxed);
        index->moved[n] = i;
    } else if (key != NEIGHBOUR_INDEX_NO_KEY) {
        uint32_t at = index->place[i], agent = agent_of(index, i);
        index->entries[at] = entry_of(index->committed, i);
        if (agent != index->agent[at])
            note_agent(index, key / slots_of(index));
        index->agent[at] = agent;
    }
}

static void renew_block(struct neighbour_index *index, uint32_t begin, uint32_t end)
{
    for (uint32_t first = begin; first < end; first += 64) {
        uint32_t rows = end - first < 64 ? end - first : 64;
        uint64_t awake = index->resting ? ~index->resting[first / 64] : UINT64_MAX;
        awake |= index->fresh ? index->fresh[first / 64] : 0;
        awake &= UINT64_MAX >> (64 - rows);
        for (; awake != 0; awake &= awake - 1)
            renew(index, first + (uint32_t)__builtin_ctzll(awake));
    }
}

static void renew_blocks(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    struct neighbour_index *index = context;
    (void)worker;
    for (uint32_t block = begin; block < end; block++) {
        uint32_t first = block * BLOCK_ROWS;
        renew_block(index, first,
                    index->used - first < BLOCK_ROWS ? index->used : first + BLOCK_ROWS);
    }
}

/* Rows that are no longer in use have no entry, and rows that are new in use have none yet. */
static void change_used(struct neighbour_index *index, uint32_t used)
{
    for (uint32_t i = used; i < index->used; i++) {
        if (index->key[i] != NEIGHBOUR_INDEX_NO_KEY)
            take_out(index, i);
    }
    for (uint32_t i = index->used; i < used; i++)
        index->key[i] = NEIGHBOUR_INDEX_NO_KEY;
}

/* Moves the listed entries. Returns false if they are too many, or one finds no room. */
static bool move_entries(struct neighbour_index *index)
{
    uint32_t count = index->moved_count;
    if (count > index->used / MOVED_SHARE + MOVED_LEAST)
        return false;
    for (uint32_t n = 0; n < count; n++) {
        uint32_t i = index->moved[n], key = key_of(index, index->committed, i);
        if (index->key[i] != NEIGHBOUR_INDEX_NO_KEY)
            take_out(index, i);
        if (key != NEIGHBOUR_INDEX_NO_KEY && !put_in(index, i, key))
            return false;
    }
    find_present(index);
    return true;
}

static uint32_t count_awake(const struct neighbour_index_frame *frame)
{
    uint32_t awake = 0;
    if (!frame->resting)
        return frame->used;
    for (uint32_t first = 0; first < frame->used; first += 64) {
        uint64_t bits = row_words_below(first / 64, frame->used) & ~frame->resting[first / 64];
        if (bits != 0) /* a call where the processor may not count bits */
            awake += (uint32_t)__builtin_popcountll(bits);
    }
    return awake;
}

void neighbour_index_update(struct neighbour_index *index,
                            const struct neighbour_index_frame *frame, struct thread_pool *workers)
{
    bool few = count_awake(frame) <= frame->used / AWAKE_SHARE;
    bool kept = few && index->placed && index->side == side_for(frame->used);
    if (kept) {
        change_used(index, frame->used);
        take_frame(index, frame);
        index->moved_count = 0;
        workers = index->used > NEIGHBOUR_INDEX_ALONE ? workers : NULL;
        thread_pool_run(workers, renew_blocks, index, blocks_of(index->used), 1);
        kept = move_entries(index);
    }
    if (!kept)
        neighbour_index_build(index, frame, few, workers);
}

void neighbour_index_rests(struct neighbour_index *index, uint32_t row)
{
    if (index->placed && index->key[row] != NEIGHBOUR_INDEX_NO_KEY)
        index->agent[index->place[row]] = 0;
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
            if (index->held[query->row] == 0)
                continue;
            const uint32_t *start = index->start + (uint32_t)query->row * index->stride;
            while (query->column <= query->x1) {
                const uint32_t *cell = start + (uint32_t)query->column * NEIGHBOUR_INDEX_LAYERS;
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

/* Returns where the entries of the cell of a place begin. */
static const uint32_t *cell_at(const struct neighbour_index *index, double x, double z)
{
    return index->start + (uint32_t)cell_axis(index, z) * index->stride +
           (uint32_t)cell_axis(index, x) * NEIGHBOUR_INDEX_LAYERS;
}

void neighbour_index_prefetch_cell(const struct neighbour_index *index, double x, double z)
{
    __builtin_prefetch(cell_at(index, x, z));
}

void neighbour_index_prefetch_entries(const struct neighbour_index *index, double x, double z)
{
    const unsigned char *entry = (const unsigned char *)(index->entries + *cell_at(index, x, z));
    __builtin_prefetch(entry);
    __builtin_prefetch(entry + 64);
    __builtin_prefetch(entry + 128);
}
