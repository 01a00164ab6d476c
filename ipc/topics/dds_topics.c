/* Topics, their qualities of service, readers, writers and the wait for samples. */
#include "ipc/topics/dds_topics.h"

#include "status.h"

/* How long a write may wait for room in the transport. The writer also has a heartbeat to send. */
#define WRITE_LIMIT DDS_MSECS(10)

/* Subscribers learn within this time that the writer was killed. Shorter leases are unreliable. */
#define LIVELINESS_LEASE DDS_SECS(1)

/* A late reader gets the writer's depth in one burst, and the samples that are written meanwhile on
 * top. A reader that keeps no more than the writer would lose some of them. */
#define READER_ROOM 4

static const struct {
    const char *name;
    const dds_topic_descriptor_t *descriptor;
    int32_t depth;           /* samples kept of each instance, for late and slow readers */
    dds_duration_t lifespan; /* 0: unlimited */
} table[TOPIC_COUNT] = {
    [TOPIC_WORLD] = {"WorldInfo", &jolon_WorldInfo_desc, 1, 0},
    [TOPIC_PROCESS] = {"ProcessStatus", &jolon_ProcessStatus_desc, 1, 0},
    [TOPIC_FRAME] = {"FrameStatus", &jolon_FrameStatus_desc, 1, 0},
    /* Batches are written only while there are readers: an old batch must not look current. */
    [TOPIC_ENTITIES] = {"EntityBatch", &jolon_EntityBatch_desc, 1, DDS_SECS(1)},
    [TOPIC_COLLISION] = {"CollisionEvent", &jolon_CollisionEvent_desc, 4096, 0},
    [TOPIC_FIRE] = {"FireEvent", &jolon_FireEvent_desc, 4096, 0},
    [TOPIC_DETONATION] = {"DetonationEvent", &jolon_DetonationEvent_desc, 4096, 0},
    [TOPIC_CRATER] = {"CraterEvent", &jolon_CraterEvent_desc, 4096, 0},
    [TOPIC_AGENT] = {"AgentEvent", &jolon_AgentEvent_desc, 4096, 0},
    [TOPIC_CONTACT_END] = {"ContactEndEvent", &jolon_ContactEndEvent_desc, 4096, 0},
    [TOPIC_COMMAND] = {"Command", &jolon_Command_desc, 256, 0},
    [TOPIC_REPLY] = {"CommandReply", &jolon_CommandReply_desc, 256, 0},
    [TOPIC_NAMES] = {"EntityNames", &jolon_EntityNames_desc, 1, 0},
    /* Without a key, so that the parts come in their order; a whole batch has at most 128. */
    [TOPIC_MOTIONS] = {"MotionBatch", &jolon_MotionBatch_desc, 256, DDS_SECS(1)},
};

_Static_assert(TOPIC_EVENTS + EVENT_TOPIC_COUNT == TOPIC_COMMAND, "event topics are in a row");

static dds_qos_t *make_qos(enum dds_topic topic, bool writer)
{
    int32_t depth = table[topic].depth;
    dds_qos_t *qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, WRITE_LIMIT);
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST,
                     writer || depth == 1 ? depth : depth * READER_ROOM);
    if (writer) {
        /* A late reader gets the depth of the durability service, not of the history. */
        dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                    DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
        dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, LIVELINESS_LEASE);
        if (table[topic].lifespan)
            dds_qset_lifespan(qos, table[topic].lifespan);
    }
    return qos;
}

static dds_entity_t make_end(const struct dds_link *link, enum dds_topic topic, bool writer,
                             struct error_text *error)
{
    const char *name = table[topic].name;
    dds_entity_t handle =
        dds_create_topic(link->participant, table[topic].descriptor, name, NULL, NULL);
    if (handle < 0)
        return error_text_set(error, "DDS topic %s: %s", name, dds_strretcode(handle));
    dds_qos_t *qos = make_qos(topic, writer);
    dds_entity_t end = writer ? dds_create_writer(link->publisher, handle, qos, NULL)
                              : dds_create_reader(link->subscriber, handle, qos, NULL);
    dds_delete_qos(qos);
    if (end < 0)
        return error_text_set(error, "DDS %s of %s: %s", writer ? "writer" : "reader", name,
                              dds_strretcode(end));
    return end;
}

dds_entity_t dds_topics_reader(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error)
{
    return make_end(link, topic, false, error);
}

dds_entity_t dds_topics_writer(const struct dds_link *link, enum dds_topic topic,
                               struct error_text *error)
{
    return make_end(link, topic, true, error);
}

static dds_return_t attach(dds_entity_t waitset, dds_entity_t reader)
{
    dds_return_t code = dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
    return code < 0 ? code : dds_waitset_attach(waitset, reader, reader);
}

uint32_t dds_topics_readers(dds_entity_t writer, uint32_t *ever)
{
    dds_publication_matched_status_t matched = {0};
    bool known = dds_get_publication_matched_status(writer, &matched) >= 0;
    if (ever)
        *ever = known ? matched.total_count : 0;
    return known ? matched.current_count : 0;
}

bool dds_topics_writer_left(dds_entity_t reader, dds_instance_handle_t writer)
{
    dds_instance_handle_t writers[16];
    dds_return_t count = dds_get_matched_publications(reader, writers, 16);
    for (int i = 0; i < count && i < 16; i++) {
        if (writers[i] == writer)
            return false;
    }
    return count > 0 && count <= 16; /* with more writers it may be one that was not listed */
}

void dds_topics_reopen(const struct dds_link *link, enum dds_topic topic, dds_entity_t waitset,
                       dds_entity_t *reader)
{
    struct error_text error;
    dds_entity_t replacement = dds_topics_reader(link, topic, &error);
    if (replacement < 0)
        return;
    if (waitset) {
        (void)dds_waitset_detach(waitset, *reader);
        (void)attach(waitset, replacement);
    }
    (void)dds_delete(*reader);
    *reader = replacement;
}

dds_entity_t dds_topics_waitset(const struct dds_link *link, const dds_entity_t *readers,
                                size_t count, struct error_text *error)
{
    dds_entity_t waitset = dds_create_waitset(link->participant);
    dds_return_t code = waitset;
    for (size_t i = 0; i < count && code >= 0; i++)
        code = attach(waitset, readers[i]);
    if (code < 0)
        return error_text_set(error, "DDS wait set: %s", dds_strretcode(code));
    return waitset;
}

void dds_topics_wait(dds_entity_t waitset, uint64_t timeout_ns)
{
    dds_attach_t triggered;
    (void)dds_waitset_wait(waitset, &triggered, 1, (dds_duration_t)timeout_ns);
}
