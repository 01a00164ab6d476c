/* The topics' samples into the mirror. */
#include "topics/mirror.h"

#include "ipc/clock.h"
#include "ipc/role.h"

#include <stdlib.h>
#include <string.h>

int mirror_open(struct mirror *mirror, const struct dds_link *link, const char *world,
                bool entities, struct reason *reason)
{
    static const enum dds_topic topics[MIRROR_READERS] = {TOPIC_WORLD, TOPIC_PROCESS, TOPIC_FRAME,
                                                          TOPIC_ENTITIES};
    *mirror =
        (struct mirror){.name = world, .readers = entities ? MIRROR_READERS : MIRROR_ENTITIES};
    for (int i = 0; i < mirror->readers; i++) {
        mirror->reader[i] = dds_topics_reader(link, topics[i], reason);
        if (mirror->reader[i] < 0)
            return -1;
    }
    if (names_open(&mirror->names, link, reason) != 0)
        return -1;
    mirror->waitset = dds_topics_waitset(link, mirror->reader, (size_t)mirror->readers, reason);
    return mirror->waitset < 0 ? -1 : 0;
}

void mirror_close(struct mirror *mirror)
{
    names_close(&mirror->names);
    free(mirror->batch.entity);
    free(mirror->coming.entity);
    mirror->batch.entity = mirror->coming.entity = NULL;
}

static void take_world(struct mirror *mirror, const void *sample)
{
    const jolon_WorldInfo *world = sample;
    uint32_t kinds = world->kinds._length;
    if (kinds > MIRROR_KINDS_MAX)
        kinds = MIRROR_KINDS_MAX;
    if (mirror->has_world && mirror->world.run != world->run) {
        mirror->role_count = 0; /* another world under the same name */
        mirror->has_batch = false;
        mirror->frame_ns = 0;
    }
    mirror->world = *world;
    memcpy(mirror->kinds, world->kinds._buffer, kinds * sizeof *mirror->kinds);
    mirror->world.kinds._buffer = mirror->kinds;
    mirror->world.kinds._length = kinds;
    mirror->has_world = true;
}

/* Kept in the order of the roles' table, in whatever order they come. */
static void take_process(struct mirror *mirror, const void *sample)
{
    const jolon_ProcessStatus *status = sample;
    uint32_t i = 0;
    while (i < mirror->role_count && strcmp(mirror->role[i].role, status->role) != 0)
        i++;
    if (i == MIRROR_ROLES_MAX)
        return;
    if (i == mirror->role_count) {
        mirror->role_count++;
        for (; i > 0 && role_find(mirror->role[i - 1].role) > role_find(status->role); i--)
            mirror->role[i] = mirror->role[i - 1];
    }
    mirror->role[i] = *status;
}

static void take_frame(struct mirror *mirror, const void *sample)
{
    mirror->frame = *(const jolon_FrameStatus *)sample;
    mirror->frame_ns = clock_now_ns();
}

static void take_entities(struct mirror *mirror, const void *sample)
{
    const jolon_EntityBatch *from = sample;
    struct mirror_batch *coming = &mirror->coming;
    uint32_t count = from->entities._length;
    if (from->frame != coming->frame || from->run != coming->run || coming->parts_left == 0) {
        coming->frame = from->frame;
        coming->run = from->run;
        coming->parts_left = from->parts;
        coming->count = 0;
    }
    if (count > coming->room - coming->count) {
        uint32_t room = coming->count + count;
        jolon_Entity *entity = realloc(coming->entity, room * sizeof *entity);
        if (!entity) {
            coming->parts_left = 0; /* this frame's entities are not shown */
            return;
        }
        coming->entity = entity;
        coming->room = room;
    }
    if (count)
        memcpy(coming->entity + coming->count, from->entities._buffer,
               count * sizeof *coming->entity);
    coming->count += count;
    if (coming->parts_left && --coming->parts_left == 0) {
        struct mirror_batch whole = *coming;
        *coming = mirror->batch;
        coming->parts_left = 0;
        mirror->batch = whole;
        mirror->has_batch = true;
    }
}

void mirror_take(struct mirror *mirror)
{
    static void (*const take[MIRROR_READERS])(struct mirror *, const void *) = {
        take_world, take_process, take_frame, take_entities};
    for (int i = 0; i < mirror->readers; i++) {
        void *sample = NULL;
        dds_sample_info_t info;
        while (dds_take(mirror->reader[i], &sample, &info, 1, 1) > 0) {
            if (info.valid_data)
                take[i](mirror, sample);
            (void)dds_return_loan(mirror->reader[i], &sample, 1);
            sample = NULL;
        }
    }
    names_take(&mirror->names);
}

void mirror_wait(const struct mirror *mirror, uint64_t until_ns)
{
    uint64_t now_ns = clock_now_ns();
    if (now_ns < until_ns)
        dds_topics_wait(mirror->waitset, until_ns - now_ns);
}

bool mirror_live(const struct mirror *mirror, uint64_t now_ns)
{
    return mirror->frame_ns && now_ns - mirror->frame_ns < MIRROR_SILENCE_NS;
}

bool mirror_whole(const struct mirror *mirror)
{
    return mirror->has_world && mirror->frame_ns && mirror->role_count &&
           (mirror->has_batch || mirror->readers <= MIRROR_ENTITIES);
}

const jolon_Entity *mirror_entity(const struct mirror *mirror, uint32_t id)
{
    for (uint32_t i = 0; mirror->has_batch && id && i < mirror->batch.count; i++) {
        if (mirror->batch.entity[i].id == id)
            return &mirror->batch.entity[i];
    }
    return NULL;
}

const jolon_KindInfo *mirror_kind(const struct mirror *mirror, uint32_t kind)
{
    return mirror->has_world && kind < mirror->world.kinds._length ? &mirror->kinds[kind] : NULL;
}

const char *mirror_kind_name(const struct mirror *mirror, uint32_t kind)
{
    return mirror->has_world && kind < mirror->world.kinds._length ? mirror->kinds[kind].name : "?";
}

const char *mirror_process_state(jolon_ProcessState state)
{
    static const char *const names[] = {"absent", "starting", "ready", "stopping", "dead"};
    return (unsigned)state < sizeof names / sizeof names[0] ? names[state] : "?";
}

const char *mirror_run_state(const struct mirror *mirror, uint64_t now_ns)
{
    static const char *const names[] = {"running", "paused", "finished", "stopped", "stalled"};
    if (!mirror->frame_ns)
        return "waiting";
    if (!mirror_live(mirror, now_ns))
        return "silent";
    unsigned state = (unsigned)mirror->frame.state;
    return state < sizeof names / sizeof names[0] ? names[state] : "?";
}
