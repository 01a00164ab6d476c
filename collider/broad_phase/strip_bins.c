/* Chunks for bins. */
#include "collider/broad_phase/strip_bins.h"

#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/prefault.h"

#include <string.h>
#include <sys/mman.h>

/* From this size on chunks are in large pages, if there are any. Up to 400 chunks are written at
 * the same time, which would exhaust the address translation cache with small pages. */
#define SMALL_BYTES (UINT64_C(2) << 20)

static void advise(struct bin_chunk *slab, uint64_t chunks)
{
    uint64_t bytes = chunks * sizeof *slab;
    if (bytes > SMALL_BYTES) /* only advice: the result does not matter */
        (void)madvise((char *)slab + SMALL_BYTES, bytes - SMALL_BYTES, MADV_HUGEPAGE);
}

int strip_bins_init(struct strip_bins *bins, uint32_t rows)
{
    uint64_t records = (uint64_t)rows * BIN_STRIPS_A_ROW;
    *bins = (struct strip_bins){.first = (uint32_t)(records / BIN_CHUNK_RECORDS) + STRIP_COUNT};
    bins->slab[0] = reserve_take(bins->first, sizeof *bins->slab[0]);
    if (!bins->slab[0])
        return -1;
    advise(bins->slab[0], bins->first);
    return 0;
}

/* Most rows are in one strip. Each strip's newest chunk is half full on average. */
void strip_bins_touch(const struct strip_bins *bins, uint32_t rows)
{
    uint32_t chunks = rows / BIN_CHUNK_RECORDS + STRIP_COUNT / 2;
    chunks = chunks < bins->first ? chunks : bins->first;
    prefault_own(bins->slab[0], chunks * sizeof *bins->slab[0]);
}

void strip_bins_free(struct strip_bins *bins)
{
    for (uint32_t i = 0; i < BIN_SLABS; i++)
        reserve_free(bins->slab[i]);
    memset(bins, 0, sizeof *bins);
}

void strip_bins_clear(struct strip_bins *bins)
{
    memset(bins->next, 0, sizeof bins->next);
    bins->at = bins->chunks = 0;
}

static void next_slab(struct strip_bins *bins)
{
    CHECK(bins->at + 1 < BIN_SLABS);
    struct bin_chunk **slab = &bins->slab[++bins->at];
    uint64_t chunks = (uint64_t)bins->first << bins->at;
    bins->chunks = 0;
    if (*slab)
        return;
    *slab = reserve_more(chunks, sizeof **slab);
    advise(*slab, chunks);
}

struct bin_record *strip_bins_chunk(struct strip_bins *bins, uint32_t strip)
{
    struct bin_record *next = bins->next[strip];
    if (bins->chunks == bins->first << bins->at)
        next_slab(bins);
    struct bin_chunk *chunk = &bins->slab[bins->at][bins->chunks++];
    chunk->before = next ? (struct bin_chunk *)(void *)next - 1 : NULL;
    chunk->before_that = chunk->before ? chunk->before->before : NULL;
    return chunk->record;
}
