/* Publishes the entities of a frame, in one sample, or in several for a large world. */
#ifndef JOLON_REPORTER_ENTITY_TOPIC_H
#define JOLON_REPORTER_ENTITY_TOPIC_H

#include "ipc/frame/snapshot.h"
#include "ipc/topics/dds_topics.h"
#include "reporter/publish_pace.h"
#include "world/terrain/projection.h"

#include "status.h"

struct entity_topic {
    dds_entity_t writer;
    struct snapshot snapshot;
    jolon_Entity *entity; /* [room] */
    jolon_Degrees *place; /* [room] theirs */
    struct projection projection;
    uint32_t room;
    jolon_EntityBatch wire; /* the next part to be written */
    bool busy;              /* parts of the snapshot are still to be written */
    uint32_t row;           /* where the next part begins */
    struct publish_pace pace;
};

/* Makes the writer. Returns 0, or -1 with the reason. */
int entity_topic_open(struct entity_topic *topic, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error);
void entity_topic_close(struct entity_topic *topic);

/* Writes a part of the last committed frame's entities if that is due and there are readers.
 * Returns true when further parts wait for the next call. */
bool entity_topic_publish(struct entity_topic *topic, const struct view *view, uint64_t now_ns);

#endif
