/* Publishes the entities that do not go on as their readers were told, for readers that compute
 * where the others are (world/entity/told_motion.h). Whole batches tell all entities: at once to a
 * new reader, and now and then for those that missed a sample. */
#ifndef JOLON_REPORTER_MOTION_TOPIC_H
#define JOLON_REPORTER_MOTION_TOPIC_H

#include "ipc/frame/motion_table.h"
#include "ipc/topics/dds_topics.h"
#include "reporter/publish_pace.h"

#include "status.h"

#define MOTION_TOPIC_WHOLE_NS 10000000000u /* between whole batches */

struct motion_topic {
    dds_entity_t writer;
    struct snapshot snapshot;
    struct motion_table table;
    uint32_t *row;        /* [room] */
    jolon_Entity *entity; /* [room] of these rows */
    jolon_Course *course; /* [room] */
    uint32_t room;
    jolon_MotionBatch wire; /* the next part to be written */
    bool busy;              /* parts of the snapshot are still to be written */
    uint32_t next;          /* the row with which the next part begins */
    uint32_t readers;       /* that there ever were */
    uint64_t whole_ns;      /* when the last whole batch began */
    struct publish_pace pace;
};

/* Makes the writer. Returns 0, or -1 with the reason. */
int motion_topic_open(struct motion_topic *topic, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error);
void motion_topic_close(struct motion_topic *topic);

/* Writes a part of a batch of the last committed frame if that is due and there are readers.
 * Returns true when further parts wait for the next call. */
bool motion_topic_publish(struct motion_topic *topic, const struct view *view, uint64_t now_ns);

#endif
