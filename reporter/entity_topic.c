/* The entities of a frame onto their topic. */
#include "reporter/entity_topic.h"

#include "ipc/process/clock.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(ENTITY_TOPIC_PART <= jolon_ENTITIES_PER_BATCH, "batches in ipc/topics/status.idl");
_Static_assert((int)jolon_ENTITY_FREE == (int)ENTITY_FREE &&
                   (int)jolon_ENTITY_WRECK == (int)ENTITY_WRECK,
               "entity states in ipc/topics/status.idl");
_Static_assert((int)jolon_GEAR_LOW == (int)GEAR_LOW && (int)GEAR_COUNT == (int)jolon_GEAR_LOW + 1,
               "gears in ipc/topics/status.idl");

int entity_topic_open(struct entity_topic *batch, const struct view *view,
                      const struct dds_link *link, uint64_t run, struct reason *reason)
{
    uint32_t capacity = view->header->capacity;
    *batch =
        (struct entity_topic){.room = capacity < ENTITY_TOPIC_PART ? capacity : ENTITY_TOPIC_PART};
    batch->wire.run = run;
    batch->dt_s = world_dt_s(&view->world);
    batch->writer = dds_topics_writer(link, TOPIC_ENTITIES, reason);
    if (batch->writer < 0)
        return -1;
    batch->entity = calloc(batch->room, sizeof *batch->entity);
    if (!batch->entity || snapshot_init(&batch->snapshot, view) != 0) {
        free(batch->entity);
        batch->entity = NULL;
        return reason_set(reason, "entities: no memory for %u: %s", capacity, strerror(errno));
    }
    return 0;
}

void entity_topic_close(struct entity_topic *batch)
{
    snapshot_free(&batch->snapshot);
    free(batch->entity);
    batch->entity = NULL;
}

/* tick: of the frame; dt_s: of a tick. */
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

static bool anybody_reads(const struct entity_topic *batch)
{
    dds_publication_matched_status_t matched;
    return dds_get_publication_matched_status(batch->writer, &matched) >= 0 &&
           matched.current_count > 0;
}

/* A new snapshot, to be written from its first row; false when there is none to be had. */
static bool begin(struct entity_topic *batch, const struct view *view)
{
    const struct state_head *head = &batch->snapshot.head;
    if (snapshot_take(&batch->snapshot, view) != 0)
        return false;
    batch->wire.frame = head->frame;
    batch->wire.sim_time_s = state_time_s(&view->world, head);
    batch->wire.total = count_entities(&batch->snapshot);
    batch->wire.part = 0;
    batch->wire.parts = batch->wire.total ? (batch->wire.total + batch->room - 1) / batch->room : 1;
    batch->row = 0;
    return true;
}

static void write_part(struct entity_topic *batch)
{
    const struct snapshot *snapshot = &batch->snapshot;
    uint32_t count = 0;
    for (; batch->row < snapshot->head.used && count < batch->room; batch->row++) {
        if (snapshot->entities.state[batch->row] != ENTITY_FREE)
            fill(&batch->entity[count++], &snapshot->entities, batch->row, snapshot->head.tick,
                 batch->dt_s);
    }
    batch->wire.entities._buffer = batch->entity;
    batch->wire.entities._length = batch->wire.entities._maximum = count;
    (void)dds_write(batch->writer, &batch->wire); /* the next batch makes up for a lost one */
    batch->busy = ++batch->wire.part < batch->wire.parts;
}

bool entity_topic_publish(struct entity_topic *batch, const struct view *view, uint64_t now_ns)
{
    if (!batch->busy) {
        if (now_ns < batch->due_ns)
            return false;
        batch->due_ns += ENTITY_TOPIC_PERIOD_NS;
        if (batch->due_ns <= now_ns)
            batch->due_ns = now_ns + ENTITY_TOPIC_PERIOD_NS;
        if (!anybody_reads(batch) || !begin(batch, view))
            return false;
        batch->begun_ns = now_ns;
        batch->spent_ns = 0;
    }
    write_part(batch);
    batch->spent_ns += clock_now_ns() - now_ns;
    if (batch->spent_ns * ENTITY_TOPIC_SHARE > ENTITY_TOPIC_PERIOD_NS)
        batch->due_ns = batch->begun_ns + batch->spent_ns * ENTITY_TOPIC_SHARE;
    return batch->busy;
}
