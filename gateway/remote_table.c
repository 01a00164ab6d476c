/* A hash table with chains. */
#include "gateway/remote_table.h"

#include "world/maths/random.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

int remote_table_open(struct remote_table *table, uint32_t capacity)
{
    *table = (struct remote_table){.capacity = capacity, .buckets = 1, .free = REMOTE_TABLE_NONE};
    while (table->buckets < 2 * capacity)
        table->buckets *= 2;
    table->entry = calloc(capacity + 1, sizeof *table->entry);
    table->bucket = malloc(table->buckets * sizeof *table->bucket);
    table->waiting = calloc(capacity + 1, sizeof *table->waiting);
    if (!table->entry || !table->bucket || !table->waiting) {
        remote_table_close(table);
        errno = ENOMEM;
        return -1;
    }
    memset(table->bucket, 0xff, table->buckets * sizeof *table->bucket);
    return 0;
}

void remote_table_close(struct remote_table *table)
{
    free(table->entry);
    free(table->bucket);
    free(table->waiting);
    *table = (struct remote_table){0};
}

static uint32_t *bucket_of(const struct remote_table *table, uint64_t remote)
{
    return &table->bucket[random_mix(remote) & (table->buckets - 1)];
}

struct remote_entry *remote_table_find(const struct remote_table *table, uint64_t remote)
{
    uint32_t i = *bucket_of(table, remote);
    while (i != REMOTE_TABLE_NONE && table->entry[i].remote != remote)
        i = table->entry[i].next;
    return i == REMOTE_TABLE_NONE ? NULL : &table->entry[i];
}

struct remote_entry *remote_table_add(struct remote_table *table, uint64_t remote, uint64_t now_ns)
{
    uint32_t *bucket = bucket_of(table, remote), i = table->free;
    if (i != REMOTE_TABLE_NONE)
        table->free = table->entry[i].next;
    else if (table->used < table->capacity)
        i = table->used++;
    else
        return NULL;
    table->entry[i] = (struct remote_entry){.listed = table->entry[i].listed,
                                            .remote = remote,
                                            .heard_ns = now_ns,
                                            .seen_ns = now_ns,
                                            .next = *bucket,
                                            .track.slot = SLOT_NONE};
    *bucket = i;
    table->count++;
    return &table->entry[i];
}

void remote_table_remove(struct remote_table *table, struct remote_entry *entry)
{
    uint32_t index = (uint32_t)(entry - table->entry), *link = bucket_of(table, entry->remote);
    while (*link != index)
        link = &table->entry[*link].next;
    *link = entry->next;
    *entry = (struct remote_entry){.next = table->free, .listed = entry->listed};
    table->free = index;
    table->count--;
}

uint64_t remote_table_owner(const struct udp_address *from)
{
    struct internet_address address = udp_address_internet(from);
    uint64_t half[2];
    memcpy(half, address.bytes, sizeof half);
    uint64_t host = random_mix(half[0] ^ random_mix(half[1] ^ random_mix(address.ipv6)));
    return host << REMOTE_TABLE_PORT_BITS | (address.port != 0 ? address.port : 1);
}

void remote_table_wait(struct remote_table *table, struct remote_entry *entry)
{
    entry->waits = true;
    if (!entry->listed)
        table->waiting[table->waiting_count++] = (uint32_t)(entry - table->entry);
    entry->listed = true;
}

void remote_table_see(struct remote_table *table, const struct snapshot *snapshot, uint64_t now_ns)
{
    const struct entities *e = &snapshot->entities;
    for (uint32_t row = 0; row < snapshot->head.used; row++) {
        if (!remote_is(e, row) || e->row[row].state == ENTITY_FREE)
            continue;
        struct remote_entry *entry = remote_table_find(table, e->row[row].driver);
        if (!entry)
            entry = remote_table_add(table, e->row[row].driver, now_ns);
        if (!entry)
            continue;
        if (!entry->placed || entry->owner == 0)
            entry->place = entities_position(e, row);
        entry->placed = true;
        entry->seen_ns = now_ns;
        entry->track.slot = row;
    }
}
