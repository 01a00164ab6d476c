/* The topics: one table of their names, types and qualities of service, used by both ends.
 *
 * All are RELIABLE, TRANSIENT_LOCAL and KEEP_LAST with a bounded depth: a late reader gets the last
 * samples, and a stopped or slow reader never blocks the writer (KEEP_ALL would). */
#ifndef JOLON_IPC_TOPICS_DDS_TOPICS_H
#define JOLON_IPC_TOPICS_DDS_TOPICS_H

#include "ipc/topics/dds_link.h"
#include "world/entity/event.h"

enum dds_topic {
    TOPIC_WORLD,
    TOPIC_PROCESS,
    TOPIC_FRAME,
    TOPIC_ENTITIES,
#define X(tag, word) TOPIC_##tag,
    EVENT_TYPES_WITH_TOPIC(X)
#undef X
        TOPIC_COMMAND,
    TOPIC_REPLY,
    TOPIC_NAMES,
    TOPIC_MOTIONS,
    TOPIC_COUNT,
    TOPIC_EVENTS =
        TOPIC_ENTITIES + 1 /* the first of EVENT_TOPIC_COUNT, in the order of the types */
};

/* Makes a reader or writer of the topic in the link's partition, which ends with the link. Returns
 * the entity, or -1 with the reason. */
dds_entity_t dds_topics_reader(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error);
dds_entity_t dds_topics_writer(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error);

/* Makes a wait set that wakes when one of the readers has new samples. Returns the entity, or -1
 * with the reason. */
dds_entity_t dds_topics_waitset(const struct dds_link *link, const dds_entity_t *readers,
                                size_t count, struct error_text *error);

/* Returns how many readers a writer has now. ever: NULL, or set to how many it has ever had. */
uint32_t dds_topics_readers(dds_entity_t writer, uint32_t *ever);

/* Returns true if the writer of a sample is no longer matched with the reader, and another writer
 * is. */
bool dds_topics_writer_left(dds_entity_t reader, dds_instance_handle_t writer);

/* Replaces a reader by a new one, also in its wait set unless that is 0, to get the samples that
 * writers keep for late readers. If that fails the old reader stays. */
void dds_topics_reopen(const struct dds_link *link, enum dds_topic topic, dds_entity_t waitset,
                       dds_entity_t *reader);

/* Waits for new samples or the timeout. */
void dds_topics_wait(dds_entity_t waitset, uint64_t timeout_ns);

#endif
