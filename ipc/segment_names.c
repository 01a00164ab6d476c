/* Worlds by name: their paths, their locks, what there is and what is left of dead makers. */
#include "ipc/clock.h"
#include "ipc/crash.h"
#include "ipc/leftovers.h"
#include "ipc/process.h"
#include "ipc/segment_own.h"
#include "world/utf8.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

int reason_set(struct reason *reason, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)utf8_format(reason->text, sizeof reason->text, format, args);
    va_end(args);
    reason->foreign = reason->damaged = false;
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
    snprintf(shm, SEGMENT_PATH_MAX, SEGMENT_DIR "/jolon.%u.%s", (unsigned)getuid(), name);
    snprintf(lock, SEGMENT_PATH_MAX, SEGMENT_DIR "/jolon.%u.%s.lock", (unsigned)getuid(), name);
}

void segment_temporary(const char *name, char path[SEGMENT_PATH_MAX])
{
    snprintf(path, SEGMENT_PATH_MAX, SEGMENT_DIR "/jolon.%u.%s.new-%d", (unsigned)getuid(), name,
             (int)getpid());
}

int segment_open_lock(const char *path, int flags, struct reason *reason)
{
    struct stat status;
    int fd = open(path, O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | flags, 0600);
    if (fd < 0) {
        int error = errno;
        reason_set(reason, "%s: cannot open: %s", path, strerror(error));
        errno = error;
        return -1;
    }
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(fd);
        reason_set(reason, "%s: is no plain file; remove it", path);
        errno = EINVAL;
        return -1;
    }
    return fd;
}

/* Objects that creators of this world left when they were killed before publishing. */
void segment_sweep(const char *name)
{
    char prefix[SEGMENT_PATH_MAX];
    snprintf(prefix, sizeof prefix, "jolon.%u.%s.new-", (unsigned)getuid(), name);
    leftovers_sweep(SEGMENT_DIR, prefix);
}

struct flock segment_role_byte(enum role role)
{
    return (struct flock){.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = role, .l_len = 1};
}

/* Has anybody else's descriptor of the lock file the role's byte? */
static bool byte_held(int fd, enum role role)
{
    struct flock byte = segment_role_byte(role);
    return fcntl(fd, F_OFD_GETLK, &byte) == 0 && byte.l_type != F_UNLCK;
}

/* 1, 0, or -1 with the reason when it cannot be told; without a lock file nobody holds a role. */
static int lock_held(const char *path, enum role role, struct reason *reason)
{
    int fd = segment_open_lock(path, O_RDONLY, reason);
    if (fd < 0)
        return errno == ENOENT ? 0 : -1;
    int held = byte_held(fd, role);
    close(fd);
    return held;
}

bool segment_held(const struct view *view, enum role role)
{
    return role == view->role ? view->holds : byte_held(view->lock_fd, role);
}

int segment_holder(const char *name, enum role role)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX];
    struct view view;
    struct reason reason;
    segment_paths(name, shm, lock);
    if (lock_held(lock, role, &reason) <= 0 || segment_attach(&view, name, ROLE_NONE, &reason) != 0)
        return 0;
    int pid = (int)atomic_load(&view.slot[role]->pid);
    segment_detach(&view);
    return pid;
}

int segment_holder_alive(const char *name, enum role role, uint64_t until_ns)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX];
    struct reason reason;
    segment_paths(name, shm, lock);
    while (lock_held(lock, role, &reason) > 0) {
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

/* The first of the roles 0 .. last that is held; ROLE_NONE when none is, -1 with the reason. */
static int first_held(const char *lock, enum role last, struct reason *reason)
{
    for (int role = 0; role <= (int)last; role++) {
        int held = lock_held(lock, (enum role)role, reason);
        if (held != 0)
            return held > 0 ? role : -1;
    }
    return ROLE_NONE;
}

int segment_wait_free(const char *name, enum role last, uint64_t until_ns, struct reason *reason)
{
    char shm[SEGMENT_PATH_MAX], lock[SEGMENT_PATH_MAX], who[32] = "a process";
    int role;
    segment_paths(name, shm, lock);
    while ((role = first_held(lock, last, reason)) >= 0 && role != ROLE_NONE) {
        if (clock_now_ns() >= until_ns) {
            int pid = segment_holder_alive(name, (enum role)role, until_ns);
            if (pid != 0)
                snprintf(who, sizeof who, "pid %d", pid);
            return reason_set(
                reason,
                "the %s of world \"%s\" is kept by %s, which is not of this set; end it first",
                role_name((enum role)role), name, who);
        }
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
    return role < 0 ? -1 : 0;
}

int segment_remove_lock(const char *path, struct reason *reason)
{
    int result = 0;
    int fd = segment_open_lock(path, O_RDWR, reason);
    if (fd < 0)
        return errno == ENOENT ? 0 : -1;
    CRASH_POINT("removed lock file");
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
        int held = lock_held(lock, (enum role)role, reason);
        if (held < 0)
            return -1;
        if (held > 0)
            return reason_set(reason, "world \"%s\" is in use: its %s runs (pid %d); stop it first",
                              name, role_name((enum role)role),
                              segment_holder(name, (enum role)role));
    }
    segment_sweep(name);
    CRASH_POINT("removed object");
    if (unlink(shm) != 0 && errno != ENOENT)
        return reason_set(reason, "%s: cannot remove: %s", shm, strerror(errno));
    return segment_remove_lock(lock, reason);
}

int segment_list(char names[][SEGMENT_NAME_MAX], int max)
{
    char prefix[SEGMENT_PATH_MAX];
    int length = snprintf(prefix, sizeof prefix, "jolon.%u.", (unsigned)getuid());
    int count = 0;
    DIR *directory = opendir(SEGMENT_DIR);
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
