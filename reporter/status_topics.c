/* WorldInfo, EntityNames, ProcessStatus and FrameStatus from the segment. */
#include "reporter/status_topics.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/frame/snapshot.h"
#include "ipc/segment/segment_locks.h"
#include "ipc/topics/name_table.h"
#include "world/entity/kind.h"
#include "world/param_values.h"
#include "world/entity/remote.h"
#include "world/maths/hash.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define PROCESS_PERIOD_NS NS_PER_S

/* A process with a newer heartbeat lives. With an older one its lock is checked. */
#define BEAT_FRESH_NS (200 * (uint64_t)NS_PER_MS)

/* A world without a commit for this long, and for three frames, is stalled. */
#define STALL_NS     NS_PER_S
#define STALL_FRAMES 3.0

_Static_assert((int)jolon_PROCESS_STOPPING == (int)ROLE_STOPPING &&
                   (int)ROLE_STATE_COUNT == (int)jolon_PROCESS_DEAD,
               "process states in ipc/topics/status.idl");
_Static_assert((int)jolon_DOMAIN_FIXED == (int)DOMAIN_FIXED &&
                   (int)DOMAIN_COUNT == (int)jolon_DOMAIN_FIXED + 1,
               "domains in ipc/topics/status.idl");
_Static_assert(sizeof((jolon_EntityName *)0)->name == ENTITY_NAME_MAX,
               "names in ipc/topics/status.idl");
_Static_assert(jolon_MAP_CELLS == jolon_MAP_SIDE * jolon_MAP_SIDE, "map in ipc/topics/status.idl");

int status_topics_open(struct status_topics *topics, const struct view *view,
                       const struct dds_link *link, struct error_text *error)
{
    *topics =
        (struct status_topics){.run = view->header->made}; /* tells worlds of one name apart */
    topics->world = dds_topics_writer(link, TOPIC_WORLD, error);
    if (topics->world < 0)
        return -1;
    topics->names = dds_topics_writer(link, TOPIC_NAMES, error);
    if (topics->names < 0)
        return -1;
    topics->process = dds_topics_writer(link, TOPIC_PROCESS, error);
    if (topics->process < 0)
        return -1;
    topics->frame = dds_topics_writer(link, TOPIC_FRAME, error);
    return topics->frame < 0 ? -1 : 0;
}

static void fill_map(jolon_WorldInfo *info, const struct terrain *terrain)
{
    double cell_m = terrain->squares.world_m / jolon_MAP_SIDE;
    for (uint32_t row = 0; row < jolon_MAP_SIDE; row++) {
        for (uint32_t column = 0; column < jolon_MAP_SIDE; column++) {
            double x = (column + 0.5) * cell_m;
            double z = (row + 0.5) * cell_m;
            uint32_t cell = row * jolon_MAP_SIDE + column;
            info->height_m[cell] = (float)terrain_base_height(terrain, x, z);
            info->water[cell] = cover_is_water(terrain_cover(terrain, x, z)) ? 1 : 0;
        }
    }
}

/* bytes is the size of to. A longer text is cut. */
static void copy_text(char *to, size_t bytes, const char *from)
{
    size_t length = strnlen(from, bytes - 1);
    memcpy(to, from, length);
    to[length] = '\0';
}

int status_topics_world(struct status_topics *topics, const struct view *view,
                        struct error_text *error)
{
    const struct params *params = view->world.params;
    uint32_t kinds = kind_of_files(view->world.kinds, view->world.counts.kinds);
    jolon_KindInfo kind[KIND_COUNT_MAX] = {0};
    jolon_WorldInfo *info = calloc(1, sizeof *info);
    if (!info)
        return error_text_set(error, "world info: %s", strerror(errno));
    for (uint32_t i = 0; i < kinds; i++) {
        copy_text(kind[i].name, sizeof kind[i].name, view->world.kinds[i].name);
        kind[i].domain = (jolon_Domain)view->world.kinds[i].domain;
        kind[i].length_m = (float)view->world.kinds[i].length_m;
        kind[i].max_speed_mps = (float)view->world.kinds[i].max_speed_mps;
        kind[i].range_m = (float)view->world.kinds[i].range_m;
        kind[i].rounds = view->world.kinds[i].rounds;
        kind[i].fuel_l = (float)view->world.kinds[i].fuel_l;
    }
    copy_text(info->world, sizeof info->world, view->name);
    copy_text(info->ground, sizeof info->ground, params->name);
    copy_text(info->scenario, sizeof info->scenario, params->scenario);
    info->run = topics->run;
    info->seed = params->seed;
    info->hz = params->hz;
    info->side_m = view->world.terrain.squares.world_m;
    info->latitude_deg = params->gateway.latitude_deg;
    info->longitude_deg = params->gateway.longitude_deg;
    info->capacity = params->capacity;
    info->fixed_objects = view->world.counts.fixed;
    info->frame_limit = params->frame_limit;
    info->real_time = params->pace == PACE_REAL;
    info->kinds._buffer = kind;
    info->kinds._length = info->kinds._maximum = kinds;
    fill_map(info, &view->world.terrain);
    dds_return_t code = dds_write(topics->world, info);
    free(info);
    return code < 0 ? error_text_set(error, "world info: %s", dds_strretcode(code)) : 0;
}

static int write_names(const struct status_topics *topics, const struct name_table *names)
{
    jolon_EntityNames wire = {.run = topics->run};
    wire.names._buffer = names->entry;
    wire.names._length = wire.names._maximum = names->count;
    return dds_write(topics->names, &wire);
}

int status_topics_names(const struct status_topics *topics, const struct view *view,
                        struct error_text *error)
{
    struct name_table names = {0};
    if (!name_table_read_world(&names, &view->world, topics->run))
        return error_text_set(error, "entity names: %s", strerror(errno));
    int code = write_names(topics, &names);
    name_table_close(&names);
    return code < 0 ? error_text_set(error, "entity names: %s", dds_strretcode(code)) : 0;
}

/* Hashes which remote entities there are and how they are called, 0 for none. */
static uint64_t hash_markings(const struct snapshot *snapshot)
{
    const struct entities *e = &snapshot->entities;
    uint64_t hash = 0;
    for (uint32_t row = 0; row < snapshot->head.used; row++) {
        struct {
            uint32_t id;
            char marking[REMOTE_MARKING_MAX + 4];
        } of = {.id = e->row[row].id};
        if (e->row[row].state == ENTITY_FREE || !remote_is(e, row))
            continue;
        remote_marking(e, row, of.marking);
        hash = XXH3_64bits_withSeed(&of, sizeof of, hash);
    }
    return hash;
}

void status_topics_markings(struct status_topics *topics, const struct view *view,
                            const struct snapshot *snapshot)
{
    struct name_table names = {0};
    if (view->world.params->remotes_max == 0)
        return;
    uint64_t markings = hash_markings(snapshot);
    if (markings == topics->markings)
        return;
    if (name_table_read_world(&names, &view->world, topics->run) &&
        name_table_add_markings(&names, &snapshot->entities, snapshot->head.used) &&
        write_names(topics, &names) >= 0)
        topics->markings = markings; /* else it is tried again */
    name_table_close(&names);
}

static double to_ms(uint64_t ns)
{
    return (double)ns / NS_PER_MS;
}

static uint64_t load(const _Atomic uint64_t *word)
{
    return atomic_load_explicit(word, memory_order_relaxed);
}

static jolon_Times times_of(const struct histogram *histogram)
{
    return (jolon_Times){to_ms(histogram_quantile(histogram, 0.5)),
                         to_ms(histogram_quantile(histogram, 0.99)), to_ms(histogram->max_ns)};
}

static uint64_t beat_age(const struct view *view, enum role role, uint64_t now_ns)
{
    uint64_t beat_ns = load(&view->slot[role]->beat_ns);
    return now_ns > beat_ns ? now_ns - beat_ns : 0;
}

static jolon_ProcessState state_of(const struct view *view, enum role role, uint64_t beat_age_ns)
{
    uint32_t state = atomic_load_explicit(&view->slot[role]->state, memory_order_relaxed);
    if (state == ROLE_ABSENT || state >= ROLE_STATE_COUNT)
        return jolon_PROCESS_ABSENT;
    if (beat_age_ns > BEAT_FRESH_NS && !segment_held(view, role))
        return jolon_PROCESS_DEAD;
    return (jolon_ProcessState)state;
}

static void status_topics_process(struct status_topics *topics, const struct view *view,
                                  enum role role, uint64_t now_ns)
{
    const struct role_slot *slot = view->slot[role];
    uint64_t beat_age_ns = beat_age(view, role, now_ns);
    uint64_t starts = load(&slot->starts);
    jolon_ProcessStatus status = {
        .pid = atomic_load_explicit(&slot->pid, memory_order_relaxed),
        .restarts = starts ? starts - 1 : 0,
        .frame = load(&slot->frame),
        .stage_ms = to_ms(load(&slot->stage_ns)),
        .late_frames = load(&slot->late_frames),
        .gaps = load(&slot->gaps),
    };
    status.state = state_of(view, role, beat_age_ns);
    if (status.state != jolon_PROCESS_ABSENT)
        status.beat_age_ms = to_ms(beat_age_ns);
    if (topics->sent[role].sent_ns && topics->sent[role].state == status.state &&
        topics->sent[role].pid == status.pid && topics->sent[role].restarts == status.restarts &&
        now_ns - topics->sent[role].sent_ns < PROCESS_PERIOD_NS)
        return;
    jolon_Times times = times_of(&slot->stage);
    status.stage_p50_ms = times.p50_ms;
    status.stage_p99_ms = times.p99_ms;
    status.stage_max_ms = times.max_ms;
    copy_text(status.role, sizeof status.role, role_name(role));
    if (dds_write(topics->process, &status) < 0)
        return; /* tried again at the next call */
    topics->sent[role].state = status.state;
    topics->sent[role].pid = status.pid;
    topics->sent[role].restarts = status.restarts;
    topics->sent[role].sent_ns = now_ns;
}

void status_topics_processes(struct status_topics *topics, const struct view *view, uint64_t now_ns)
{
    for (int role = 0; role < ROLE_COUNT; role++) {
        /* The other roles are reported once they have been started. */
        if (role_has((enum role)role, ROLE_NEEDED) || load(&view->slot[role]->starts))
            status_topics_process(topics, view, (enum role)role, now_ns);
    }
}

/* Returns the frames a second of the clock over the last calls. */
static double measure_rate(struct status_topics *topics, uint64_t commit, uint64_t now_ns)
{
    uint32_t oldest = topics->rate_count < STATUS_TOPICS_RATE_SAMPLES ? 0 : topics->rate_next;
    double rate_hz = 0.0;
    if (topics->rate_count && now_ns > topics->rate[oldest].at_ns)
        rate_hz = (double)(commit - topics->rate[oldest].commit) /
                  ((double)(now_ns - topics->rate[oldest].at_ns) / NS_PER_S);
    topics->rate[topics->rate_next].at_ns = now_ns;
    topics->rate[topics->rate_next].commit = commit;
    topics->rate_next = (topics->rate_next + 1) % STATUS_TOPICS_RATE_SAMPLES;
    if (topics->rate_count < STATUS_TOPICS_RATE_SAMPLES)
        topics->rate_count++;
    return rate_hz;
}

static jolon_RunState run_state(struct status_topics *topics, const struct view *view,
                                const struct state_head *head, uint64_t now_ns)
{
    double frames_ns = STALL_FRAMES * view->world.params->dt_s * NS_PER_S / head->time_scale;
    if (head->frame != topics->commit || !topics->advanced_ns || head->paused) {
        topics->commit = head->frame;
        topics->advanced_ns = now_ns; /* a paused world is not stalled */
    }
    jolon_ProcessState mover = state_of(view, ROLE_MOVER, beat_age(view, ROLE_MOVER, now_ns));
    if (frame_protocol_finished(view))
        return jolon_RUN_FINISHED;
    if (mover == jolon_PROCESS_ABSENT || mover == jolon_PROCESS_DEAD)
        return jolon_RUN_STOPPED;
    if (head->paused)
        return jolon_RUN_PAUSED;
    uint64_t still_ns = now_ns - topics->advanced_ns;
    return still_ns >= STALL_NS && (double)still_ns >= frames_ns ? jolon_RUN_STALLED
                                                                 : jolon_RUN_RUNNING;
}

/* Returns the times of the frames since the last call. */
static jolon_Times recent_times(struct status_topics *topics, const struct histogram *whole)
{
    static struct histogram now, since; /* too large for the stack */
    now = *whole;
    histogram_since(&since, &now, &topics->whole);
    topics->whole = now;
    return times_of(&since);
}

void status_topics_frame(struct status_topics *topics, const struct view *view, uint64_t now_ns)
{
    struct state_head head;
    uint64_t moved = atomic_load_explicit(&view->moved_word->moved, memory_order_acquire);
    if (snapshot_head(&head, view) != 0)
        return; /* tried again at the next call */
    const struct counters *tally = &head.tally;
    const struct role_slot *collider = view->slot[ROLE_COLLIDER];
    const struct role_slot *mover = view->slot[ROLE_MOVER];
    jolon_FrameStatus status = {
        .run = topics->run,
        .frame = head.frame,
        /* The word was read before the head and may be frames behind it. It is never below
         * commit. */
        .moved = moved > head.frame ? moved : head.frame,
        .tick = head.tick,
        .sim_time_s = state_time_s(&view->world, &head),
        .state = run_state(topics, view, &head, now_ns),
        .paused = head.paused != 0,
        .hz = view->world.params->hz,
        .rate_hz = measure_rate(topics, head.frame, now_ns),
        .time_scale = head.time_scale,
        .late_frames = load(&mover->late_frames),
        .vehicles = head.vehicles,
        .munitions = head.munitions,
        .craters = head.crater_count,
        .events = head.event_end,
        .tally = {tally->collisions, tally->fires, tally->detonations, tally->destroyed,
                  tally->fixed_damaged, tally->agent_changes, tally->commands,
                  tally->events_dropped, tally->craters_refused, tally->spawns_refused},
        .frame_time = times_of(&collider->whole),
        .mover_time = times_of(&mover->stage),
        .collider_time = times_of(&collider->stage),
        .recent = recent_times(topics, &collider->whole),
        .contacts = head.contact_count,
        .contacts_refused = tally->contacts_refused,
    };
    (void)dds_write(topics->frame, &status); /* the next sample replaces a lost one */
}
