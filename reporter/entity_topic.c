/* Publishes the entities of a frame. */
#include "reporter/entity_topic.h"

#include "ipc/process/clock.h"
#include "reporter/entity_sample.h"
#include "world/params.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(PUBLISH_PACE_PART <= jolon_ENTITIES_PER_BATCH, "batches in ipc/topics/status.idl");

static void free_rows(struct entity_topic *topic)
{
    free(topic->entity);
    free(topic->place);
    topic->entity = NULL;
    topic->place = NULL;
}

int entity_topic_open(struct entity_topic *topic, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct error_text *error)
{
    uint32_t capacity = view->header->capacity;
    *topic =
        (struct entity_topic){.room = capacity < PUBLISH_PACE_PART ? capacity : PUBLISH_PACE_PART};
    topic->wire.run = run;
    topic->writer = dds_topics_writer(link, TOPIC_ENTITIES, error);
    if (topic->writer < 0)
        return -1;
    const struct gateway_params *gateway = &view->world.params->gateway;
    projection_make(&topic->projection, gateway->latitude_deg, gateway->longitude_deg,
                    view->world.terrain.squares.world_m);
    topic->entity = calloc(topic->room, sizeof *topic->entity);
    topic->place = calloc(topic->room, sizeof *topic->place);
    if (!topic->entity || !topic->place || snapshot_init(&topic->snapshot, view) != 0) {
        free_rows(topic);
        return error_text_set(error, "entities: no memory for %u: %s", capacity, strerror(errno));
    }
    return 0;
}

void entity_topic_close(struct entity_topic *topic)
{
    snapshot_free(&topic->snapshot);
    free_rows(topic);
}

static uint32_t count_entities(const struct snapshot *snapshot)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row < snapshot->head.used; row++)
        count += snapshot->entities.row[row].state != ENTITY_FREE;
    return count;
}

/* Takes a new snapshot, to be written from its first row. Returns false when none could be
 * taken. */
static bool begin(struct entity_topic *topic, const struct view *view)
{
    const struct state_head *head = &topic->snapshot.head;
    if (snapshot_take_poses(&topic->snapshot, view) != 0)
        return false;
    topic->wire.frame = head->frame;
    topic->wire.sim_time_s = state_time_s(&view->world, head);
    topic->wire.total = count_entities(&topic->snapshot);
    topic->wire.part = 0;
    topic->wire.parts = publish_pace_parts(topic->wire.total, topic->room);
    topic->row = 0;
    return true;
}

static void write_part(struct entity_topic *topic, const struct world *world)
{
    const struct snapshot *snapshot = &topic->snapshot;
    uint32_t count = 0;
    for (; topic->row < snapshot->head.used && count < topic->room; topic->row++) {
        if (snapshot->entities.row[topic->row].state == ENTITY_FREE)
            continue;
        const struct entities *e = &snapshot->entities;
        projection_place(&topic->projection, e->row[topic->row].x, e->row[topic->row].z,
                         &topic->place[count].latitude_deg, &topic->place[count].longitude_deg);
        topic->entity[count++] = entity_sample_of(world, snapshot, topic->row);
    }
    topic->wire.entities._buffer = topic->entity;
    topic->wire.entities._length = topic->wire.entities._maximum = count;
    topic->wire.places._buffer = topic->place;
    topic->wire.places._length = topic->wire.places._maximum = count;
    (void)dds_write(topic->writer, &topic->wire); /* the next batch replaces a lost one */
    topic->busy = ++topic->wire.part < topic->wire.parts;
}

bool entity_topic_publish(struct entity_topic *topic, const struct view *view, uint64_t now_ns)
{
    if (!topic->busy) {
        if (!publish_pace_due(&topic->pace, now_ns) ||
            dds_topics_readers(topic->writer, NULL) == 0 || !begin(topic, view))
            return false;
        publish_pace_begin(&topic->pace, now_ns);
    }
    write_part(topic, &view->world);
    publish_pace_spent(&topic->pace, clock_now_ns() - now_ns);
    return topic->busy;
}
