/* Chunks for bins, out of slabs that are kept. */
#include "collider/bins.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* A slab is as large as all before it, up to a large page: its chunks then share one entry of the
 * address translation cache, which 400 places to write to would else exhaust. */
#define SLAB_LEAST 65536u
#define SLAB_MOST  (2u << 20)

void bins_clear(struct bins *bins)
{
    memset(bins->next, 0, sizeof bins->next);
    bins->slab_now = 0;
    bins->chunk_now = 0;
}

void bins_free(struct bins *bins)
{
    for (uint32_t i = 0; i < bins->slabs; i++)
        free(bins->slab[i].chunk);
    free(bins->slab);
    memset(bins, 0, sizeof *bins);
}

static int add_slab(struct bins *bins)
{
    uint32_t bytes = SLAB_LEAST;
    for (uint32_t i = 1; i < bins->slabs && bytes < SLAB_MOST; i++)
        bytes *= 2;
    struct bin_slab *list = realloc(bins->slab, (bins->slabs + 1) * sizeof *list);
    if (!list)
        return -1;
    bins->slab = list;
    struct bin_chunk *chunk = aligned_alloc(bytes, bytes);
    if (!chunk)
        return -1;
    if (bytes == SLAB_MOST)
        madvise(chunk, bytes, MADV_HUGEPAGE); /* advice: no matter whether it is taken */
    list[bins->slabs++] = (struct bin_slab){chunk, bytes / BIN_CHUNK_BYTES};
    return 0;
}

struct bin_record *bins_chunk(struct bins *bins, uint32_t strip)
{
    struct bin_record *next = bins->next[strip];
    if (bins->slab_now < bins->slabs && bins->chunk_now == bins->slab[bins->slab_now].chunks) {
        bins->slab_now++;
        bins->chunk_now = 0;
    }
    if (bins->slab_now == bins->slabs && add_slab(bins) != 0)
        return NULL;
    struct bin_chunk *chunk = &bins->slab[bins->slab_now].chunk[bins->chunk_now++];
    chunk->before = next ? (struct bin_chunk *)(void *)next - 1 : NULL;
    chunk->before_that = chunk->before ? chunk->before->before : NULL;
    return chunk->record;
}
