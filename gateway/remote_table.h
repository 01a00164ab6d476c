/* What the gateway knows of the entities of other simulators: which row each has, from whom and
 * when it was heard, and what the world has not been told yet. It is a cache: a gateway that starts
 * anew fills it from the rows of the world. */
#ifndef JOLON_GATEWAY_REMOTE_TABLE_H
#define JOLON_GATEWAY_REMOTE_TABLE_H

#include "gateway/udp/udp_address.h"
#include "ipc/frame/snapshot.h"
#include "world/entity/remote.h"

#define REMOTE_TABLE_NONE UINT32_MAX

struct remote_entry {
    uint64_t remote;   /* remote_id(), 0: the entry is free */
    uint64_t heard_ns; /* when its last Entity State came */
    uint64_t told_ns;  /* when the world was last told */
    uint64_t seen_ns;  /* when a snapshot last had its row */
    struct vec3 place; /* [m] where its owner had it last */
    uint64_t owner;    /* remote_table_owner() of its owner, 0: nobody knows */
    uint64_t told_at;  /* the number of the record in the ring that told the world last */
    uint32_t stamp;    /* of the last Entity State that was taken, from heard_ns on */
    bool placed;
    bool waits;    /* track is to be told */
    bool listed;   /* the table's list of those that wait has it */
    uint32_t next; /* in its bucket, or in the list of free entries */
    struct remote_record track;
};

struct remote_table {
    struct remote_entry *entry; /* [capacity] */
    uint32_t *bucket;           /* [buckets] index of the first entry */
    uint32_t *waiting;          /* [waiting_count] indices of entries, of which some wait */
    uint32_t waiting_count;
    uint32_t capacity, buckets, count, free;
    uint32_t used; /* entries that were ever in use: the first ones */
};

/* Reserves memory for so many entities. Returns 0, or -1 with errno ENOMEM. */
int remote_table_open(struct remote_table *table, uint32_t capacity);
void remote_table_close(struct remote_table *table);

/* Returns the entry of an entity, NULL when there is none. */
struct remote_entry *remote_table_find(const struct remote_table *table, uint64_t remote);

/* Adds an entry that the table does not have. NULL when the table is full. */
struct remote_entry *remote_table_add(struct remote_table *table, uint64_t remote, uint64_t now_ns);

void remote_table_remove(struct remote_table *table, struct remote_entry *entry);

/* Returns a number for an address and its port, never 0, by which owners are told apart. It is in
 * the records of the ring, so that a gateway that starts anew knows the owners. The upper 48 bits
 * are those of the address. */
uint64_t remote_table_owner(const struct udp_address *from);
#define REMOTE_TABLE_PORT_BITS 16u

/* Notes that the entry's track is to be told. */
void remote_table_wait(struct remote_table *table, struct remote_entry *entry);

/* Takes the rows of remote entities from a snapshot: an entry for each, with its row. */
void remote_table_see(struct remote_table *table, const struct snapshot *snapshot, uint64_t now_ns);

#endif
