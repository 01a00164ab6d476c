/* Publishes the entities of a frame. */
#include "reporter/entity_topic.h"

#include "ipc/process/clock.h"
#include "world/entity/grounded.h"
#include "world/entity/spool.h"
#include "world/params.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(ENTITY_TOPIC_PART <= jolon_ENTITIES_PER_BATCH, "batches in ipc/topics/status.idl");
_Static_assert((int)jolon_ENTITY_FREE == (int)ENTITY_FREE &&
                   (int)jolon_ENTITY_WRECK == (int)ENTITY_WRECK,
               "entity states in ipc/topics/status.idl");
_Static_assert((int)jolon_GEAR_LOW == (int)GEAR_LOW && (int)GEAR_COUNT == (int)jolon_GEAR_LOW + 1,
               "gears in ipc/topics/status.idl");

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
        (struct entity_topic){.room = capacity < ENTITY_TOPIC_PART ? capacity : ENTITY_TOPIC_PART};
    topic->wire.run = run;
    topic->dt_s = world_dt_s(&view->world);
    topic->kinds = view->world.kinds;
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

/* tick is the frame's, dt_s the duration of a tick. */
static void fill(jolon_Entity *to, const struct entities *from, uint32_t row, uint64_t tick,
                 double dt_s)
{
    uint32_t ready = from->reload_tick[row];
    *to = (jolon_Entity){
        .id = from->id[row],
        .kind = from->kind[row],
        .state = (jolon_EntityState)from->state[row],
        .force = (jolon_Force)from->force[row],
        .behaviour = (jolon_Behaviour)from->behaviour[row],
        .damage = (jolon_Damage)from->damage[row],
        .x_m = from->x[row],
        .y_m = from->y[row],
        .z_m = from->z[row],
        .vx_mps = (float)from->vx[row],
        .vy_mps = (float)from->vy[row],
        .vz_mps = (float)from->vz[row],
        .heading_rad = (float)from->heading[row],
        .pitch_rad = (float)from->pitch[row],
        .roll_rad = (float)from->roll[row],
        .turret_rad = from->turret[row],
        .gun_rad = from->gun[row],
        .target = from->target_id[row],
        .rounds = from->rounds[row],
        .fuel_l = (float)from->fuel_l[row],
        .driver = from->driver[row],
        .throttle = from->throttle[row],
        .gear = (jolon_Gear)entity_gear(from->flags[row]),
        .reload_s = ready > tick ? (float)((double)(ready - tick) * dt_s) : 0.0f,
    };
}

static uint32_t count_entities(const struct snapshot *snapshot)
{
    uint32_t count = 0;
    for (uint32_t row = 0; row < snapshot->head.used; row++)
        count += snapshot->entities.state[row] != ENTITY_FREE;
    return count;
}

static bool has_subscribers(const struct entity_topic *topic)
{
    dds_publication_matched_status_t matched;
    return dds_get_publication_matched_status(topic->writer, &matched) >= 0 &&
           matched.current_count > 0;
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
    topic->wire.parts = topic->wire.total ? (topic->wire.total + topic->room - 1) / topic->room : 1;
    topic->row = 0;
    return true;
}

static void write_part(struct entity_topic *topic)
{
    const struct snapshot *snapshot = &topic->snapshot;
    uint32_t count = 0;
    for (; topic->row < snapshot->head.used && count < topic->room; topic->row++) {
        if (snapshot->entities.state[topic->row] == ENTITY_FREE)
            continue;
        fill(&topic->entity[count], &snapshot->entities, topic->row, snapshot->head.tick,
             topic->dt_s);
        const struct entities *e = &snapshot->entities;
        const struct kind *kind = &topic->kinds[e->kind[topic->row]];
        projection_place(&topic->projection, e->x[topic->row], e->z[topic->row],
                         &topic->place[count].latitude_deg, &topic->place[count].longitude_deg);
        topic->entity[count].grounded = grounded_of(e, kind, topic->row);
        topic->entity[count++].spool = (float)spool_of(e, kind, topic->row);
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
        if (now_ns < topic->due_ns)
            return false;
        topic->due_ns += ENTITY_TOPIC_PERIOD_NS;
        if (topic->due_ns <= now_ns)
            topic->due_ns = now_ns + ENTITY_TOPIC_PERIOD_NS;
        if (!has_subscribers(topic) || !begin(topic, view))
            return false;
        topic->begun_ns = now_ns;
        topic->spent_ns = 0;
    }
    write_part(topic);
    topic->spent_ns += clock_now_ns() - now_ns;
    if (topic->spent_ns * ENTITY_TOPIC_SHARE > ENTITY_TOPIC_PERIOD_NS)
        topic->due_ns = topic->begun_ns + topic->spent_ns * ENTITY_TOPIC_SHARE;
    return topic->busy;
}
