/* The topics' samples into the picture. */
#include "monitor/picture.h"

#include "ipc/clock.h"
#include "ipc/role.h"

#include <stdlib.h>
#include <string.h>

int picture_open(struct picture *picture, const struct dds_link *link, const char *world,
                 struct reason *reason)
{
    static const enum dds_topic topics[PICTURE_READERS] = {TOPIC_WORLD, TOPIC_PROCESS, TOPIC_FRAME,
                                                           TOPIC_ENTITIES};
    *picture = (struct picture){.name = world};
    for (int i = 0; i < PICTURE_READERS; i++) {
        picture->reader[i] = dds_topics_reader(link, topics[i], reason);
        if (picture->reader[i] < 0)
            return -1;
    }
    picture->waitset = dds_topics_waitset(link, picture->reader, PICTURE_READERS, reason);
    return picture->waitset < 0 ? -1 : 0;
}

void picture_close(struct picture *picture)
{
    free(picture->batch.entity);
    free(picture->coming.entity);
    picture->batch.entity = picture->coming.entity = NULL;
}

static void take_world(struct picture *picture, const void *sample)
{
    const jolon_WorldInfo *world = sample;
    uint32_t kinds = world->kinds._length;
    if (kinds > PICTURE_KINDS_MAX)
        kinds = PICTURE_KINDS_MAX;
    if (picture->has_world && picture->world.run != world->run) {
        picture->role_count = 0; /* another world under the same name */
        picture->has_batch = false;
        picture->frame_ns = 0;
    }
    picture->world = *world;
    memcpy(picture->kinds, world->kinds._buffer, kinds * sizeof *picture->kinds);
    picture->world.kinds._buffer = picture->kinds;
    picture->world.kinds._length = kinds;
    picture->has_world = true;
}

/* Kept in the order of the roles' table, in whatever order they come. */
static void take_process(struct picture *picture, const void *sample)
{
    const jolon_ProcessStatus *status = sample;
    uint32_t i = 0;
    while (i < picture->role_count && strcmp(picture->role[i].role, status->role) != 0)
        i++;
    if (i == PICTURE_ROLES_MAX)
        return;
    if (i == picture->role_count) {
        picture->role_count++;
        for (; i > 0 && role_find(picture->role[i - 1].role) > role_find(status->role); i--)
            picture->role[i] = picture->role[i - 1];
    }
    picture->role[i] = *status;
}

static void take_frame(struct picture *picture, const void *sample)
{
    picture->frame = *(const jolon_FrameStatus *)sample;
    picture->frame_ns = clock_now_ns();
}

static void take_entities(struct picture *picture, const void *sample)
{
    const jolon_EntityBatch *from = sample;
    struct picture_batch *coming = &picture->coming;
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
        struct picture_batch whole = *coming;
        *coming = picture->batch;
        coming->parts_left = 0;
        picture->batch = whole;
        picture->has_batch = true;
    }
}

void picture_take(struct picture *picture)
{
    static void (*const take[PICTURE_READERS])(struct picture *, const void *) = {
        take_world, take_process, take_frame, take_entities};
    for (int i = 0; i < PICTURE_READERS; i++) {
        void *sample = NULL;
        dds_sample_info_t info;
        while (dds_take(picture->reader[i], &sample, &info, 1, 1) > 0) {
            if (info.valid_data)
                take[i](picture, sample);
            (void)dds_return_loan(picture->reader[i], &sample, 1);
            sample = NULL;
        }
    }
}

void picture_wait(const struct picture *picture, uint64_t until_ns)
{
    uint64_t now_ns = clock_now_ns();
    if (now_ns < until_ns)
        dds_topics_wait(picture->waitset, until_ns - now_ns);
}

bool picture_live(const struct picture *picture, uint64_t now_ns)
{
    return picture->frame_ns && now_ns - picture->frame_ns < PICTURE_SILENCE_NS;
}

bool picture_whole(const struct picture *picture)
{
    return picture->has_world && picture->frame_ns && picture->role_count && picture->has_batch;
}

const char *picture_kind_name(const struct picture *picture, uint32_t kind)
{
    return picture->has_world && kind < picture->world.kinds._length ? picture->kinds[kind].name
                                                                     : "?";
}

const char *picture_process_state(jolon_ProcessState state)
{
    static const char *const names[] = {"absent", "starting", "ready", "stopping", "dead"};
    return (unsigned)state < sizeof names / sizeof names[0] ? names[state] : "?";
}

const char *picture_run_state(const struct picture *picture, uint64_t now_ns)
{
    static const char *const names[] = {"running", "paused", "finished", "stopped", "stalled"};
    if (!picture->frame_ns)
        return "waiting";
    if (!picture_live(picture, now_ns))
        return "silent";
    unsigned state = (unsigned)picture->frame.state;
    return state < sizeof names / sizeof names[0] ? names[state] : "?";
}
