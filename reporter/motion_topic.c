/* Tells motions in batches. */
#include "reporter/motion_topic.h"

#include "ipc/process/clock.h"
#include "ipc/topics/entity_place.h"
#include "reporter/entity_sample.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(PUBLISH_PACE_PART <= jolon_ENTITIES_PER_BATCH, "batches in ipc/topics/status.idl");

static void free_memory(struct motion_topic *topic)
{
    motion_table_free(&topic->table);
    free(topic->row);
    free(topic->entity);
    free(topic->course);
    topic->row = NULL;
    topic->entity = NULL;
    topic->course = NULL;
}

int motion_topic_open(struct motion_topic *topic, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error)
{
    uint32_t capacity = view->header->capacity;
    *topic =
        (struct motion_topic){.room = capacity < PUBLISH_PACE_PART ? capacity : PUBLISH_PACE_PART};
    topic->wire.run = run;
    topic->writer = dds_topics_writer(link, TOPIC_MOTIONS, error);
    if (topic->writer < 0)
        return -1;
    topic->row = calloc(topic->room, sizeof *topic->row);
    topic->entity = calloc(topic->room, sizeof *topic->entity);
    topic->course = calloc(topic->room, sizeof *topic->course);
    if (!topic->row || !topic->entity || !topic->course ||
        motion_table_init(&topic->table, capacity) != 0 ||
        snapshot_init(&topic->snapshot, view) != 0) {
        free_memory(topic);
        return error_text_set(error, "motions: no memory for %u: %s", capacity, strerror(errno));
    }
    return 0;
}

void motion_topic_close(struct motion_topic *topic)
{
    snapshot_free(&topic->snapshot);
    free_memory(topic);
}

/* Takes a new snapshot, to be told from its first row. Returns false when there are no readers, or
 * none could be taken. */
static bool begin(struct motion_topic *topic, const struct view *view, uint64_t now_ns)
{
    const struct state_head *head = &topic->snapshot.head;
    uint32_t readers;
    if (dds_topics_readers(topic->writer, &readers) == 0 ||
        snapshot_take(&topic->snapshot, view) != 0)
        return false;
    bool whole = readers != topic->readers || now_ns - topic->whole_ns >= MOTION_TOPIC_WHOLE_NS;
    if (whole) {
        topic->readers = readers;
        topic->whole_ns = now_ns;
        motion_table_clear(&topic->table);
    }
    motion_table_update(&topic->table, &view->world, &topic->snapshot);
    topic->wire.frame = head->frame;
    topic->wire.sim_time_s = state_time_s(&view->world, head);
    topic->wire.whole = whole;
    topic->wire.part = 0;
    topic->wire.parts = publish_pace_parts(topic->table.count, topic->room);
    topic->next = 0;
    return true;
}

/* Adds a row to the part that is made. */
static void add(struct motion_topic *topic, const struct view *view, uint32_t row, uint32_t at)
{
    const struct motion_told *told = &topic->table.told[row];
    const struct told_motion *motion = &told->motion;
    topic->row[at] = row;
    if (told->marks.state == ENTITY_FREE) {
        topic->entity[at] = (jolon_Entity){.id = told->id, .state = jolon_ENTITY_FREE};
        return;
    }
    topic->entity[at] = entity_sample_of(&view->world, &topic->snapshot, row);
    entity_place_set(&topic->entity[at], motion);
    if (motion->lasts_s > 0.0F)
        topic->course[topic->wire.courses._length++] =
            (jolon_Course){.entity = at,
                           .turn_rps = motion->turn_rps,
                           .pitch_rps = motion->pitch_rps,
                           .roll_rps = motion->roll_rps,
                           .gain_mps2 = motion->gain_mps2,
                           .climb_mps2 = motion->climb_mps2,
                           .lasts_s = motion->lasts_s};
}

static void write_part(struct motion_topic *topic, const struct view *view)
{
    const struct motion_table *table = &topic->table;
    uint32_t count = 0;
    topic->wire.courses._length = 0;
    for (; topic->next < table->used && count < topic->room; topic->next++) {
        if (motion_table_told(table, topic->next, table->frame))
            add(topic, view, topic->next, count++);
    }
    topic->wire.rows._buffer = topic->row;
    topic->wire.entities._buffer = topic->entity;
    topic->wire.courses._buffer = topic->course;
    topic->wire.rows._length = topic->wire.rows._maximum = count;
    topic->wire.entities._length = topic->wire.entities._maximum = count;
    topic->wire.courses._maximum = topic->wire.courses._length;
    (void)dds_write(topic->writer, &topic->wire); /* the next whole batch makes up for a lost one */
    topic->busy = ++topic->wire.part < topic->wire.parts;
}

bool motion_topic_publish(struct motion_topic *topic, const struct view *view, uint64_t now_ns)
{
    if (!topic->busy) {
        if (!publish_pace_due(&topic->pace, now_ns) || !begin(topic, view, now_ns))
            return false;
        publish_pace_begin(&topic->pace, now_ns);
    }
    write_part(topic, view);
    publish_pace_spent(&topic->pace, clock_now_ns() - now_ns);
    return topic->busy;
}
