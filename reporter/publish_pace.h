/* When a topic of many entities writes its batches: ten times a second, in parts of few enough
 * entities, and in a share of the time. Belongs to one thread; does not block. */
#ifndef JOLON_REPORTER_PUBLISH_PACE_H
#define JOLON_REPORTER_PUBLISH_PACE_H

#include <stdbool.h>
#include <stdint.h>

/* Entities in one sample, far below what the types allow. Writing a sample takes about 5 ms, and
 * between two samples this process takes commands and sends its heartbeat. */
#define PUBLISH_PACE_PART 8192u

struct publish_pace {
    uint64_t begun_ns, spent_ns; /* of this batch */
    uint64_t due_ns;             /* when the next one is */
};

/* Returns true if a batch is due, and plans the next one. now_ns: of the monotonic clock. */
bool publish_pace_due(struct publish_pace *pace, uint64_t now_ns);

/* Notes that a batch begins. */
void publish_pace_begin(struct publish_pace *pace, uint64_t now_ns);

/* Notes that a part of the batch took so long. The next batch is put off if this one takes more
 * than its share of the time. */
void publish_pace_spent(struct publish_pace *pace, uint64_t spent_ns);

/* Returns the parts of a batch of so many entities, at least 1. room: entities of a part. */
uint32_t publish_pace_parts(uint32_t entities, uint32_t room);

#endif
