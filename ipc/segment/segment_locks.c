/* The lock file beside a world's name: one byte for each role, and one for the name itself. */
#include "ipc/segment/segment_locks.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define NAME_BYTE 4096 /* beyond the roles' bytes */
#define NAME_NS   (5 * (uint64_t)NS_PER_S)

int segment_open_lock(const char *path, int flags, struct error_text *error)
{
    struct stat status;
    int fd = open(path, O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | flags, 0600);
    if (fd < 0) {
        int code = errno;
        error_text_set(error, "%s: cannot open: %s", path, strerror(code));
        errno = code;
        return -1;
    }
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(fd);
        error_text_set(error, "%s: is no plain file; remove it", path);
        errno = EINVAL;
        return -1;
    }
    return fd;
}

struct flock segment_role_byte(enum role role)
{
    return (struct flock){.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = role, .l_len = 1};
}

/* Returns true if another descriptor of the lock file holds the role's byte. */
static bool byte_held(int fd, enum role role)
{
    struct flock byte = segment_role_byte(role);
    return fcntl(fd, F_OFD_GETLK, &byte) == 0 && byte.l_type != F_UNLCK;
}

/* Returns 1 or 0, or -1 with the reason. Without a lock file no role is held. */
static int lock_held(const char *path, enum role role, struct error_text *error)
{
    int fd = segment_open_lock(path, O_RDONLY, error);
    if (fd < 0)
        return errno == ENOENT ? 0 : -1;
    int held = byte_held(fd, role);
    close(fd);
    return held;
}

bool segment_held(const struct view *view, enum role role)
{
    return role == view->role ? view->holds_role : byte_held(view->lock_fd, role);
}

int segment_holder(const char *name, enum role role)
{
    struct segment_paths paths;
    struct view view;
    struct error_text error;
    if (segment_paths(&paths, name, &error) != 0 || lock_held(paths.lock, role, &error) <= 0 ||
        segment_attach(&view, name, ROLE_NONE, &error) != 0)
        return 0;
    int pid = (int)atomic_load(&view.slot[role]->pid);
    segment_detach(&view);
    return pid;
}

int segment_holder_alive(const char *name, enum role role, uint64_t until_ns)
{
    struct segment_paths paths;
    struct error_text error;
    if (segment_paths(&paths, name, &error) != 0)
        return 0;
    while (lock_held(paths.lock, role, &error) > 0) {
        int pid = segment_holder(name, role);
        char state = pid != 0 ? process_state(pid) : '\0';
        if (state != '\0' && state != 'Z')
            return pid;
        if (clock_now_ns() >= until_ns)
            break;
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
    return 0;
}

int segment_first_held(const char *path, enum role last, struct error_text *error)
{
    for (int role = 0; role <= (int)last; role++) {
        int held = lock_held(path, (enum role)role, error);
        if (held != 0)
            return held > 0 ? role : -1;
    }
    return ROLE_NONE;
}

int segment_wait_free(const char *name, enum role last, uint64_t until_ns, struct error_text *error)
{
    char holder[32] = "a process";
    struct segment_paths paths;
    int role;
    if (segment_paths(&paths, name, error) != 0)
        return -1;
    while ((role = segment_first_held(paths.lock, last, error)) >= 0 && role != ROLE_NONE) {
        if (clock_now_ns() >= until_ns) {
            int pid = segment_holder_alive(name, (enum role)role, until_ns);
            if (pid != 0)
                snprintf(holder, sizeof holder, "pid %d", pid);
            return error_text_set(
                error,
                "the %s of world \"%s\" is kept by %s, which is not of this set; end it first",
                role_name((enum role)role), name, holder);
        }
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
    return role < 0 ? -1 : 0;
}

/* Opens the lock file, and makes it when there is none. Sets made if it did. */
static int open_or_make(const char *path, bool *made, struct error_text *error)
{
    int fd = segment_open_lock(path, O_RDWR | O_CREAT | O_EXCL, error);
    *made = fd >= 0;
    return fd < 0 && errno == EEXIST ? segment_open_lock(path, O_RDWR | O_CREAT, error) : fd;
}

/* Creation and removal hold the byte for a short time, so the lock is tried until it succeeds. The
 * file may be removed and made again between open and lock; then it is opened again. */
int segment_lock_name(const char *path, bool *made, struct error_text *error)
{
    uint64_t until = clock_now_ns() + NAME_NS;
    for (;;) {
        struct stat held, named;
        struct flock byte = {
            .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = NAME_BYTE, .l_len = 1};
        int fd = open_or_make(path, made, error);
        if (fd < 0)
            return -1;
        bool ours = fcntl(fd, F_OFD_SETLK, &byte) == 0;
        if (!ours && errno != EAGAIN && errno != EACCES) {
            error_text_set(error, "%s: cannot lock: %s", path, strerror(errno));
            close(fd);
            if (*made)
                unlink(path);
            return -1;
        }
        if (ours && fstat(fd, &held) == 0 && stat(path, &named) == 0 &&
            held.st_ino == named.st_ino && held.st_dev == named.st_dev)
            return fd;
        close(fd);
        if (clock_now_ns() >= until)
            return error_text_set(
                error,
                "%s: a process that makes or removes this world has held it for 5 s; "
                "look for a stopped jolon-world",
                path);
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
}
