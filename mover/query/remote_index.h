/* Which row each remote entity has, while the records of one frame are applied. It is made from the
 * rows when the first record of the frame asks for a row that its sender does not know, so that a
 * frame in which thousands of entities appear does not search all rows for each. Scratch memory:
 * nothing of it outlives the frame, and what it finds is what a search of the rows would find. One
 * thread. */
#ifndef JOLON_MOVER_QUERY_REMOTE_INDEX_H
#define JOLON_MOVER_QUERY_REMOTE_INDEX_H

#include "world/entity/entity.h"

struct remote_index {
    uint32_t *bucket; /* [buckets] its first row, or SLOT_NONE; NULL: no room for remote entities */
    uint32_t *next;   /* [capacity] the next row of the bucket, or SLOT_NONE */
    uint32_t buckets; /* a power of two */
    uint32_t capacity;
    uint32_t count; /* remote rows */
    bool made;      /* it holds the rows as they are */
};

/* Takes the memory for so many remote entities among so many rows; none if there are none. Returns
 * 0, or -1 with errno ENOMEM. */
int remote_index_init(struct remote_index *index, uint32_t capacity, uint32_t remotes_max);
void remote_index_free(struct remote_index *index);

/* Takes the pages of its memory. */
void remote_index_touch(const struct remote_index *index);

/* Forgets the rows, because others may have changed them. */
void remote_index_forget(struct remote_index *index);

/* Returns the first row of a remote entity, SLOT_NONE when there is none. used: rows in use. */
uint32_t remote_index_find(struct remote_index *index, const struct entities *e, uint32_t used,
                           uint64_t remote);

/* Note that a row has become that of a remote entity, and that it is to be removed. */
void remote_index_add(struct remote_index *index, uint32_t row, uint64_t remote);
void remote_index_remove(struct remote_index *index, uint32_t row, uint64_t remote);

#endif
