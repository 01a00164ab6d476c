/* Attaching, letting go, copying. */
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

void world_reader_open(struct world_reader *watch, const char *name)
{
    *watch = (struct world_reader){.name = name};
    reason_set(&watch->why, "world \"%s\" is not there yet", name);
}

static void let_go(struct world_reader *watch)
{
    if (!watch->there)
        return;
    snapshot_free(&watch->snapshot);
    segment_detach(&watch->view);
    watch->there = watch->copied = false;
    watch->rate_count = watch->rate_next = 0;
}

void world_reader_close(struct world_reader *watch)
{
    let_go(watch);
}

/* The object that the name leads to now; false with the reason when it leads nowhere. */
static bool find_object(const struct world_reader *watch, char object[SEGMENT_PATH_MAX],
                        struct reason *why)
{
    struct segment_paths paths;
    if (segment_paths(&paths, watch->name, why) != 0)
        return false;
    memcpy(object, paths.object, sizeof paths.object);
    if (object[0] == '\0')
        reason_set(why, "world \"%s\" is not there", watch->name);
    return object[0] != '\0';
}

static void note_turrets(struct world_reader *watch)
{
    const struct world *world = &watch->view.world;
    memset(watch->turret, 0, sizeof watch->turret);
    for (uint32_t i = 0; i < world->counts.kinds && i < KIND_COUNT_MAX; i++) {
        const struct model *model = &world->models[world->kinds[i].model];
        if (world->kinds[i].domain == DOMAIN_MUNITION || world->kinds[i].domain == DOMAIN_FIXED)
            continue;
        for (uint32_t t = 0; t < model->triangle_count && !watch->turret[i]; t++)
            watch->turret[i] =
                world->model_triangles[model->first_triangle + t].part == PART_TURRET;
    }
}

/* The object may be another one before and after: then it is for the next look. */
static bool attach(struct world_reader *watch)
{
    char before[SEGMENT_PATH_MAX];
    if (!find_object(watch, before, &watch->why))
        return false;
    if (segment_attach(&watch->view, watch->name, ROLE_NONE, &watch->why) != 0)
        return false;
    if (!find_object(watch, watch->object, &watch->why) || strcmp(before, watch->object) != 0 ||
        snapshot_init(&watch->snapshot, &watch->view) != 0) {
        segment_detach(&watch->view);
        reason_set(&watch->why, "world \"%s\" is being made, or there is no memory for a copy",
                   watch->name);
        return false;
    }
    watch->there = true;
    note_turrets(watch);
    return true;
}

static bool look(struct world_reader *watch)
{
    char object[SEGMENT_PATH_MAX];
    struct reason why;
    if (watch->there && find_object(watch, object, &why) && strcmp(object, watch->object) == 0)
        return false;
    bool was_there = watch->there;
    let_go(watch);
    return attach(watch) || was_there;
}

static void sample_rate(struct world_reader *watch, uint64_t now_ns)
{
    uint32_t last = (watch->rate_next + WORLD_READER_RATE_SAMPLES - 1) % WORLD_READER_RATE_SAMPLES;
    if (watch->rate_count > 0 && now_ns - watch->rate[last].at_ns < WORLD_READER_COPY_NS)
        return;
    watch->rate[watch->rate_next].at_ns = now_ns;
    watch->rate[watch->rate_next].commit = segment_load(&watch->view.commit->commit);
    watch->rate_next = (watch->rate_next + 1) % WORLD_READER_RATE_SAMPLES;
    if (watch->rate_count < WORLD_READER_RATE_SAMPLES)
        watch->rate_count++;
}

static void note_time(struct world_reader *watch)
{
    struct state_head head;
    if (snapshot_head(&head, &watch->view) != 0)
        return; /* the time before is near enough */
    watch->time_s = state_time_s(&watch->view.world, &head);
    watch->scale = head.time_scale;
}

bool world_reader_turn(struct world_reader *watch, uint64_t now_ns)
{
    bool changed = false;
    if (watch->looked_ns == 0 || now_ns - watch->looked_ns >= WORLD_READER_LOOK_NS) {
        watch->looked_ns = now_ns;
        changed = look(watch);
    }
    if (watch->there) {
        sample_rate(watch, now_ns);
        note_time(watch);
    }
    return changed;
}

int world_reader_copy(struct world_reader *watch, uint64_t now_ns)
{
    if (!watch->there)
        return -1;
    uint64_t pause_ns = watch->spent_ns * WORLD_READER_SHARE;
    pause_ns = pause_ns > WORLD_READER_COPY_NS ? pause_ns : WORLD_READER_COPY_NS;
    if (watch->copied && now_ns - watch->copied_ns < pause_ns)
        return 0;
    int result = snapshot_take(&watch->snapshot, &watch->view);
    uint64_t done_ns = clock_now_ns();
    watch->spent_ns = done_ns - now_ns;
    watch->copied_ns = now_ns;
    if (result == 0)
        watch->copied = true;
    /* The one before is whole and still serves; a world that stays damaged says so itself. */
    if (!watch->copied)
        reason_set(&watch->why, "world \"%s\": no frame of it can be read whole", watch->name);
    return watch->copied ? 0 : -1;
}

/* The oldest sample that there is. */
static uint32_t oldest(const struct world_reader *watch)
{
    return watch->rate_count < WORLD_READER_RATE_SAMPLES ? 0 : watch->rate_next;
}

double world_reader_rate_hz(const struct world_reader *watch)
{
    if (watch->rate_count < 2)
        return 0.0;
    uint32_t first = oldest(watch);
    uint32_t last = (watch->rate_next + WORLD_READER_RATE_SAMPLES - 1) % WORLD_READER_RATE_SAMPLES;
    uint64_t ns = watch->rate[last].at_ns - watch->rate[first].at_ns;
    return ns ? (double)(watch->rate[last].commit - watch->rate[first].commit) * NS_PER_S /
                    (double)ns
              : 0.0;
}

const char *world_reader_state(const struct world_reader *watch, const struct state_head *head)
{
    const struct view *view = &watch->view;
    if (frame_protocol_finished(view))
        return "finished";
    if (segment_holder(watch->name, ROLE_MOVER) == 0)
        return "stopped";
    if (head->paused)
        return "paused";
    uint32_t first = oldest(watch);
    return watch->rate_count == WORLD_READER_RATE_SAMPLES &&
                   watch->rate[first].commit == segment_load(&view->commit->commit)
               ? "stalled"
               : "running";
}

uint32_t world_reader_row(const struct world_reader *watch, uint32_t id)
{
    return id ? entities_find(&watch->snapshot.entities, watch->snapshot.head.used, id) : SLOT_NONE;
}
