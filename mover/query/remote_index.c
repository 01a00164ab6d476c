/* A hash table with chains through the rows. */
#include "mover/query/remote_index.h"

#include "world/entity/remote.h"
#include "world/maths/random.h"
#include "world/runtime/prefault.h"

#include <stdlib.h>
#include <string.h>

int remote_index_init(struct remote_index *index, uint32_t capacity, uint32_t remotes_max)
{
    *index = (struct remote_index){.buckets = 1, .capacity = capacity};
    if (remotes_max == 0)
        return 0;
    while (index->buckets < remotes_max)
        index->buckets *= 2;
    index->bucket = malloc(index->buckets * sizeof *index->bucket);
    index->next = malloc(capacity * sizeof *index->next);
    if (index->bucket && index->next)
        return 0;
    remote_index_free(index);
    return -1;
}

void remote_index_free(struct remote_index *index)
{
    free(index->bucket);
    free(index->next);
    *index = (struct remote_index){0};
}

void remote_index_touch(const struct remote_index *index)
{
    if (!index->bucket)
        return;
    prefault_own(index->bucket, index->buckets * sizeof *index->bucket);
    prefault_own(index->next, index->capacity * sizeof *index->next);
}

void remote_index_forget(struct remote_index *index)
{
    index->made = false;
}

static uint32_t *bucket_of(const struct remote_index *index, uint64_t remote)
{
    return &index->bucket[random_mix(remote) & (index->buckets - 1)];
}

static void put(struct remote_index *index, uint32_t row, uint64_t remote)
{
    uint32_t *bucket = bucket_of(index, remote);
    index->next[row] = *bucket;
    *bucket = row;
    index->count++;
}

/* From the last row to the first, so that a chain has the first one first. */
static void make(struct remote_index *index, const struct entities *e, uint32_t used)
{
    memset(index->bucket, 0xff, index->buckets * sizeof *index->bucket);
    index->count = 0;
    for (uint32_t row = used; row-- > 0;) {
        if (remote_is(e, row))
            put(index, row, e->row[row].driver);
    }
    index->made = true;
}

uint32_t remote_index_find(struct remote_index *index, const struct entities *e, uint32_t used,
                           uint64_t remote)
{
    if (!index->bucket)
        return SLOT_NONE;
    if (!index->made)
        make(index, e, used);
    uint32_t row = *bucket_of(index, remote);
    while (row != SLOT_NONE && e->row[row].driver != remote)
        row = index->next[row];
    return row;
}

void remote_index_add(struct remote_index *index, uint32_t row, uint64_t remote)
{
    if (index->made)
        put(index, row, remote);
}

void remote_index_remove(struct remote_index *index, uint32_t row, uint64_t remote)
{
    if (!index->made)
        return;
    uint32_t *link = bucket_of(index, remote);
    while (*link != SLOT_NONE && *link != row)
        link = &index->next[*link];
    if (*link == SLOT_NONE)
        return;
    *link = index->next[row];
    index->count--;
}
