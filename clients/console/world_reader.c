/* Attaches to the world and copies its state. */
#include "clients/console/world_reader.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_locks.h"
#include "world/entity/kind.h"
#include "world/model.h"

#include <string.h>

#define STALLED_NS NS_PER_S

void world_reader_open(struct world_reader *reader, const char *name)
{
    *reader = (struct world_reader){.name = name};
    error_text_set(&reader->detail, "world \"%s\" is not there yet", name);
}

static void detach(struct world_reader *reader)
{
    if (!reader->attached)
        return;
    snapshot_free(&reader->snapshot);
    motion_table_free(&reader->motions);
    segment_detach(&reader->view);
    reader->attached = reader->copied = reader->told = false;
    reader->rate_count = reader->rate_next = 0;
}

void world_reader_close(struct world_reader *reader)
{
    detach(reader);
}

/* Finds the shared memory object that the name leads to now. Returns false, with the error, if
 * there is none. */
static bool find_object(const struct world_reader *reader, char object[SEGMENT_PATH_MAX],
                        struct error_text *detail)
{
    struct segment_paths paths;
    if (segment_paths(&paths, reader->name, detail) != 0)
        return false;
    memcpy(object, paths.object, sizeof paths.object);
    if (object[0] == '\0')
        error_text_set(detail, "world \"%s\" is not there", reader->name);
    return object[0] != '\0';
}

static void note_turrets(struct world_reader *reader)
{
    const struct world *world = &reader->view.world;
    memset(reader->turret, 0, sizeof reader->turret);
    uint32_t kinds = kind_of_files(world->kinds, world->counts.kinds);
    for (uint32_t i = 0; i < kinds; i++) {
        const struct model *model = &world->models[world->kinds[i].model];
        if (world->kinds[i].domain == DOMAIN_MUNITION || world->kinds[i].domain == DOMAIN_FIXED)
            continue;
        for (uint32_t t = 0; t < model->triangle_count && !reader->turret[i]; t++)
            reader->turret[i] =
                world->model_triangles[model->first_triangle + t].part == PART_TURRET;
    }
}

/* If the name leads to another object before and after attaching, the next check tries again. */
static bool attach(struct world_reader *reader)
{
    char before[SEGMENT_PATH_MAX];
    if (!find_object(reader, before, &reader->detail))
        return false;
    if (segment_attach(&reader->view, reader->name, ROLE_NONE, &reader->detail) != 0)
        return false;
    if (!find_object(reader, reader->object, &reader->detail) ||
        strcmp(before, reader->object) != 0 ||
        snapshot_init(&reader->snapshot, &reader->view) != 0) {
        segment_detach(&reader->view);
        error_text_set(&reader->detail,
                       "world \"%s\" is being made, or there is no memory for a copy",
                       reader->name);
        return false;
    }
    reader->attached = true;
    note_turrets(reader);
    return true;
}

static bool check_name(struct world_reader *reader)
{
    char object[SEGMENT_PATH_MAX];
    struct error_text detail;
    if (reader->attached && find_object(reader, object, &detail) &&
        strcmp(object, reader->object) == 0)
        return false;
    bool was_attached = reader->attached;
    detach(reader);
    return attach(reader) || was_attached;
}

static void sample_rate(struct world_reader *reader, uint64_t now_ns)
{
    uint32_t last = (reader->rate_next + WORLD_READER_RATE_SAMPLES - 1) % WORLD_READER_RATE_SAMPLES;
    if (reader->rate_count > 0 && now_ns - reader->rate[last].at_ns < WORLD_READER_COPY_NS)
        return;
    reader->rate[reader->rate_next].at_ns = now_ns;
    reader->rate[reader->rate_next].commit = segment_load(&reader->view.commit->commit);
    reader->rate_next = (reader->rate_next + 1) % WORLD_READER_RATE_SAMPLES;
    if (reader->rate_count < WORLD_READER_RATE_SAMPLES)
        reader->rate_count++;
}

static void note_time(struct world_reader *reader)
{
    struct state_head head;
    if (snapshot_head(&head, &reader->view) != 0)
        return; /* the previous time is near enough */
    reader->time_s = state_time_s(&reader->view.world, &head);
    reader->scale = head.time_scale;
}

bool world_reader_turn(struct world_reader *reader, uint64_t now_ns)
{
    bool changed = false;
    if (reader->looked_ns == 0 || now_ns - reader->looked_ns >= WORLD_READER_LOOK_NS) {
        reader->looked_ns = now_ns;
        changed = check_name(reader);
    }
    if (reader->attached) {
        sample_rate(reader, now_ns);
        note_time(reader);
    }
    return changed;
}

int world_reader_copy(struct world_reader *reader, uint64_t now_ns)
{
    if (!reader->attached)
        return -1;
    uint64_t pause_ns = reader->spent_ns * WORLD_READER_SHARE;
    pause_ns = pause_ns > WORLD_READER_COPY_NS ? pause_ns : WORLD_READER_COPY_NS;
    if (reader->copied && now_ns - reader->copied_ns < pause_ns)
        return 0;
    int result = snapshot_take(&reader->snapshot, &reader->view);
    if (result == 0 && reader->told)
        motion_table_update(&reader->motions, &reader->view.world, &reader->snapshot);
    if (result == 0)
        snapshot_settle_poses(&reader->snapshot, &reader->view);
    uint64_t done_ns = clock_now_ns();
    reader->spent_ns = done_ns - now_ns;
    reader->copied_ns = now_ns;
    if (result == 0)
        reader->copied = true;
    /* After a failure the previous copy is still used. */
    if (!reader->copied)
        error_text_set(&reader->detail, "world \"%s\": no frame of it can be read whole",
                       reader->name);
    return reader->copied ? 0 : -1;
}

int world_reader_tell(struct world_reader *reader, uint64_t now_ns)
{
    if (reader->attached && !reader->told) {
        if (motion_table_init(&reader->motions, reader->view.header->capacity) != 0) {
            error_text_set(&reader->detail, "world \"%s\": no memory for its motions",
                           reader->name);
            return -1;
        }
        reader->told = true;
        reader->copied = false; /* the next copy is also told */
    }
    return world_reader_copy(reader, now_ns);
}

/* Returns the place of the oldest sample. */
static uint32_t oldest(const struct world_reader *reader)
{
    return reader->rate_count < WORLD_READER_RATE_SAMPLES ? 0 : reader->rate_next;
}

double world_reader_rate_hz(const struct world_reader *reader)
{
    if (reader->rate_count < 2)
        return 0.0;
    uint32_t first = oldest(reader);
    uint32_t last = (reader->rate_next + WORLD_READER_RATE_SAMPLES - 1) % WORLD_READER_RATE_SAMPLES;
    uint64_t ns = reader->rate[last].at_ns - reader->rate[first].at_ns;
    return ns ? (double)(reader->rate[last].commit - reader->rate[first].commit) * NS_PER_S /
                    (double)ns
              : 0.0;
}

const char *world_reader_state(const struct world_reader *reader, const struct state_head *head)
{
    const struct view *view = &reader->view;
    if (frame_protocol_finished(view))
        return "finished";
    if (segment_holder(reader->name, ROLE_MOVER) == 0)
        return "stopped";
    if (head->paused)
        return "paused";
    uint32_t first = oldest(reader);
    return reader->rate_count == WORLD_READER_RATE_SAMPLES &&
                   reader->rate[first].commit == segment_load(&view->commit->commit)
               ? "stalled"
               : "running";
}

uint32_t world_reader_row(const struct world_reader *reader, uint32_t id)
{
    return id ? entities_find(&reader->snapshot.entities, reader->snapshot.head.used, id)
              : SLOT_NONE;
}
