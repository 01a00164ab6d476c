/* The gateway's ring of records, which also is the memory of who owns which entity: a gateway that
 * starts anew reads the owners from it. An entity may be told seldom while others go round the
 * ring, so its owner is written again before its last record is overwritten. */
#ifndef JOLON_GATEWAY_REMOTE_RING_H
#define JOLON_GATEWAY_REMOTE_RING_H

#include "gateway/remote_table.h"
#include "ipc/segment/segment.h"

/* Adds a record to the ring, behind the owners that it would overwrite. The caller of a TRACK sets
 * told_at of its entry. taken: as in command_append(). Returns 0, or -1 with ENOBUFS when the ring
 * is full. */
int remote_ring_append(struct remote_table *table, struct view *view,
                       const struct remote_record *record, uint64_t taken);

#endif
