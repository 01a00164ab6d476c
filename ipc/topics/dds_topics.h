/* The topics: one table of their names, types and qualities of service, used by both ends.
 *
 * All are RELIABLE, TRANSIENT_LOCAL and KEEP_LAST with a bounded depth: a late reader gets the last
 * samples, and a stopped or slow one never blocks the writer (KEEP_ALL would). */
#ifndef JOLON_IPC_TOPICS_DDS_TOPICS_H
#define JOLON_IPC_TOPICS_DDS_TOPICS_H

#include "ipc/topics/dds_link.h"

enum dds_topic {
    TOPIC_WORLD,
    TOPIC_PROCESS,
    TOPIC_FRAME,
    TOPIC_ENTITIES,
    TOPIC_COLLISION,
    TOPIC_FIRE,
    TOPIC_DETONATION,
    TOPIC_CRATER,
    TOPIC_AGENT,
    TOPIC_COMMAND,
    TOPIC_REPLY,
    TOPIC_NAMES,
    TOPIC_COUNT
};

/* A reader or writer of the topic in the link's partition; it ends with the link. The entity, or
 * -1 with the reason. */
dds_entity_t dds_topics_reader(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error);
dds_entity_t dds_topics_writer(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error);

/* A wait set that wakes when one of the readers has new samples. The entity, or -1 with reason. */
dds_entity_t dds_topics_waitset(const struct dds_link *link, const dds_entity_t *readers,
                                size_t count, struct error_text *error);

/* Has the writer of a sample left the reader, and another is there? */
bool dds_topics_orphaned(dds_entity_t reader, dds_instance_handle_t writer);

/* Puts a new reader in place of one, also in its wait set if that is not 0: it gets again what
 * writers keep for late readers. If there can be none the old one stays. */
void dds_topics_ask_again(const struct dds_link *link, enum dds_topic topic, dds_entity_t waitset,
                          dds_entity_t *reader);

/* Waits for new samples or the timeout. */
void dds_topics_wait(dds_entity_t waitset, uint64_t timeout_ns);

#endif
