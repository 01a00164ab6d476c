/* Copies the topics' samples into the mirror. */
#include "ipc/topics/world_mirror.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/segment/role.h"
#include "ipc/topics/samples.h"

#include <stdlib.h>
#include <string.h>

int world_mirror_open(struct world_mirror *mirror, const struct dds_link *link, const char *world,
                      enum world_mirror_entities entities, struct error_text *error)
{
    *mirror = (struct world_mirror){
        .link = link,
        .name = world,
        .topic = {TOPIC_WORLD, TOPIC_PROCESS, TOPIC_FRAME,
                  entities == WORLD_MIRROR_MOTIONS ? TOPIC_MOTIONS : TOPIC_ENTITIES},
        .readers = entities == WORLD_MIRROR_NOTHING ? WORLD_MIRROR_ENTITIES : WORLD_MIRROR_READERS};
    for (int i = 0; i < mirror->readers; i++) {
        mirror->reader[i] = dds_topics_reader(link, mirror->topic[i], error);
        if (mirror->reader[i] < 0)
            return -1;
    }
    if (names_reader_open(&mirror->names_reader, link, error) != 0)
        return -1;
    mirror->waitset = dds_topics_waitset(link, mirror->reader, (size_t)mirror->readers, error);
    return mirror->waitset < 0 ? -1 : 0;
}

void world_mirror_close(struct world_mirror *mirror)
{
    name_table_close(&mirror->names);
    motion_mirrors_close(&mirror->motions);
    free(mirror->batch.entity);
    free(mirror->pending.entity);
    mirror->batch.entity = mirror->pending.entity = NULL;
}

static void take_world(struct world_mirror *mirror, const void *sample)
{
    const jolon_WorldInfo *world = sample;
    if (mirror->has_world && mirror->world.run != world->run) {
        mirror->role_count = 0; /* another world under the same name */
        mirror->has_batch = false;
        mirror->frame_ns = 0;
    }
    mirror->world = *world;
    memcpy(mirror->kinds, world->kinds._buffer, world->kinds._length * sizeof *mirror->kinds);
    mirror->world.kinds._buffer = mirror->kinds;
    mirror->has_world = true;
}

/* Roles are kept in the order of their table, in whatever order they come. */
static void take_process(struct world_mirror *mirror, const void *sample)
{
    const jolon_ProcessStatus *status = sample;
    uint32_t i = 0;
    while (i < mirror->role_count && strcmp(mirror->role[i].role, status->role) != 0)
        i++;
    if (i == WORLD_MIRROR_ROLES_MAX)
        return;
    if (i == mirror->role_count) {
        mirror->role_count++;
        for (; i > 0 && role_find(mirror->role[i - 1].role) > role_find(status->role); i--)
            mirror->role[i] = mirror->role[i - 1];
    }
    mirror->role[i] = *status;
}

static void take_frame(struct world_mirror *mirror, const void *sample)
{
    mirror->frame = *(const jolon_FrameStatus *)sample;
    mirror->frame_ns = clock_now_ns();
}

/* Makes room for count more entities. Returns false without memory. */
static bool grow(struct world_mirror_batch *batch, uint32_t count)
{
    if (count <= batch->room - batch->count)
        return true;
    uint32_t room = batch->count + count;
    jolon_Entity *entity = realloc(batch->entity, room * sizeof *entity);
    if (!entity)
        return false;
    batch->entity = entity;
    batch->room = room;
    return true;
}

static void take_motions(struct world_mirror *mirror, const void *sample, uint64_t writer)
{
    struct world_mirror_batch *batch = &mirror->batch;
    struct motion_mirror *motions = motion_mirrors_for(&mirror->motions, writer);
    if (!motion_mirror_take(motions, sample))
        return;
    batch->count = 0;
    if (!grow(batch, motions->count))
        return; /* without memory there are no entities to be seen */
    motion_mirror_entities(motions, batch->entity);
    batch->count = motions->count;
    batch->run = motions->run;
    batch->frame = motions->frame;
    mirror->has_batch = true;
}

static void take_entities(struct world_mirror *mirror, const void *sample)
{
    const jolon_EntityBatch *from = sample;
    struct world_mirror_batch *pending = &mirror->pending;
    uint32_t count = from->entities._length;
    if (from->parts > WORLD_MIRROR_PARTS_MAX)
        return;
    if (from->frame != pending->frame || from->run != pending->run || pending->parts_left == 0) {
        pending->frame = from->frame;
        pending->run = from->run;
        pending->parts_left = from->parts;
        pending->count = 0;
        memset(pending->part, 0, sizeof pending->part);
    }
    if (from->part >= WORLD_MIRROR_PARTS_MAX || pending->part[from->part])
        return;
    /* On inconsistent parts, or without memory, this frame's entities are not shown. */
    if (count > from->total - (pending->count < from->total ? pending->count : from->total) ||
        !grow(pending, count)) {
        pending->parts_left = 0;
        return;
    }
    pending->part[from->part] = true;
    if (count)
        memcpy(pending->entity + pending->count, from->entities._buffer,
               count * sizeof *pending->entity);
    pending->count += count;
    if (--pending->parts_left == 0) {
        struct world_mirror_batch whole = *pending;
        *pending = mirror->batch;
        pending->parts_left = 0;
        mirror->batch = whole;
        mirror->has_batch = true;
    }
}

static void take(struct world_mirror *mirror, enum dds_topic topic, const void *sample,
                 dds_instance_handle_t writer)
{
    if (topic == TOPIC_WORLD)
        take_world(mirror, sample);
    else if (topic == TOPIC_PROCESS)
        take_process(mirror, sample);
    else if (topic == TOPIC_FRAME)
        take_frame(mirror, sample);
    else if (topic == TOPIC_ENTITIES)
        take_entities(mirror, sample);
    else
        take_motions(mirror, sample, writer);
}

/* WorldInfo is written once. When its writer has left, a new reader gets it from the successor. */
static void check_world_writer(struct world_mirror *mirror)
{
    if (!mirror->has_world || !log_due(&mirror->looked_ns, WORLD_MIRROR_LOOK_NS) ||
        !dds_topics_writer_left(mirror->reader[WORLD_MIRROR_WORLD], mirror->world_writer))
        return;
    dds_topics_reopen(mirror->link, TOPIC_WORLD, mirror->waitset,
                      &mirror->reader[WORLD_MIRROR_WORLD]);
}

void world_mirror_take(struct world_mirror *mirror)
{
    const bool single = dds_link_is_single(mirror->link);
    for (int i = 0; i < mirror->readers; i++) {
        struct samples from = {.reader = mirror->reader[i], .topic = mirror->topic[i]};
        while (samples_next(&from)) {
            if (!single)
                continue; /* of which world it is cannot be told */
            take(mirror, mirror->topic[i], from.sample, from.writer);
            if (i == WORLD_MIRROR_WORLD)
                mirror->world_writer = from.writer;
        }
    }
    check_world_writer(mirror);
    names_reader_take(&mirror->names_reader, &mirror->names);
}

void world_mirror_wait(const struct world_mirror *mirror, uint64_t until_ns)
{
    uint64_t now_ns = clock_now_ns();
    if (now_ns < until_ns)
        dds_topics_wait(mirror->waitset, until_ns - now_ns);
}

bool world_mirror_live(const struct world_mirror *mirror, uint64_t now_ns)
{
    return mirror->frame_ns && now_ns - mirror->frame_ns < WORLD_MIRROR_SILENCE_NS;
}

bool world_mirror_whole(const struct world_mirror *mirror)
{
    return mirror->has_world && mirror->frame_ns && mirror->role_count &&
           ((mirror->has_batch && mirror->names.known) || mirror->readers <= WORLD_MIRROR_ENTITIES);
}

const jolon_Entity *world_mirror_entity(const struct world_mirror *mirror, uint32_t id)
{
    for (uint32_t i = 0; mirror->has_batch && id && i < mirror->batch.count; i++) {
        if (mirror->batch.entity[i].id == id)
            return &mirror->batch.entity[i];
    }
    return NULL;
}

const jolon_KindInfo *world_mirror_kind(const struct world_mirror *mirror, uint32_t kind)
{
    return mirror->has_world && kind < mirror->world.kinds._length ? &mirror->kinds[kind] : NULL;
}

const char *world_mirror_kind_name(const struct world_mirror *mirror, uint32_t kind)
{
    return mirror->has_world && kind < mirror->world.kinds._length ? mirror->kinds[kind].name : "?";
}

const char *world_mirror_process_state(jolon_ProcessState state)
{
    static const char *const names[] = {"absent", "starting", "ready", "stopping", "dead"};
    return (unsigned)state < sizeof names / sizeof names[0] ? names[state] : "?";
}

const char *world_mirror_run_state(const struct world_mirror *mirror, uint64_t now_ns)
{
    static const char *const names[] = {"running", "paused", "finished", "stopped", "stalled"};
    if (!mirror->frame_ns)
        return "waiting";
    if (!world_mirror_live(mirror, now_ns))
        return "silent";
    unsigned state = (unsigned)mirror->frame.state;
    return state < sizeof names / sizeof names[0] ? names[state] : "?";
}
