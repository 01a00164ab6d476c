/* Samples of every status topic: some with random members, some almost correct. */
#include "tests/rtps/hostile.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/topics/dds_topics.h"
#include "world/maths/random.h"

#include "status.h"

#include <math.h>
#include <string.h>

#define TURN_NS  (2 * (uint64_t)NS_PER_MS)
#define ENTITIES 64u
#define NAMES    64u
#define KINDS    64u

struct hostile {
    uint64_t state;
    uint64_t run; /* the world's, so that the sample is not ignored as another world's */
    dds_entity_t writer[TOPIC_COUNT];
    dds_entity_t frames;
    jolon_Entity entity[ENTITIES];
    jolon_EntityName name[NAMES];
    jolon_KindInfo kind[KINDS];
};

static uint64_t draw(struct hostile *hostile)
{
    hostile->state += 0x9e3779b97f4a7c15u;
    return random_mix(hostile->state);
}

static bool often(struct hostile *hostile)
{
    return draw(hostile) % 4 != 0;
}

static double number(struct hostile *hostile)
{
    static const double numbers[] = {0.0,  -0.0, 1.0,  -1.0,   1e300,    -1e300,
                                     NAN,  -NAN, 1e15, -1e15,  INFINITY, -INFINITY,
                                     1e16, 0.5,  1e-9, 25000.0};
    return often(hostile) ? (double)(draw(hostile) % 50000) : numbers[draw(hostile) % 16];
}

static uint64_t whole(struct hostile *hostile)
{
    static const uint64_t wholes[] = {0, 1, 2, UINT32_MAX, UINT64_MAX, UINT64_MAX - 1, 1u << 31, 7};
    return often(hostile) ? draw(hostile) % 1000 : wholes[draw(hostile) % 8];
}

static void text(struct hostile *hostile, char *at, size_t bytes)
{
    size_t length = draw(hostile) % bytes;
    for (size_t i = 0; i < length; i++)
        at[i] = (char)(draw(hostile) % 255 + 1);
    at[length] = '\0';
}

static jolon_Times times(struct hostile *hostile)
{
    return (jolon_Times){number(hostile), number(hostile), number(hostile)};
}

static void write_world(struct hostile *hostile)
{
    static jolon_WorldInfo world;
    world.run = often(hostile) ? hostile->run : draw(hostile);
    text(hostile, world.world, sizeof world.world);
    text(hostile, world.ground, sizeof world.ground);
    text(hostile, world.scenario, sizeof world.scenario);
    world.hz = number(hostile);
    world.side_m = number(hostile);
    for (uint32_t i = 0; i < jolon_MAP_CELLS; i++) {
        world.height_m[i] = often(hostile) ? 5.0F : (float)number(hostile);
        world.water[i] = (uint8_t)draw(hostile);
    }
    world.kinds._length = world.kinds._maximum = (uint32_t)(draw(hostile) % (KINDS + 1));
    world.kinds._buffer = hostile->kind;
    for (uint32_t i = 0; i < world.kinds._length; i++) {
        text(hostile, hostile->kind[i].name, sizeof hostile->kind[i].name);
        hostile->kind[i].domain = (jolon_Domain)(draw(hostile) % (jolon_DOMAIN_FIXED + 1));
        hostile->kind[i].length_m = (float)number(hostile);
    }
    (void)dds_write(hostile->writer[TOPIC_WORLD], &world);
}

static void write_names(struct hostile *hostile)
{
    jolon_EntityNames names = {.run = hostile->run, .names = {._buffer = hostile->name}};
    names.names._length = names.names._maximum = (uint32_t)(draw(hostile) % NAMES);
    for (uint32_t i = 0; i < names.names._length; i++) {
        hostile->name[i].id = often(hostile) ? i + 1 : (uint32_t)whole(hostile);
        text(hostile, hostile->name[i].name, sizeof hostile->name[i].name);
    }
    (void)dds_write(hostile->writer[TOPIC_NAMES], &names);
}

static void write_process(struct hostile *hostile)
{
    static const char *const roles[] = {"mover", "collider", "reporter", "renderer-4"};
    jolon_ProcessStatus status = {.state = (jolon_ProcessState)(draw(hostile) % 5),
                                  .pid = (uint32_t)whole(hostile),
                                  .beat_age_ms = number(hostile),
                                  .restarts = whole(hostile),
                                  .frame = whole(hostile),
                                  .stage_ms = number(hostile),
                                  .stage_p50_ms = number(hostile)};
    if (often(hostile))
        text(hostile, status.role, sizeof status.role);
    else
        (void)strcpy(status.role, roles[draw(hostile) % 4]);
    (void)dds_write(hostile->writer[TOPIC_PROCESS], &status);
}

static void write_frame(struct hostile *hostile)
{
    jolon_FrameStatus frame = {.run = often(hostile) ? hostile->run : draw(hostile),
                               .frame = whole(hostile),
                               .moved = whole(hostile),
                               .sim_time_s = number(hostile),
                               .state = (jolon_RunState)(draw(hostile) % 5),
                               .hz = number(hostile),
                               .rate_hz = number(hostile),
                               .time_scale = number(hostile),
                               .vehicles = (uint32_t)whole(hostile),
                               .events = whole(hostile),
                               .frame_time = times(hostile),
                               .mover_time = times(hostile),
                               .collider_time = times(hostile),
                               .recent = times(hostile)};
    (void)dds_write(hostile->writer[TOPIC_FRAME], &frame);
}

static void write_batch(struct hostile *hostile)
{
    jolon_EntityBatch batch = {.part = (uint32_t)(often(hostile) ? 0 : whole(hostile)),
                               .parts = (uint32_t)(often(hostile) ? 1 : whole(hostile)),
                               .run = hostile->run,
                               .frame = whole(hostile),
                               .sim_time_s = number(hostile),
                               .entities = {._buffer = hostile->entity}};
    batch.entities._length = batch.entities._maximum = (uint32_t)(draw(hostile) % ENTITIES);
    batch.total = (uint32_t)(often(hostile) ? batch.entities._length : whole(hostile));
    for (uint32_t i = 0; i < batch.entities._length; i++) {
        hostile->entity[i] = (jolon_Entity){.id = (uint32_t)whole(hostile),
                                            .kind = (uint16_t)whole(hostile),
                                            .state = jolon_ENTITY_ACTIVE,
                                            .x_m = number(hostile),
                                            .z_m = number(hostile),
                                            .vx_mps = (float)number(hostile),
                                            .heading_rad = (float)number(hostile),
                                            .fuel_l = (float)number(hostile),
                                            .rounds = (uint32_t)whole(hostile)};
    }
    (void)dds_write(hostile->writer[TOPIC_ENTITIES], &batch);
}

static void write_motions(struct hostile *hostile)
{
    static uint32_t rows[ENTITIES];
    static jolon_Course courses[ENTITIES];
    jolon_MotionBatch batch = {.part = (uint32_t)(often(hostile) ? 0 : whole(hostile)),
                               .parts = (uint32_t)(often(hostile) ? 1 : whole(hostile)),
                               .run = hostile->run,
                               .frame = whole(hostile),
                               .sim_time_s = number(hostile),
                               .whole = draw(hostile) & 1,
                               .rows = {._buffer = rows},
                               .entities = {._buffer = hostile->entity},
                               .courses = {._buffer = courses}};
    uint32_t count = (uint32_t)(draw(hostile) % ENTITIES);
    batch.rows._length = batch.rows._maximum = often(hostile) ? count : count / 2;
    batch.entities._length = batch.entities._maximum = count;
    batch.courses._length = batch.courses._maximum = count;
    for (uint32_t i = 0; i < count; i++) {
        rows[i] = often(hostile) ? 3 * i : (uint32_t)whole(hostile);
        courses[i] = (jolon_Course){.entity = often(hostile) ? i : (uint32_t)whole(hostile),
                                    .turn_rps = (float)number(hostile),
                                    .gain_mps2 = (float)number(hostile),
                                    .lasts_s = (float)number(hostile)};
        hostile->entity[i] = (jolon_Entity){.id = (uint32_t)whole(hostile),
                                            .kind = (uint16_t)whole(hostile),
                                            .state = (jolon_EntityState)(draw(hostile) % 3),
                                            .x_m = number(hostile),
                                            .vx_mps = (float)number(hostile),
                                            .heading_rad = (float)number(hostile)};
    }
    (void)dds_write(hostile->writer[TOPIC_MOTIONS], &batch);
}

static jolon_EventHeader header(struct hostile *hostile)
{
    return (jolon_EventHeader){.run = often(hostile) ? hostile->run : draw(hostile),
                               .sequence = often(hostile) ? UINT64_MAX - draw(hostile) % 100
                                                          : whole(hostile),
                               .previous = whole(hostile),
                               .frame = whole(hostile),
                               .time_s = number(hostile)};
}

static jolon_Party party(struct hostile *hostile)
{
    jolon_Party party = {.id = (uint32_t)whole(hostile)};
    text(hostile, party.kind, sizeof party.kind);
    return party;
}

static void write_events(struct hostile *hostile)
{
    jolon_CollisionEvent collision = {.header = header(hostile),
                                      .a = party(hostile),
                                      .b = party(hostile),
                                      .point = {number(hostile), 0.0, number(hostile)},
                                      .toi = number(hostile),
                                      .closing_mps = (float)number(hostile)};
    jolon_FireEvent fire = {.header = header(hostile), .shooter = party(hostile)};
    jolon_DetonationEvent detonation = {.header = header(hostile),
                                        .victim = party(hostile),
                                        .explosive_kg = (float)number(hostile)};
    jolon_CraterEvent crater = {.header = header(hostile), .radius_m = (float)number(hostile)};
    jolon_AgentEvent agent = {.header = header(hostile), .agent = party(hostile)};
    jolon_ContactEndEvent contact_end = {.header = header(hostile),
                                         .a = party(hostile),
                                         .lasted_s = number(hostile),
                                         .impulse_ns = (float)number(hostile)};
    (void)dds_write(hostile->writer[TOPIC_COLLISION], &collision);
    (void)dds_write(hostile->writer[TOPIC_FIRE], &fire);
    (void)dds_write(hostile->writer[TOPIC_DETONATION], &detonation);
    (void)dds_write(hostile->writer[TOPIC_CRATER], &crater);
    (void)dds_write(hostile->writer[TOPIC_AGENT], &agent);
    (void)dds_write(hostile->writer[TOPIC_CONTACT_END], &contact_end);
}

/* Reads the number of the world's run from its own topics. */
static uint64_t learn_run(struct hostile *hostile, uint64_t until_ns)
{
    uint64_t run = 0;
    while (run == 0 && clock_now_ns() < until_ns) {
        void *sample = NULL;
        dds_sample_info_t info;
        clock_sleep_until_ns(clock_now_ns() + TURN_NS);
        if (dds_take(hostile->frames, &sample, &info, 1, 1) <= 0)
            continue;
        if (info.valid_data)
            run = ((const jolon_FrameStatus *)sample)->run;
        (void)dds_return_loan(hostile->frames, &sample, 1);
    }
    return run;
}

void hostile_write(const struct dds_link *link, uint64_t seed, uint64_t length_ns)
{
    static struct hostile hostile;
    static void (*const writes[])(struct hostile *) = {write_world, write_names, write_process,
                                                       write_frame, write_batch, write_motions,
                                                       write_events};
    struct error_text error;
    hostile.state = seed;
    hostile.frames = dds_topics_reader(link, TOPIC_FRAME, &error);
    for (int i = 0; i < TOPIC_COUNT && hostile.frames >= 0; i++) {
        hostile.writer[i] = i == TOPIC_COMMAND || i == TOPIC_REPLY
                                ? 0
                                : dds_topics_writer(link, (enum dds_topic)i, &error);
        if (hostile.writer[i] < 0)
            die_refused("%s", error.text);
    }
    uint64_t until_ns = clock_now_ns() + length_ns;
    hostile.run = learn_run(&hostile, until_ns);
    for (uint64_t turn = 0; clock_now_ns() < until_ns; turn++) {
        writes[turn % (sizeof writes / sizeof writes[0])](&hostile);
        clock_sleep_until_ns(clock_now_ns() + TURN_NS);
    }
}
