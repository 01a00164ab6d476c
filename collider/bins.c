/* Chunks for bins, one after the other. */
#include "collider/bins.h"

#include "ipc/log.h"
#include "world/reserve.h"

#include <string.h>
#include <sys/mman.h>

/* From here on the chunks are in large pages, if there are any: chunks that share an entry of the
 * address translation cache are cheaper, as 400 places to write to would else exhaust it. */
#define SMALL_BYTES (UINT64_C(2) << 20)

int bins_init(struct bins *bins, uint32_t rows)
{
    uint64_t records = (uint64_t)rows * STRIP_COUNT;
    *bins = (struct bins){.capacity = (uint32_t)(records / BIN_CHUNK_RECORDS) + STRIP_COUNT};
    bins->chunk = reserve_take(bins->capacity, sizeof *bins->chunk);
    if (!bins->chunk)
        return -1;
    uint64_t bytes = bins->capacity * sizeof *bins->chunk;
    if (bytes > SMALL_BYTES) /* advice: no matter whether it is taken */
        (void)madvise((char *)bins->chunk + SMALL_BYTES, bytes - SMALL_BYTES, MADV_HUGEPAGE);
    return 0;
}

void bins_free(struct bins *bins)
{
    reserve_free(bins->chunk);
    memset(bins, 0, sizeof *bins);
}

void bins_clear(struct bins *bins)
{
    memset(bins->next, 0, sizeof bins->next);
    bins->chunks = 0;
}

struct bin_record *bins_chunk(struct bins *bins, uint32_t strip)
{
    struct bin_record *next = bins->next[strip];
    CHECK(bins->chunks < bins->capacity);
    struct bin_chunk *chunk = &bins->chunk[bins->chunks++];
    chunk->before = next ? (struct bin_chunk *)(void *)next - 1 : NULL;
    chunk->before_that = chunk->before ? chunk->before->before : NULL;
    return chunk->record;
}
