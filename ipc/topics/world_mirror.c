/* The topics' samples into the mirror. */
#include "ipc/topics/world_mirror.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/segment/role.h"
#include "ipc/topics/samples.h"

#include <stdlib.h>
#include <string.h>

static const enum dds_topic topics[WORLD_MIRROR_READERS] = {TOPIC_WORLD, TOPIC_PROCESS, TOPIC_FRAME,
                                                            TOPIC_ENTITIES};

int world_mirror_open(struct world_mirror *mirror, const struct dds_link *link, const char *world,
                      bool entities, struct error_text *error)
{
    *mirror =
        (struct world_mirror){.link = link,
                              .name = world,
                              .readers = entities ? WORLD_MIRROR_READERS : WORLD_MIRROR_ENTITIES};
    for (int i = 0; i < mirror->readers; i++) {
        mirror->reader[i] = dds_topics_reader(link, topics[i], error);
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
    free(mirror->batch.entity);
    free(mirror->coming.entity);
    mirror->batch.entity = mirror->coming.entity = NULL;
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

/* Kept in the order of the roles' table, in whatever order they come. */
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

/* Makes room for so many more; false without memory. */
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

static void take_entities(struct world_mirror *mirror, const void *sample)
{
    const jolon_EntityBatch *from = sample;
    struct world_mirror_batch *coming = &mirror->coming;
    uint32_t count = from->entities._length;
    if (from->parts > WORLD_MIRROR_PARTS_MAX)
        return;
    if (from->frame != coming->frame || from->run != coming->run || coming->parts_left == 0) {
        coming->frame = from->frame;
        coming->run = from->run;
        coming->parts_left = from->parts;
        coming->count = 0;
        memset(coming->part, 0, sizeof coming->part);
    }
    if (from->part >= WORLD_MIRROR_PARTS_MAX || coming->part[from->part])
        return;
    /* Parts that do not belong together, or no memory: this frame's entities are not shown. */
    if (count > from->total - (coming->count < from->total ? coming->count : from->total) ||
        !grow(coming, count)) {
        coming->parts_left = 0;
        return;
    }
    coming->part[from->part] = true;
    if (count)
        memcpy(coming->entity + coming->count, from->entities._buffer,
               count * sizeof *coming->entity);
    coming->count += count;
    if (--coming->parts_left == 0) {
        struct world_mirror_batch whole = *coming;
        *coming = mirror->batch;
        coming->parts_left = 0;
        mirror->batch = whole;
        mirror->has_batch = true;
    }
}

/* What is written once came from somebody who has left, and another is there: ask again for what
 * that one wrote. */
static void look_after_world(struct world_mirror *mirror)
{
    if (!mirror->has_world || !log_due(&mirror->looked_ns, WORLD_MIRROR_LOOK_NS) ||
        !dds_topics_orphaned(mirror->reader[WORLD_MIRROR_WORLD], mirror->world_writer))
        return;
    dds_topics_ask_again(mirror->link, TOPIC_WORLD, mirror->waitset,
                         &mirror->reader[WORLD_MIRROR_WORLD]);
}

void world_mirror_take(struct world_mirror *mirror)
{
    static void (*const take[WORLD_MIRROR_READERS])(struct world_mirror *, const void *) = {
        take_world, take_process, take_frame, take_entities};
    for (int i = 0; i < mirror->readers; i++) {
        struct samples from = {.reader = mirror->reader[i], .topic = topics[i]};
        while (samples_next(&from)) {
            take[i](mirror, from.sample);
            if (i == WORLD_MIRROR_WORLD)
                mirror->world_writer = from.writer;
        }
    }
    look_after_world(mirror);
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
           (mirror->has_batch || mirror->readers <= WORLD_MIRROR_ENTITIES);
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
