/* Attaching to a segment in a role, and leaving it. */
#include "ipc/segment/segment_attach.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_internal.h"
#include "ipc/segment/segment_locks.h"
#include "world/runtime/large_pages.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static int try_lock(struct view *view, int fd, const char *path, struct error_text *error)
{
    struct flock byte = segment_role_byte(view->role);
    CRASH_POINT("role's lock");
    if (fcntl(fd, F_OFD_SETLK, &byte) == 0) {
        view->holds_role = true;
        return 0;
    }
    if (errno != EAGAIN && errno != EACCES)
        return error_text_set(error, "%s: cannot lock: %s", path, strerror(errno));
    return error_text_set(error,
                          "the %s of world \"%s\" is running already (pid %d); two at once are not "
                          "allowed",
                          role_name(view->role), view->name,
                          segment_holder(view->name, view->role));
}

/* The file may be removed and made again between open and lock. Then it belongs to another world,
 * and the lock is tried on the new file. */
int segment_lock(struct view *view, const char *path, bool later, struct error_text *error)
{
    for (int tries = 0; tries < 10; tries++) {
        struct stat held, named;
        int fd = segment_open_lock(path, view->role == ROLE_NONE ? O_RDONLY : O_RDWR, error);
        if (fd < 0)
            return -1;
        if (!later && try_lock(view, fd, path, error) != 0) {
            close(fd);
            return -1;
        }
        if (fstat(fd, &held) == 0 && stat(path, &named) == 0 && held.st_ino == named.st_ino) {
            view->lock_fd = fd;
            return 0;
        }
        view->holds_role = false;
        close(fd);
    }
    return error_text_set(error, "%s: is removed and made again all the time", path);
}

/* Maps the writable regions over the read-only mapping of the whole. */
static int map_writable(struct view *view, int fd, segment_writable *writable)
{
    for (int i = 0; i < REGION_COUNT; i++) {
        if (!writable(view->role, (enum region)i) || view->layout.bytes[i] == 0)
            continue;
        size_t end = i + 1 < REGION_COUNT ? view->layout.offset[i + 1] : view->layout.total;
        if (mmap(segment_part(view, i), end - view->layout.offset[i], PROT_READ | PROT_WRITE,
                 MAP_SHARED | MAP_FIXED, fd, (off_t)view->layout.offset[i]) == MAP_FAILED)
            return -1;
    }
    return 0;
}

/* Maps the object through a read-only descriptor, so that the mapping cannot be made writable
 * later. */
static void *map_readable(int fd, size_t bytes)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    int readable = open(path, O_RDONLY | O_CLOEXEC);
    if (readable < 0)
        return MAP_FAILED;
    void *base = large_pages_map(bytes, PROT_READ, readable);
    close(readable);
    return base;
}

/* Refuses: there is no world of the view's name. */
static int absent(const struct view *view, struct error_text *error)
{
    error_text_set(error,
                   "there is no world \"%s\"; `jolon worlds` lists the worlds, `jolon start` makes "
                   "one",
                   view->name);
    error->foreign = true;
    return -1;
}

int segment_map(struct view *view, segment_writable *writable, struct error_text *error)
{
    struct segment_paths paths;
    const char *path = paths.object;
    size_t bytes = 0;
    int result = -1;
    if (segment_paths(&paths, view->name, error) != 0)
        return -1;
    if (path[0] == '\0')
        return absent(view, error);
    /* O_NONBLOCK: opening a pipe of that name must not wait for its other end. */
    int mode = writable ? O_RDWR : O_RDONLY;
    int fd = open(path, mode | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return errno == ENOENT
                   ? absent(view, error)
                   : error_text_set(error, "%s: cannot open: %s", path, strerror(errno));
    if (segment_check_object(fd, path, &bytes, error) != 0)
        goto err_open;
    view->base = map_readable(fd, bytes);
    if (view->base == MAP_FAILED) {
        error_text_set(error, "%s: cannot map %zu bytes: %s", path, bytes, strerror(errno));
        view->base = NULL;
        goto err_open;
    }
    struct segment_header header = *(const struct segment_header *)view->base;
    if (segment_check_header(&header, bytes, path, &view->layout, error) != 0) {
        error->damaged = !error->foreign;
        goto err_map;
    }
    if (writable && map_writable(view, fd, writable) != 0) {
        error_text_set(error, "%s: cannot map for writing: %s", path, strerror(errno));
        goto err_map;
    }
    if (segment_check_params(view, path, error) != 0) {
        error->damaged = true;
        goto err_map;
    }
    view->header = view->base;
    segment_bind(view);
    if (segment_map_posts(view, error) != 0)
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
    CRASH_POINT("slot's first beat");
    atomic_store(&slot->beat_ns, now);
    CRASH_POINT("slot's start");
    atomic_store(&slot->started_ns, now);
    CRASH_POINT("starting");
    atomic_store(&slot->state, ROLE_STARTING);
    CRASH_POINT("starts");
    atomic_fetch_add(&slot->starts, 1);
    CRASH_POINT("slot's pid");
    atomic_store(&slot->pid, (uint32_t)getpid());
}

/* Refuses: the world was made after its name was looked up, so the role is not locked. */
static int unlocked(struct view *view, struct error_text *error)
{
    munmap(view->base, view->layout.total);
    posts_file_close(&view->posts_file);
    view->base = NULL;
    return error_text_set(error, "world \"%s\" is just being made; try again", view->name);
}

int segment_view_named(struct view *view, const char *name, enum role role,
                       struct error_text *error)
{
    *view = (struct view){.role = role, .lock_fd = -1, .object_fd = -1};
    if (segment_name_check(name, error) != 0)
        return -1;
    snprintf(view->name, sizeof view->name, "%s", name);
    return 0;
}

static int attach(struct view *view, const char *name, enum role role, bool later,
                  struct error_text *error)
{
    struct segment_paths paths;
    if (segment_view_named(view, name, role, error) != 0 || segment_paths(&paths, name, error) != 0)
        return -1;
    if (paths.object[0] != '\0' && role != ROLE_NONE &&
        segment_lock(view, paths.lock, later, error) != 0)
        return -1;
    if (segment_map(view, role == ROLE_NONE ? NULL : layout_writable, error) != 0 ||
        (role != ROLE_NONE && view->lock_fd < 0 && unlocked(view, error) != 0)) {
        if (view->lock_fd >= 0)
            close(view->lock_fd);
        view->lock_fd = -1;
        view->holds_role = false;
        return -1;
    }
    if (view->holds_role)
        slot_taken(view);
    return 0;
}

int segment_attach(struct view *view, const char *name, enum role role, struct error_text *error)
{
    return attach(view, name, role, false, error);
}

int segment_stand_by(struct view *view, const char *name, enum role role, struct error_text *error)
{
    return attach(view, name, role, true, error);
}

int segment_take(struct view *view)
{
    struct flock byte = segment_role_byte(view->role);
    if (view->holds_role)
        return 0;
    CRASH_POINT("role taken over");
    while (fcntl(view->lock_fd, F_OFD_SETLKW, &byte) != 0) {
        if (errno != EINTR || process_stopping())
            return -1;
    }
    view->holds_role = true;
    return 0;
}

void segment_ready(struct view *view)
{
    if (atomic_load(&view->slot[view->role]->pid) != (uint32_t)getpid())
        slot_taken(view);
    CRASH_POINT("beat when ready");
    atomic_store(&view->slot[view->role]->beat_ns, clock_now_ns());
    CRASH_POINT("ready");
    atomic_store(&view->slot[view->role]->state, ROLE_READY);
}

void segment_detach(struct view *view)
{
    if (!view->base)
        return;
    if (view->holds_role) {
        CRASH_POINT("absent");
        atomic_store(&view->slot[view->role]->state, ROLE_ABSENT);
        CRASH_POINT("no pid");
        atomic_store(&view->slot[view->role]->pid, 0);
    }
    munmap(view->base, view->layout.total);
    process_guard_tells(NULL, 0, "");
    posts_file_close(&view->posts_file);
    view->base = NULL;
    if (view->lock_fd >= 0) {
        CRASH_POINT("role's unlock");
        close(view->lock_fd);
    }
    view->lock_fd = -1;
    view->holds_role = false;
}
