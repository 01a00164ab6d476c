/* Status samples of arbitrary bytes. Samples that samples_good() accepts are displayed in every
 * way. */
#include "tests/fuzz/support.h"

#include "ipc/process/clock.h"
#include "clients/monitor/status_json.h"
#include "clients/monitor/status_lines.h"
#include "clients/monitor/character_map.h"
#include "clients/monitor/sparkline.h"
#include "clients/monitor/vehicle_table.h"
#include "ipc/topics/event_json.h"
#include "ipc/topics/samples.h"
#include "ipc/topics/event_lines.h"
#include "world/runtime/check.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ENTITIES 4u

static struct {
    const uint8_t *at;
    size_t left;
} input;

static void fill(void *bytes, size_t count)
{
    size_t have = count < input.left ? count : input.left;
    memset(bytes, 0, count);
    memcpy(bytes, input.at, have);
    input.at += have;
    input.left -= have;
}

/* Does what the DDS decoder guarantees: strings are terminated, and booleans are 0 or 1. */
#define END(text)    ((text)[sizeof(text) - 1] = '\0')
#define TRUTH(value) (*(uint8_t *)&(value) &= 1)

static void end_party(jolon_Party *party)
{
    END(party->kind);
    TRUTH(party->fixed);
}

static void show_event(enum dds_topic topic)
{
    static union {
        jolon_CollisionEvent collision;
        jolon_FireEvent fire;
        jolon_DetonationEvent detonation;
        jolon_AgentEvent agent;
        jolon_CraterEvent crater;
        jolon_ContactEndEvent contact_end;
    } event;
    char line[EVENT_MERGE_LINE_MAX];
    fill(&event, sizeof event);
    if (topic == TOPIC_COLLISION) {
        end_party(&event.collision.a);
        end_party(&event.collision.b);
        TRUTH(event.collision.begins);
        END(event.collision.mgrs);
    } else if (topic == TOPIC_FIRE) {
        end_party(&event.fire.shooter);
        end_party(&event.fire.target);
        end_party(&event.fire.munition);
        END(event.fire.mgrs);
    } else if (topic == TOPIC_DETONATION) {
        end_party(&event.detonation.munition);
        end_party(&event.detonation.victim);
        END(event.detonation.mgrs);
    } else if (topic == TOPIC_CRATER) {
        END(event.crater.mgrs);
    } else if (topic == TOPIC_AGENT) {
        end_party(&event.agent.agent);
    } else if (topic == TOPIC_CONTACT_END) {
        end_party(&event.contact_end.a);
        end_party(&event.contact_end.b);
    }
    if (!samples_good(topic, &event))
        return;
    event_lines_event(line, topic, &event);
    event_json(line, topic, &event);
    cJSON *object = cJSON_Parse(line);
    CHECK(object);
    cJSON_Delete(object);
}

static void show_map(const struct world_mirror *mirror)
{
    static struct character_map map;
    const jolon_WorldInfo *world = &mirror->world;
    const struct character_map_ground ground = {world->height_m, world->water, jolon_MAP_SIDE,
                                                world->side_m};
    const struct character_map_area area = {0.5 * world->side_m, 0.5 * world->side_m,
                                            world->side_m};
    character_map_begin(&map, 5, 20, &area, &ground);
    for (uint32_t i = 0; i < mirror->batch.count; i++)
        character_map_mark(&map, mirror->batch.entity[i].x_m, mirror->batch.entity[i].z_m,
                           CHARACTER_MAP_BLUE);
}

static void show(const struct world_mirror *mirror)
{
    char line[STATUS_LINES_MAX], row[VEHICLE_TABLE_LINE_MAX], bars[SPARKLINE_TEXT_MAX];
    struct sparkline spark = {.count = 0};
    uint64_t now_ns = mirror->frame_ns + 1;
    status_lines_status(line, mirror, now_ns);
    status_lines_world(line, mirror, now_ns);
    status_lines_frame(line, mirror);
    status_lines_counts(line, mirror);
    for (uint32_t i = 0; i < mirror->role_count; i++)
        status_lines_process(line, &mirror->role[i]);
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++)
        vehicle_table_line(row, mirror, &mirror->batch.entity[i]);
    sparkline_add(&spark, mirror->frame.recent.max_ms);
    sparkline_text(bars, &spark, 4, mirror->frame.hz > 0.0 ? 1000.0 / mirror->frame.hz : 0.0, true);
    if (mirror->has_world)
        show_map(mirror);
    char *text = status_json(mirror, "", now_ns);
    cJSON *object = cJSON_Parse(text);
    CHECK(object);
    cJSON_Delete(object);
    cJSON_free(text);
}

/* The ground is constant except for one cell, so that bytes are left for the other members. */
static bool take_world(struct world_mirror *mirror)
{
    jolon_WorldInfo *world = &mirror->world;
    fill(&world->hz, sizeof world->hz);
    fill(&world->side_m, sizeof world->side_m);
    fill(world->ground, sizeof world->ground);
    fill(&world->height_m[7], sizeof world->height_m[7]);
    fill(mirror->kinds, 2 * sizeof *mirror->kinds);
    END(world->ground);
    END(mirror->kinds[0].name);
    END(mirror->kinds[1].name);
    world->kinds._buffer = mirror->kinds;
    world->kinds._length = 2;
    return samples_good(TOPIC_WORLD, world);
}

static bool take_entities(struct world_mirror *mirror)
{
    static jolon_Entity entity[ENTITIES];
    static jolon_Degrees place[ENTITIES];
    jolon_EntityBatch batch;
    uint8_t count, places;
    fill(&batch, offsetof(jolon_EntityBatch, entities));
    fill(&count, sizeof count);
    fill(&places, sizeof places);
    fill(entity, sizeof entity);
    fill(place, sizeof place);
    for (uint32_t i = 0; i < ENTITIES; i++)
        TRUTH(entity[i].grounded);
    batch.places._buffer = place;
    batch.places._length = places % (ENTITIES + 1);
    batch.entities._buffer = entity;
    batch.entities._length = count % (ENTITIES + 1);
    mirror->batch.entity = entity;
    mirror->batch.count = batch.entities._length;
    return samples_good(TOPIC_ENTITIES, &batch);
}

/* Takes a whole batch of motions and one a moment later. */
static bool take_motions(struct world_mirror *mirror)
{
    static jolon_Entity entity[ENTITIES], seen[ENTITIES];
    static jolon_Course course[ENTITIES];
    uint32_t rows[ENTITIES];
    jolon_MotionBatch batch = {.parts = 1, .whole = true};
    uint8_t count, courses;
    double later_s;
    fill(&batch.sim_time_s, sizeof batch.sim_time_s);
    fill(&later_s, sizeof later_s);
    fill(&count, sizeof count);
    fill(&courses, sizeof courses);
    fill(entity, sizeof entity);
    fill(course, sizeof course);
    for (uint32_t i = 0; i < ENTITIES; i++) {
        TRUTH(entity[i].grounded);
        rows[i] = i;
    }
    batch.rows._buffer = rows;
    batch.entities._buffer = entity;
    batch.courses._buffer = course;
    batch.rows._length = batch.entities._length = count % (ENTITIES + 1);
    batch.courses._length = courses % (ENTITIES + 1);
    bool taken =
        samples_good(TOPIC_MOTIONS, &batch) && motion_mirror_take(&mirror->motions.of[0], &batch);
    batch.rows._length = batch.entities._length = batch.courses._length = 0;
    batch.sim_time_s = later_s;
    batch.whole = false;
    if (taken && samples_good(TOPIC_MOTIONS, &batch))
        (void)motion_mirror_take(&mirror->motions.of[0], &batch);
    motion_mirror_entities(&mirror->motions.of[0], seen);
    mirror->batch.entity = seen;
    mirror->batch.count = mirror->motions.of[0].count;
    return taken;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct world_mirror mirror;
    static jolon_EntityName name[ENTITIES];
    jolon_EntityNames names = {.names = {._buffer = name}};
    uint8_t what;
    memset(&mirror, 0, sizeof mirror);
    mirror.name = "fuzz";
    mirror.frame_ns = 1;
    input.at = data;
    input.left = size;
    fill(&what, sizeof what);
    if (what >= 128) {
        show_event((enum dds_topic)(TOPIC_COLLISION + what % EVENT_TOPIC_COUNT));
        return 0;
    }
    fill(&mirror.frame, sizeof mirror.frame);
    TRUTH(mirror.frame.paused);
    if (!samples_good(TOPIC_FRAME, &mirror.frame))
        mirror.frame = (jolon_FrameStatus){.hz = 60.0};
    fill(&mirror.role[0], sizeof mirror.role[0]);
    END(mirror.role[0].role);
    mirror.role_count = samples_good(TOPIC_PROCESS, &mirror.role[0]);
    mirror.has_batch = what & 1 && (what & 2 ? take_motions(&mirror) : take_entities(&mirror));
    if (!mirror.has_batch)
        mirror.batch.count = 0;
    fill(name, sizeof name);
    for (uint32_t i = 0; i < ENTITIES; i++)
        END(name[i].name);
    names.names._length = what / 2 % (ENTITIES + 1);
    if (samples_good(TOPIC_NAMES, &names))
        (void)name_table_copy(&mirror.names, &names);
    mirror.has_world = what & 64 && take_world(&mirror);
    if (mirror.has_world || !(what & 64))
        show(&mirror);
    name_table_close(&mirror.names);
    motion_mirrors_close(&mirror.motions);
    return 0;
}
