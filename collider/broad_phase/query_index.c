/* A counting sort by strip and column. */
#include "collider/broad_phase/query_index.h"

#include "world/runtime/prefault.h"
#include "world/runtime/reserve.h"

#include <string.h>

#define MORE_RECORDS 4096u
#define CELLS        (STRIP_COUNT * QUERY_INDEX_COLUMNS)

int query_index_init(struct query_index *index, uint32_t rows)
{
    *index = (struct query_index){.capacity = 2 * rows + MORE_RECORDS};
    index->record = reserve_take(index->capacity, sizeof *index->record);
    index->first = reserve_take(CELLS + 2, sizeof *index->first);
    return index->record && index->first ? 0 : -1;
}

void query_index_free(struct query_index *index)
{
    reserve_free(index->record);
    reserve_free(index->first);
    *index = (struct query_index){0};
}

void query_index_touch(const struct query_index *index, uint32_t rows)
{
    prefault_own(index->record, rows * sizeof *index->record);
    prefault_own(index->first, (CELLS + 2) * sizeof *index->first);
}

static uint32_t cell_of(uint32_t strip, int32_t x)
{
    return strip * QUERY_INDEX_COLUMNS + ((uint32_t)x >> QUERY_INDEX_COLUMN_BITS);
}

/* Counts the records of each cell into the word two after it, so that placing them moves the words
 * to where the cells begin. Returns how many there are. */
static uint64_t count_strip(struct query_index *index, const struct strip_bins *bins,
                            uint32_t strip)
{
    uint64_t all = 0;
    uint32_t count;
    const struct bin_chunk *chunk = strip_bins_last(bins, strip, &count);
    for (; chunk; chunk = chunk->before, count = BIN_CHUNK_RECORDS) {
        all += count;
        for (uint32_t i = 0; i < count; i++) {
            const struct bin_record *record = &chunk->record[i];
            int32_t wide = record->max_x - record->min_x;
            index->widest = wide > index->widest ? wide : index->widest;
            index->first[cell_of(strip, record->min_x) + 2]++;
        }
    }
    return all;
}

static void place_strip(struct query_index *index, const struct strip_bins *bins, uint32_t strip)
{
    uint32_t count;
    const struct bin_chunk *chunk = strip_bins_last(bins, strip, &count);
    for (; chunk; chunk = chunk->before, count = BIN_CHUNK_RECORDS) {
        for (uint32_t i = 0; i < count; i++) {
            const struct bin_record *record = &chunk->record[i];
            index->record[index->first[cell_of(strip, record->min_x) + 1]++] = *record;
        }
    }
}

void query_index_build(struct query_index *index, const struct strip_bins *const *bins,
                       uint32_t count)
{
    uint64_t all = 0;
    index->widest = 0;
    memset(index->first, 0, (CELLS + 2) * sizeof *index->first);
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++) {
        for (uint32_t i = 0; i < count; i++)
            all += count_strip(index, bins[i], strip);
    }
    index->built = all <= index->capacity;
    if (!index->built)
        return;
    for (uint32_t cell = 0; cell <= CELLS; cell++)
        index->first[cell + 1] += index->first[cell];
    for (uint32_t strip = 0; strip < STRIP_COUNT; strip++) {
        for (uint32_t i = 0; i < count; i++)
            place_strip(index, bins[i], strip);
    }
}

const struct bin_record *query_index_strip(const struct query_index *index, uint32_t strip,
                                           uint32_t *count)
{
    uint32_t from = index->first[strip * QUERY_INDEX_COLUMNS];
    *count = index->first[(strip + 1) * QUERY_INDEX_COLUMNS] - from;
    return index->record + from;
}

const struct bin_record *query_index_end(const struct query_index *index, uint32_t strip, int32_t x)
{
    return index->record + index->first[cell_of(strip, x) + 1];
}

const struct bin_record *query_index_from(const struct query_index *index, uint32_t strip,
                                          int32_t min_x, int32_t max_x, uint32_t *count)
{
    int32_t west = min_x > index->widest ? min_x - index->widest : 0;
    uint32_t from = index->first[cell_of(strip, west)];
    *count = (uint32_t)(query_index_end(index, strip, max_x) - (index->record + from));
    return index->record + from;
}
