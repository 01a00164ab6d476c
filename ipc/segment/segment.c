/* Views over a segment's memory, and creation of a world's segment. */
#include "ipc/segment/segment.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_check.h"
#include "ipc/segment/segment_internal.h"
#include "world/checksum.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/provenance.h"
#include "world/runtime/large_pages.h"
#include "world/runtime/prefault.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

_Static_assert(ATOMIC_LLONG_LOCK_FREE == 2, "frame words must be lock-free");
_Static_assert(sizeof(_Atomic uint64_t) == 8, "frame words are plain 64-bit words in memory");

/* --- views over memory -------------------------------------------------------------------------*/

static uint64_t *hashes_at(unsigned char *base, uint32_t capacity)
{
    return (uint64_t *)(void *)(base + LAYOUT_HEAD_BYTES + entities_bytes(capacity));
}

static uint64_t *written_at(unsigned char *base, uint32_t capacity)
{
    return (uint64_t *)(void *)(base + layout_table_bytes(capacity) - written_bytes(capacity));
}

static void bind_state(const struct view *view, struct state *state, int region)
{
    unsigned char *base = segment_part(view, region);
    uint32_t capacity = view->header->capacity;
    state->head = (struct state_head *)(void *)base;
    entities_bind(&state->entities, capacity, base + LAYOUT_HEAD_BYTES);
    state->hashes = hashes_at(base, capacity);
    state->written = written_at(base, capacity);
    state->fixed_damage = base + layout_table_bytes(capacity);
    state->contacts = (void *)(base + layout_contacts_offset(capacity, view->header->counts.fixed));
    state->craters = segment_part(view, REGION_CRATERS);
    state->dents = segment_part(view, REGION_DENTS);
}

void segment_bind(struct view *view)
{
    const struct segment_header *header = view->header;
    struct world *world = &view->world;
    world->params = segment_part(view, REGION_PARAMS);
    world->counts = header->counts;
    const struct gridsquares squares = gridsquares_of(header->counts.side_m);
    world->terrain = (struct terrain){.posts = segment_part(view, REGION_POSTS),
                                      .cover = segment_part(view, REGION_COVER),
                                      .side = header->counts.posts_side,
                                      .spacing_m = header->counts.side_m /
                                                   (double)(header->counts.posts_side - 1),
                                      .earthworks = {segment_part(view, REGION_EARTHWORKS),
                                                     segment_part(view, REGION_EARTHWORK_INDEX),
                                                     header->counts.earthworks, squares},
                                      .squares = squares};
    world->kinds = segment_part(view, REGION_KINDS);
    world->models = segment_part(view, REGION_MODELS);
    world->model_vertices = segment_part(view, REGION_MODEL_VERTICES);
    world->model_triangles = segment_part(view, REGION_MODEL_TRIANGLES);
    world->hulls = segment_part(view, REGION_HULLS);
    world->hull_vertices = segment_part(view, REGION_HULL_VERTICES);
    world->hull_planes = segment_part(view, REGION_HULL_PLANES);
    world->fixed = segment_part(view, REGION_FIXED);
    world->reach_start = segment_part(view, REGION_REACH_START);
    world->reach = segment_part(view, REGION_REACH);
    world->areas = segment_part(view, REGION_AREAS);
    world->routes = segment_part(view, REGION_ROUTES);
    world->route_points = segment_part(view, REGION_ROUTE_POINTS);
    world->fires = segment_part(view, REGION_FIRES);
    world->road_points = segment_part(view, REGION_ROAD_POINTS);
    world->formations = segment_part(view, REGION_FORMATIONS);
    world->scripts = segment_part(view, REGION_SCRIPTS);
    world->script_steps = segment_part(view, REGION_SCRIPT_STEPS);
    world->missions = segment_part(view, REGION_MISSIONS);
    world->mission_phases = segment_part(view, REGION_MISSION_PHASES);
    world->mission_members = segment_part(view, REGION_MISSION_MEMBERS);
    world->objectives = segment_part(view, REGION_OBJECTIVES);
    world->names = segment_part(view, REGION_NAMES);
    world->recipe = segment_part(view, REGION_RECIPE);
    view->commit = segment_part(view, REGION_COMMIT);
    view->moved_word = segment_part(view, REGION_MOVED_WORD);
    bind_state(view, &view->w[0], REGION_WORLD_A);
    bind_state(view, &view->w[1], REGION_WORLD_B);
    view->events = segment_part(view, REGION_EVENTS);
    unsigned char *moved = segment_part(view, REGION_MOVED);
    view->m.head = (struct state_head *)(void *)moved;
    entities_bind(&view->m.entities, header->capacity, moved + LAYOUT_HEAD_BYTES);
    view->m.hashes = hashes_at(moved, header->capacity);
    view->m.intents = (struct event *)(void *)(moved + layout_table_bytes(header->capacity));
    view->m.written = written_at(moved, header->capacity);
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        view->commands[i] = segment_part(view, REGION_COMMANDS + i);
    view->doorbells = segment_part(view, REGION_DOORS);
    for (int i = 0; i < ROLE_COUNT; i++)
        view->slot[i] = segment_part(view, REGION_SLOTS + i);
}

/* Has the posts file named if it is made shorter while a world runs on it. */
static void guard_posts(const struct posts_file *posts, const char *ground)
{
    struct error_text text;
    error_text_set(&text,
                   "%s%s: was made shorter while a world runs on it; jolon world create on %s "
                   "makes it again",
                   ground, POSTS_FILE_SUFFIX, ground);
    process_guard_tells(posts->mapped, posts->bytes, text.text);
}

/* The recipe has "HASH PATH" of the ground file. */
int segment_map_posts(struct view *view, struct error_text *error)
{
    const struct counts *counts = &view->header->counts;
    const char *ground = provenance_find(view->world.recipe, counts->recipe, "ground");
    struct posts_file_ground of = {.side_m = counts->side_m, .posts_side = counts->posts_side};
    char *path = NULL;
    if (!counts->posts_in_file || view->posts_file.mapped)
        return 0;
    if (ground)
        of.hash = strtoull(ground, &path, 16);
    if (!path || *path != ' ')
        return error_text_set(error, "the world's recipe does not name its ground file");
    of.path = path + 1;
    if (posts_file_open(&view->posts_file, &of, error) != 0)
        return -1;
    guard_posts(&view->posts_file, of.path);
    view->world.terrain.posts = view->posts_file.posts;
    view->world.terrain.cover = view->posts_file.cover;
    return 0;
}

/* --- creation ----------------------------------------------------------------------------------*/

struct segment_header segment_header_for(const struct params *params, const struct counts *counts)
{
    return (struct segment_header){
        .counts = *counts,
        .capacity = params->capacity,
        .event_slots = params->event_slots,
        .intents_per_frame = params->intents_per_frame,
        .command_slots = params->command_slots,
        .crater_slots = params->crater_slots,
        .dent_slots = params->dent_slots,
        .contact_slots = params->contact_slots,
        .input_slots = layout_input_slots(params->command_slots, params->remotes_max)};
}

static int reserve(int fd, size_t bytes, struct error_text *error)
{
    CRASH_POINT("space");
    int code = posix_fallocate(fd, 0, (off_t)bytes);
    if (code == 0)
        return 0;
    struct statvfs space;
    struct rlimit limit;
    double free_mb = 0.0;
    if (fstatvfs(fd, &space) == 0)
        free_mb = (double)space.f_bavail * (double)space.f_frsize / 1e6;
    if (code == ENOSPC)
        return error_text_set(error,
                              "shared memory is full: the world needs %.1f MB and " SEGMENT_DIR
                              " has %.1f MB free; lower world.capacity, or remove old worlds with "
                              "`jolon clean -w NAME`",
                              (double)bytes / 1e6, free_mb);
    if (code == EFBIG && getrlimit(RLIMIT_FSIZE, &limit) == 0)
        return error_text_set(
            error,
            "the world needs %.1f MB, and no file of this process may be larger than "
            "%.3f MB; raise that with `ulimit -f`, or lower world.capacity",
            (double)bytes / 1e6, (double)limit.rlim_cur / 1e6);
    return error_text_set(error, SEGMENT_DIR ": cannot reserve %zu bytes: %s", bytes,
                          strerror(code));
}

/* Writes the header of new memory and binds the view. The static regions are still to be filled. */
static int prepare(struct view *view, const struct segment_header *header)
{
    struct segment_header *own = view->base;
    CRASH_POINT("header");
    *own = *header;
    own->magic = 0;
    CRASH_POINT("header's version");
    own->version = SEGMENT_VERSION;
    own->header_bytes = sizeof *own;
    CRASH_POINT("header's layout");
    own->layout_hash = layout_hash();
    own->total_bytes = view->layout.total;
    if (getrandom(&own->made, sizeof own->made, 0) != sizeof own->made)
        own->made = clock_now_ns() ^ (uint64_t)getpid() << 48;
    view->header = own;
    segment_bind(view);
    return doorbells_init(view->doorbells);
}

int segment_private(struct view *view, const struct segment_header *header,
                    struct error_text *error)
{
    *view = (struct view){.role = ROLE_NONE, .lock_fd = -1, .object_fd = -1};
    if (layout_compute(&view->layout, header) != 0)
        return error_text_set(error, "the world's counts are out of range");
    view->base = large_pages_map(view->layout.total, PROT_READ | PROT_WRITE, -1);
    if (view->base == MAP_FAILED) {
        view->base = NULL;
        return error_text_set(error, "out of memory: %zu bytes", view->layout.total);
    }
    return prepare(view, header) == 0 ? 0 : error_text_set(error, "doorbells: %s", strerror(errno));
}

void segment_prefault(const struct view *view)
{
    prefault_readable(view->base, view->layout.offset[REGION_COMMIT]);
}

/* The object has no name until it is whole: when the process dies, the kernel frees it. */
int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct error_text *error)
{
    if (segment_view_named(view, name, ROLE_NONE, error) != 0)
        return -1;
    if (layout_compute(&view->layout, header) != 0)
        return error_text_set(error, "the world's counts are out of range");
    CRASH_POINT("object without a name");
    view->object_fd = open(SEGMENT_DIR, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (view->object_fd < 0)
        return error_text_set(error, SEGMENT_DIR ": cannot create: %s", strerror(errno));
    if (reserve(view->object_fd, view->layout.total, error) != 0)
        goto err_made;
    view->base = large_pages_map(view->layout.total, PROT_READ | PROT_WRITE, view->object_fd);
    if (view->base == MAP_FAILED) {
        view->base = NULL;
        error_text_set(error, "cannot map the world's %.1f MB: %s; lower world.capacity",
                       (double)view->layout.total / 1e6, strerror(errno));
        goto err_made;
    }
    if (prepare(view, header) == 0)
        return 0;
    error_text_set(error, "cannot make the doorbells: %s", strerror(errno));
    segment_abandon(view);
    return -1;
err_made:
    close(view->object_fd);
    view->object_fd = -1;
    return -1;
}

void segment_fill(struct view *view, const struct world_build *built)
{
    struct params *params = segment_part(view, REGION_PARAMS);
    CRASH_POINT("parameters");
    *params = built->scenario->settings->params;
    memcpy(params->base, built->base, sizeof params->base);
    CRASH_POINT_GUARD_PAGES(view->base, view->layout.total);
    world_build_fill(built, &view->world, view->w);
    CRASH_POINT_UNGUARD();
}

int segment_publish(struct view *view, struct error_text *error)
{
    struct segment_header *own = view->base;
    CRASH_POINT("static hash");
    segment_hash_static(view);
    CRASH_POINT("head hash");
    own->head_hash = segment_head_hash(own);
    atomic_thread_fence(memory_order_release);
    CRASH_POINT("magic");
    own->magic = SEGMENT_MAGIC;
    if (segment_give_names(view->name, view->object_fd, error) != 0)
        return -1;
    close(view->object_fd);
    view->object_fd = -1;
    return 0;
}

void segment_abandon(struct view *view)
{
    if (!view->base)
        return;
    munmap(view->base, view->layout.total);
    posts_file_close(&view->posts_file);
    view->base = NULL;
    if (view->object_fd >= 0)
        close(view->object_fd);
    view->object_fd = -1;
}
