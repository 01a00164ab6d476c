/* Creation, attachment and removal of a world's segment. */
#include "ipc/segment.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/role.h"
#include "world/square.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <xxhash.h>

#define SHM_DIR "/dev/shm"

_Static_assert(ATOMIC_LLONG_LOCK_FREE == 2, "frame words must be lock-free");
_Static_assert(sizeof(_Atomic uint64_t) == 8, "frame words are plain 64-bit words in memory");

int reason_set(struct reason *reason, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(reason->text, sizeof reason->text, format, args);
    va_end(args);
    return -1;
}

bool segment_name_ok(const char *name)
{
    size_t length = strlen(name);
    return length > 0 && length < SEGMENT_NAME_MAX &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

void segment_paths(const char *name, char shm[SEGMENT_PATH_MAX], char lock[SEGMENT_PATH_MAX])
{
    snprintf(shm, SEGMENT_PATH_MAX, SHM_DIR "/jolon.%u.%s", (unsigned)getuid(), name);
    snprintf(lock, SEGMENT_PATH_MAX, SHM_DIR "/jolon.%u.%s.lock", (unsigned)getuid(), name);
}

static void temporary_path(const char *name, char path[SEGMENT_PATH_MAX])
{
    snprintf(path, SEGMENT_PATH_MAX, SHM_DIR "/jolon.%u.%s.new-%d", (unsigned)getuid(), name,
             (int)getpid());
}

/* --- views over memory -------------------------------------------------------------------------*/

static void *part(const struct view *view, int region)
{
    return (unsigned char *)view->base + view->layout.offset[region];
}

static void bind_state(const struct view *view, struct state *state, int region)
{
    unsigned char *base = part(view, region);
    state->head = (struct state_head *)(void *)base;
    entities_bind(&state->entities, view->header->capacity, base + LAYOUT_HEAD_BYTES);
    state->fixed_damage = base + LAYOUT_HEAD_BYTES + entities_bytes(view->header->capacity);
    state->craters = part(view, REGION_CRATERS);
    state->dents = part(view, REGION_DENTS);
}

static void bind(struct view *view)
{
    const struct segment_header *header = view->header;
    struct world *world = &view->world;
    world->params = part(view, REGION_PARAMS);
    world->counts = header->counts;
    world->terrain = (struct terrain){part(view, REGION_POSTS), part(view, REGION_COVER),
                                      header->counts.posts_side,
                                      WORLD_SIDE_M / (double)(header->counts.posts_side - 1)};
    world->kinds = part(view, REGION_KINDS);
    world->models = part(view, REGION_MODELS);
    world->model_vertices = part(view, REGION_MODEL_VERTICES);
    world->model_triangles = part(view, REGION_MODEL_TRIANGLES);
    world->hulls = part(view, REGION_HULLS);
    world->hull_vertices = part(view, REGION_HULL_VERTICES);
    world->hull_planes = part(view, REGION_HULL_PLANES);
    world->fixed = part(view, REGION_FIXED);
    world->reach_start = part(view, REGION_REACH_START);
    world->reach = part(view, REGION_REACH);
    world->areas = part(view, REGION_AREAS);
    world->routes = part(view, REGION_ROUTES);
    world->route_points = part(view, REGION_ROUTE_POINTS);
    world->fires = part(view, REGION_FIRES);
    world->road_points = part(view, REGION_ROAD_POINTS);
    world->names = part(view, REGION_NAMES);
    view->commit = part(view, REGION_COMMIT);
    view->moved_word = part(view, REGION_MOVED_WORD);
    bind_state(view, &view->w[0], REGION_WORLD_A);
    bind_state(view, &view->w[1], REGION_WORLD_B);
    view->events = part(view, REGION_EVENTS);
    unsigned char *moved = part(view, REGION_MOVED);
    view->m.head = (struct state_head *)(void *)moved;
    entities_bind(&view->m.entities, header->capacity, moved + LAYOUT_HEAD_BYTES);
    view->m.intents =
        (struct event *)(void *)(moved + LAYOUT_HEAD_BYTES + entities_bytes(header->capacity));
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        view->commands[i] = part(view, REGION_COMMANDS + i);
    view->doors = part(view, REGION_DOORS);
    for (int i = 0; i < ROLE_COUNT; i++)
        view->slot[i] = part(view, REGION_SLOTS + i);
}

/* --- creation ----------------------------------------------------------------------------------*/

static uint64_t head_hash(const struct segment_header *header)
{
    struct segment_header copy = *header;
    copy.magic = 0;
    copy.head_hash = 0;
    return XXH3_64bits(&copy, sizeof copy);
}

static uint64_t static_hash(const struct view *view)
{
    uint64_t hash = 0;
    for (int i = REGION_PARAMS; i <= REGION_NAMES; i++)
        hash = XXH3_64bits_withSeed(part(view, i), view->layout.bytes[i], hash);
    return hash;
}

struct segment_header segment_header_for(const struct params *params, const struct counts *counts)
{
    return (struct segment_header){.counts = *counts,
                                   .capacity = params->capacity,
                                   .event_slots = params->event_slots,
                                   .intents_per_frame = params->intents_per_frame,
                                   .command_slots = params->command_slots,
                                   .crater_slots = params->crater_slots,
                                   .dent_slots = params->dent_slots};
}

/* Objects that creators of this world left when they were killed before publishing. */
static void sweep_temporaries(const char *name)
{
    char prefix[SEGMENT_PATH_MAX];
    int length = snprintf(prefix, sizeof prefix, "jolon.%u.%s.new-", (unsigned)getuid(), name);
    DIR *directory = opendir(SHM_DIR);
    if (!directory)
        return;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strncmp(entry->d_name, prefix, (size_t)length) != 0)
            continue;
        long pid = strtol(entry->d_name + length, NULL, 10);
        /* One with our own number is of a process before us. */
        if (pid > 0 && pid != getpid() && (kill((pid_t)pid, 0) == 0 || errno != ESRCH))
            continue;
        unlinkat(dirfd(directory), entry->d_name, 0);
    }
    closedir(directory);
}

static int reserve(int fd, const char *path, size_t bytes, struct reason *reason)
{
    int error = posix_fallocate(fd, 0, (off_t)bytes);
    if (error == 0)
        return 0;
    struct statvfs space;
    double free_mb = 0.0;
    if (fstatvfs(fd, &space) == 0)
        free_mb = (double)space.f_bavail * (double)space.f_frsize / 1e6;
    unlink(path);
    if (error == ENOSPC)
        return reason_set(reason,
                          "shared memory is full: the world needs %.1f MB and " SHM_DIR
                          " has %.1f MB free; lower world.capacity, or remove old worlds with "
                          "`jolon clean`",
                          (double)bytes / 1e6, free_mb);
    return reason_set(reason, "%s: cannot reserve %zu bytes: %s", path, bytes, strerror(error));
}

/* The new segment's memory: header written, static regions still to be filled. */
static int prepare(struct view *view, const struct segment_header *header)
{
    struct segment_header *own = view->base;
    *own = *header;
    own->magic = 0;
    own->version = SEGMENT_VERSION;
    own->header_bytes = sizeof *own;
    own->layout_hash = layout_hash();
    own->total_bytes = view->layout.total;
    view->header = own;
    bind(view);
    return doors_init(view->doors);
}

int segment_private(struct view *view, const struct segment_header *header, struct reason *reason)
{
    *view = (struct view){.role = ROLE_NONE, .lock_fd = -1};
    if (layout_compute(&view->layout, header) != 0)
        return reason_set(reason, "the world's counts are out of range");
    view->base =
        mmap(NULL, view->layout.total, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (view->base == MAP_FAILED) {
        view->base = NULL;
        return reason_set(reason, "out of memory: %zu bytes", view->layout.total);
    }
    return prepare(view, header) == 0 ? 0 : reason_set(reason, "doorbells: %s", strerror(errno));
}

int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct reason *reason)
{
    char path[SEGMENT_PATH_MAX];
    *view = (struct view){.role = ROLE_NONE, .lock_fd = -1};
    snprintf(view->name, sizeof view->name, "%s", name);
    if (!segment_name_ok(name))
        return reason_set(reason, "\"%s\" is no name for a world: 1 to %d of a-z A-Z 0-9 _ -", name,
                          SEGMENT_NAME_MAX - 1);
    if (layout_compute(&view->layout, header) != 0)
        return reason_set(reason, "the world's counts are out of range");
    sweep_temporaries(name);
    temporary_path(name, path);
    int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (fd < 0)
        return reason_set(reason, "%s: cannot create: %s", path, strerror(errno));
    if (reserve(fd, path, view->layout.total, reason) != 0) {
        close(fd);
        return -1;
    }
    view->base = mmap(NULL, view->layout.total, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (view->base == MAP_FAILED) {
        view->base = NULL;
        unlink(path);
        return reason_set(reason, "%s: cannot map %zu bytes: %s", path, view->layout.total,
                          strerror(errno));
    }
    if (prepare(view, header) != 0) {
        segment_abandon(view);
        return reason_set(reason, "%s: cannot make the doorbells: %s", path, strerror(errno));
    }
    return 0;
}

void segment_fill(struct view *view, const struct genesis *genesis)
{
    struct params *params = part(view, REGION_PARAMS);
    *params = genesis->scenario->params;
    genesis_fill(genesis, &view->world, view->w);
}

static int open_lock(const char *path, int flags)
{
    return open(path, O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | flags, 0600);
}

int segment_publish(struct view *view, struct reason *reason)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX], temporary[SEGMENT_PATH_MAX];
    struct segment_header *own = view->base;
    segment_paths(view->name, shm, lock);
    temporary_path(view->name, temporary);
    own->static_hash = static_hash(view);
    own->head_hash = head_hash(own);
    atomic_thread_fence(memory_order_release);
    own->magic = SEGMENT_MAGIC;
    int fd = open_lock(lock, O_CREAT);
    if (fd < 0)
        return reason_set(reason, "%s: cannot create: %s", lock, strerror(errno));
    close(fd);
    if (renameat2(AT_FDCWD, temporary, AT_FDCWD, shm, RENAME_NOREPLACE) != 0) {
        if (errno == EEXIST)
            return reason_set(reason,
                              "world \"%s\" exists already; `jolon status -w %s` shows it, `jolon "
                              "stop -w %s` ends it, -w NAME makes another",
                              view->name, view->name, view->name);
        return reason_set(reason, "%s: cannot rename to %s: %s", temporary, shm, strerror(errno));
    }
    return 0;
}

void segment_abandon(struct view *view)
{
    if (!view->base)
        return;
    munmap(view->base, view->layout.total);
    view->base = NULL;
    if (view->name[0] != '\0') {
        char path[SEGMENT_PATH_MAX];
        temporary_path(view->name, path);
        unlink(path);
    }
}

/* --- attachment --------------------------------------------------------------------------------*/

/* Takes the role's byte of the lock file. The file may be removed and made again between open and
 * lock: then it is another world's, and the lock is tried there. */
static int take_lock(struct view *view, const char *path, struct reason *reason)
{
    for (int tries = 0; tries < 10; tries++) {
        struct stat held, named;
        struct flock byte = {
            .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = view->role, .l_len = 1};
        int fd = open_lock(path, 0);
        if (fd < 0)
            return reason_set(reason, "%s: cannot open: %s", path, strerror(errno));
        if (fcntl(fd, F_OFD_SETLK, &byte) != 0) {
            close(fd);
            if (errno != EAGAIN && errno != EACCES)
                return reason_set(reason, "%s: cannot lock: %s", path, strerror(errno));
            return reason_set(reason,
                              "the %s of world \"%s\" is running already (pid %d); two at once "
                              "are not allowed",
                              role_name(view->role), view->name,
                              (int)segment_holder(view->name, view->role));
        }
        if (fstat(fd, &held) == 0 && stat(path, &named) == 0 && held.st_ino == named.st_ino) {
            view->lock_fd = fd;
            return 0;
        }
        close(fd);
    }
    return reason_set(reason, "%s: is removed and made again all the time", path);
}

static int check_object(int fd, const char *path, size_t *bytes, struct reason *reason)
{
    struct stat status;
    if (fstat(fd, &status) != 0)
        return reason_set(reason, "%s: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return reason_set(reason, "%s: is no shared-memory object", path);
    if (status.st_uid != geteuid())
        return reason_set(reason, "%s: belongs to user %u, not to you (%u)", path,
                          (unsigned)status.st_uid, (unsigned)geteuid());
    if ((status.st_mode & 0777) != 0600)
        return reason_set(reason, "%s: has mode %03o; a world's is 600", path,
                          (unsigned)(status.st_mode & 0777));
    if (status.st_size < (off_t)sizeof(struct segment_header))
        return reason_set(reason, "%s: size %lld is too small for a header", path,
                          (long long)status.st_size);
    *bytes = (size_t)status.st_size;
    return 0;
}

/* The header is copied out of memory that others could change, then checked field by field. */
static int check_header(const struct segment_header *header, size_t bytes, const char *path,
                        struct layout *layout, struct reason *reason)
{
    if (header->magic != SEGMENT_MAGIC)
        return reason_set(reason, "%s: magic: not a Jolon world, or one that was never finished",
                          path);
    if (header->version != SEGMENT_VERSION)
        return reason_set(reason, "%s: version %u; this program knows %u", path, header->version,
                          SEGMENT_VERSION);
    if (header->header_bytes != sizeof *header || header->layout_hash != layout_hash())
        return reason_set(reason,
                          "%s: layout: made by another build of Jolon; stop it with that build, "
                          "or remove it with `jolon clean`",
                          path);
    if (header->head_hash != head_hash(header))
        return reason_set(reason, "%s: head hash: the header is damaged", path);
    if (layout_compute(layout, header) != 0)
        return reason_set(reason, "%s: counts: out of range", path);
    if (header->total_bytes != layout->total || bytes != layout->total)
        return reason_set(reason, "%s: size %zu; its counts need %zu", path, bytes, layout->total);
    return 0;
}

/* The parameters that sizes and waits are computed from. */
static int check_params(const struct view *view, const char *path, struct reason *reason)
{
    const struct segment_header *header = view->base;
    const struct params *params = part(view, REGION_PARAMS);
    if (params->capacity != header->capacity || params->event_slots != header->event_slots ||
        params->intents_per_frame != header->intents_per_frame ||
        params->command_slots != header->command_slots ||
        params->crater_slots != header->crater_slots || params->dent_slots != header->dent_slots)
        return reason_set(reason, "%s: params: do not fit the header", path);
    if (params->events_per_frame == 0 || params->events_per_frame > params->event_slots / 2)
        return reason_set(reason, "%s: params: events_per_frame = %u of %u slots", path,
                          params->events_per_frame, params->event_slots);
    if (!(params->dt_s > 0.0 && params->dt_s <= 1.0))
        return reason_set(reason, "%s: params: dt_s = %g; must be more than 0, at most 1", path,
                          params->dt_s);
    return 0;
}

/* Maps runs of writable regions over the read-only whole. */
static int map_writable(struct view *view, int fd)
{
    for (int i = 0; i < REGION_COUNT; i++) {
        if (!layout_writable(view->role, (enum region)i) || view->layout.bytes[i] == 0)
            continue;
        size_t end = i + 1 < REGION_COUNT ? view->layout.offset[i + 1] : view->layout.total;
        if (mmap(part(view, i), end - view->layout.offset[i], PROT_READ | PROT_WRITE,
                 MAP_SHARED | MAP_FIXED, fd, (off_t)view->layout.offset[i]) == MAP_FAILED)
            return -1;
    }
    return 0;
}

/* The same object through a read-only descriptor: such a mapping cannot be made writable later. */
static void *map_readable(int fd, size_t bytes)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    int readable = open(path, O_RDONLY | O_CLOEXEC);
    if (readable < 0)
        return MAP_FAILED;
    void *base = mmap(NULL, bytes, PROT_READ, MAP_SHARED, readable, 0);
    close(readable);
    return base;
}

static int map_segment(struct view *view, const char *path, struct reason *reason)
{
    size_t bytes = 0;
    int result = -1;
    /* O_NONBLOCK: a pipe of that name must not make us wait for its other end. */
    int mode = view->role == ROLE_NONE ? O_RDONLY : O_RDWR;
    int fd = open(path, mode | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) {
        if (errno == ENOENT)
            return reason_set(reason,
                              "there is no world \"%s\"; `jolon worlds` lists those there are, "
                              "`jolon start` makes one",
                              view->name);
        return reason_set(reason, "%s: cannot open: %s", path, strerror(errno));
    }
    if (check_object(fd, path, &bytes, reason) != 0)
        goto err_open;
    view->base = map_readable(fd, bytes);
    if (view->base == MAP_FAILED) {
        reason_set(reason, "%s: cannot map %zu bytes: %s", path, bytes, strerror(errno));
        view->base = NULL;
        goto err_open;
    }
    struct segment_header header = *(const struct segment_header *)view->base;
    if (check_header(&header, bytes, path, &view->layout, reason) != 0)
        goto err_map;
    if (map_writable(view, fd) != 0) {
        reason_set(reason, "%s: cannot map for writing: %s", path, strerror(errno));
        goto err_map;
    }
    if (check_params(view, path, reason) != 0)
        goto err_map;
    result = 0;
    goto done;
err_map:
    munmap(view->base, bytes);
    view->base = NULL;
done:
err_open:
    close(fd);
    return result;
}

static void slot_taken(struct view *view)
{
    struct role_slot *slot = view->slot[view->role];
    uint64_t now = clock_now_ns();
    atomic_store(&slot->beat_ns, now);
    atomic_store(&slot->started_ns, now);
    atomic_store(&slot->state, ROLE_STARTING);
    atomic_fetch_add(&slot->starts, 1);
    atomic_store(&slot->pid, (uint32_t)getpid());
}

/* The world was made between the look for it and its mapping: the role is not locked. */
static int unlocked(struct view *view, struct reason *reason)
{
    munmap(view->base, view->layout.total);
    view->base = NULL;
    return reason_set(reason, "world \"%s\" is just being made; try again", view->name);
}

int segment_attach(struct view *view, const char *name, enum role role, struct reason *reason)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX];
    *view = (struct view){.role = role, .lock_fd = -1};
    if (!segment_name_ok(name))
        return reason_set(reason, "\"%s\" is no name for a world: 1 to %d of a-z A-Z 0-9 _ -", name,
                          SEGMENT_NAME_MAX - 1);
    snprintf(view->name, sizeof view->name, "%s", name);
    segment_paths(name, shm, lock);
    if (access(shm, F_OK) == 0 && role != ROLE_NONE && take_lock(view, lock, reason) != 0)
        return -1;
    if (map_segment(view, shm, reason) != 0 ||
        (role != ROLE_NONE && view->lock_fd < 0 && unlocked(view, reason) != 0)) {
        if (view->lock_fd >= 0)
            close(view->lock_fd);
        view->lock_fd = -1;
        return -1;
    }
    view->header = view->base;
    bind(view);
    if (role != ROLE_NONE)
        slot_taken(view);
    return 0;
}

void segment_ready(struct view *view)
{
    atomic_store(&view->slot[view->role]->beat_ns, clock_now_ns());
    atomic_store(&view->slot[view->role]->state, ROLE_READY);
}

void segment_detach(struct view *view)
{
    if (!view->base)
        return;
    if (view->role != ROLE_NONE) {
        atomic_store(&view->slot[view->role]->state, ROLE_ABSENT);
        atomic_store(&view->slot[view->role]->pid, 0);
    }
    munmap(view->base, view->layout.total);
    view->base = NULL;
    if (view->lock_fd >= 0)
        close(view->lock_fd);
    view->lock_fd = -1;
}

int segment_verify(const struct view *view, struct reason *reason)
{
    if (static_hash(view) != view->header->static_hash)
        return reason_set(reason, "static hash: terrain, kinds, objects or parameters are damaged");
    return 0;
}

/* --- worlds by name ----------------------------------------------------------------------------*/

static bool lock_held(const char *path, enum role role)
{
    struct flock byte = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = role, .l_len = 1};
    int fd = open_lock(path, 0);
    if (fd < 0)
        return false;
    bool held = fcntl(fd, F_OFD_GETLK, &byte) == 0 && byte.l_type != F_UNLCK;
    close(fd);
    return held;
}

int segment_holder(const char *name, enum role role)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX];
    struct view view;
    struct reason reason;
    segment_paths(name, shm, lock);
    if (!lock_held(lock, role) || segment_attach(&view, name, ROLE_NONE, &reason) != 0)
        return 0;
    int pid = (int)atomic_load(&view.slot[role]->pid);
    segment_detach(&view);
    return pid;
}

/* The file stays while somebody holds it whole by flock(2): a supervisor, which removes it at its
 * end. */
static int remove_lock(const char *path, struct reason *reason)
{
    int result = 0;
    int fd = open_lock(path, 0);
    if (fd < 0)
        return 0;
    if (flock(fd, LOCK_EX | LOCK_NB) == 0 && unlink(path) != 0)
        result = reason_set(reason, "%s: cannot remove: %s", path, strerror(errno));
    close(fd);
    return result;
}

int segment_remove(const char *name, bool force, struct reason *reason)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX];
    if (!segment_name_ok(name))
        return reason_set(reason, "\"%s\" is no name for a world", name);
    segment_paths(name, shm, lock);
    for (int role = 0; role < ROLE_COUNT && !force; role++) {
        if (lock_held(lock, (enum role)role))
            return reason_set(reason, "world \"%s\" is in use: its %s runs (pid %d); stop it first",
                              name, role_name((enum role)role),
                              segment_holder(name, (enum role)role));
    }
    sweep_temporaries(name);
    if (unlink(shm) != 0 && errno != ENOENT)
        return reason_set(reason, "%s: cannot remove: %s", shm, strerror(errno));
    return remove_lock(lock, reason);
}

int segment_list(char names[][SEGMENT_NAME_MAX], int max)
{
    char prefix[SEGMENT_PATH_MAX];
    int length = snprintf(prefix, sizeof prefix, "jolon.%u.", (unsigned)getuid());
    int count = 0;
    DIR *directory = opendir(SHM_DIR);
    if (!directory)
        return 0;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strncmp(entry->d_name, prefix, (size_t)length) != 0)
            continue;
        const char *name = entry->d_name + length;
        if (count < max && segment_name_ok(name))
            snprintf(names[count++], SEGMENT_NAME_MAX, "%s", name);
    }
    closedir(directory);
    return count;
}
