/* Worlds by name: the object of a name, and how a world gets its name and is removed.
 *
 * Creation and removal hold the name's byte of the lock file while they look at a name and change
 * it. So a name that leads to no object, seen with that byte held, was left by a dead process. */
#include "ipc/segment/world_names.h"

#include "ipc/process/crash_point.h"
#include "ipc/segment/segment_internal.h"
#include "ipc/segment/segment_locks.h"
#include "world/runtime/error_text.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#define RANDOM_BYTES  16
#define RANDOM_DIGITS (2 * RANDOM_BYTES)
#define HEX_DIGITS    "0123456789abcdef"

bool segment_name_ok(const char *name)
{
    size_t length = strlen(name);
    return length > 0 && length < SEGMENT_NAME_MAX &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

int segment_name_check(const char *name, struct error_text *error)
{
    return segment_name_ok(name)
               ? 0
               : error_text_set(error, "\"%s\" is no name for a world: 1 to %d of a-z A-Z 0-9 _ -",
                                name, SEGMENT_NAME_MAX - 1);
}

int segment_name_option(const char *name, struct error_text *detail)
{
    return segment_name_ok(name)
               ? 0
               : error_text_set(detail, "no name for a world: 1 to %d of a-z A-Z 0-9 _ -",
                                SEGMENT_NAME_MAX - 1);
}

/* --- where a name leads ------------------------------------------------------------------------*/

static int name_prefix(char prefix[SEGMENT_PATH_MAX], const char *name)
{
    return snprintf(prefix, SEGMENT_PATH_MAX, SEGMENT_DIR "/jolon.%u.%s.", (unsigned)getuid(),
                    name);
}

/* Returns true if this is the path of an object of this user's world of that name. */
static bool object_path_ok(const char *path, const char *name)
{
    char prefix[SEGMENT_PATH_MAX];
    size_t length = (size_t)name_prefix(prefix, name);
    return strncmp(path, prefix, length) == 0 && strlen(path + length) == RANDOM_DIGITS &&
           strspn(path + length, HEX_DIGITS) == RANDOM_DIGITS;
}

/* Reads the link's target into paths->object, whether it exists or not; "" when there is no
 * link. */
static int read_name(struct segment_paths *paths, const char *name, struct error_text *error)
{
    ssize_t length = readlink(paths->name, paths->object, sizeof paths->object - 1);
    paths->object[length > 0 ? length : 0] = '\0';
    if (length > 0 && object_path_ok(paths->object, name))
        return 0;
    paths->object[0] = '\0';
    if (length < 0 && errno != EINVAL)
        return errno == ENOENT
                   ? 0
                   : error_text_set(error, "%s: cannot read: %s", paths->name, strerror(errno));
    return error_text_set(error,
                          "%s: is no link to a world's object (" SEGMENT_DIR
                          "/jolon.%u.%s.<32 hexadecimal digits>); remove it",
                          paths->name, (unsigned)getuid(), name);
}

int segment_paths(struct segment_paths *paths, const char *name, struct error_text *error)
{
    char folder[RUNTIME_FOLDER_MAX];
    *paths = (struct segment_paths){.object = ""};
    if (segment_name_check(name, error) != 0 || runtime_folder(folder, error) != 0)
        return -1;
    snprintf(paths->name, sizeof paths->name, "%s/%s", folder, name);
    snprintf(paths->lock, sizeof paths->lock, "%s/%s.lock", folder, name);
    if (read_name(paths, name, error) != 0)
        return -1;
    if (paths->object[0] != '\0' && access(paths->object, F_OK) != 0)
        paths->object[0] = '\0';
    return 0;
}

/* --- creation ----------------------------------------------------------------------------------*/

/* Makes a random path, which no other user can guess and create first. */
static int new_object_path(char path[SEGMENT_PATH_MAX], const char *name, struct error_text *error)
{
    unsigned char bytes[RANDOM_BYTES];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return error_text_set(error, "the system gives no random numbers: %s", strerror(errno));
    int length = name_prefix(path, name);
    for (size_t i = 0; i < sizeof bytes; i++)
        length += snprintf(path + length, (size_t)(SEGMENT_PATH_MAX - length), "%02x", bytes[i]);
    return 0;
}

/* Requires the lock on the name. A name without an object was left by a dead process, or its object
 * was removed by other means; a role that still runs then has that object mapped. */
static int free_name(const struct segment_paths *paths, const char *name, struct error_text *error)
{
    if (paths->object[0] != '\0')
        return error_text_set(error,
                              "world \"%s\" exists already; `jolon status -w %s` shows it, `jolon "
                              "stop -w %s` ends it, -w NAME makes another",
                              name, name, name);
    int role = segment_first_held(paths->lock, ROLE_COUNT - 1, error);
    if (role < 0)
        return -1;
    if (role != ROLE_NONE)
        return error_text_set(
            error, "the object of world \"%s\" is gone, but its %s still runs; end it first", name,
            role_name((enum role)role));
    CRASH_POINT("name that leads nowhere");
    if (unlink(paths->name) != 0 && errno != ENOENT)
        return error_text_set(error, "%s: cannot remove: %s", paths->name, strerror(errno));
    return 0;
}

/* First the name, then the object. A kill between them leaves a name that leads nowhere, and never
 * an object without a name. */
static int link_names(const char *name, int fd, struct segment_paths *paths,
                      struct error_text *error)
{
    char made[64];
    snprintf(made, sizeof made, "/proc/self/fd/%d", fd);
    if (new_object_path(paths->object, name, error) != 0)
        return -1;
    CRASH_POINT("name");
    if (symlink(paths->object, paths->name) != 0)
        return error_text_set(error, "%s: cannot make: %s", paths->name, strerror(errno));
    CRASH_POINT("object");
    if (linkat(AT_FDCWD, made, AT_FDCWD, paths->object, AT_SYMLINK_FOLLOW) != 0) {
        error_text_set(error, "%s: cannot make: %s", paths->object, strerror(errno));
        unlink(paths->name);
        return -1;
    }
    CRASH_POINT("after the names");
    return 0;
}

int segment_give_names(const char *name, int fd, struct error_text *error)
{
    struct segment_paths before, paths;
    if (segment_paths(&before, name, error) != 0)
        return -1;
    CRASH_POINT("lock file");
    bool made;
    int lock = segment_lock_name(before.lock, &made, error);
    if (lock < 0)
        return -1;
    int result = -1;
    if (segment_paths(&paths, name, error) == 0 && free_name(&paths, name, error) == 0)
        result = link_names(name, fd, &paths, error);
    if (result != 0 && made)
        unlink(before.lock); /* segment_sweep() cannot when no file can be opened */
    close(lock);
    if (result != 0) {
        struct error_text second;
        segment_sweep(name, &second); /* the first reason is reported */
    }
    return result;
}

/* --- removal -----------------------------------------------------------------------------------*/

/* Removes the roles' sockets, "NAME.SUFFIX" beside the name. */
static void remove_sockets(const struct segment_paths *paths, const char *name)
{
    char folder[RUNTIME_FOLDER_MAX];
    size_t length = strlen(name);
    struct stat status;
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(paths->name, '/') - paths->name),
             paths->name);
    DIR *directory = opendir(folder);
    if (!directory)
        return;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strncmp(entry->d_name, name, length) != 0 || entry->d_name[length] != '.' ||
            fstatat(dirfd(directory), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISSOCK(status.st_mode))
            continue;
        CRASH_POINT("removed socket");
        unlinkat(dirfd(directory), entry->d_name, 0);
    }
    closedir(directory);
}

/* Requires the lock on the name, through fd. A supervisor holds the whole file by flock(2) as long
 * as it lives; own says that the caller is that supervisor. */
static int remove_all(const struct segment_paths *paths, const char *name, int fd, bool own,
                      struct error_text *error)
{
    CRASH_POINT("removed object");
    if (paths->object[0] != '\0' && unlink(paths->object) != 0 && errno != ENOENT)
        return error_text_set(error, "%s: cannot remove: %s", paths->object, strerror(errno));
    CRASH_POINT("removed name");
    if (unlink(paths->name) != 0 && errno != ENOENT)
        return error_text_set(error, "%s: cannot remove: %s", paths->name, strerror(errno));
    remove_sockets(paths, name);
    CRASH_POINT("removed lock file");
    if ((own || flock(fd, LOCK_EX | LOCK_NB) == 0) && unlink(paths->lock) != 0)
        return error_text_set(error, "%s: cannot remove: %s", paths->lock, strerror(errno));
    return 0;
}

static int refuse_if_held(const struct segment_paths *paths, const char *name,
                          struct error_text *error)
{
    int role = segment_first_held(paths->lock, ROLE_COUNT - 1, error);
    if (role < 0 || role == ROLE_NONE)
        return role < 0 ? -1 : 0;
    return error_text_set(error, "world \"%s\" is in use: its %s runs (pid %d); stop it first",
                          name, role_name((enum role)role), segment_holder(name, (enum role)role));
}

enum removal { REMOVE_UNUSED, REMOVE_FORCED, REMOVE_OWN, REMOVE_REMAINS };

static int remove_world(const char *name, enum removal removal, struct error_text *error)
{
    struct segment_paths paths;
    if (segment_paths(&paths, name, error) != 0 ||
        (removal != REMOVE_FORCED && refuse_if_held(&paths, name, error) != 0))
        return -1;
    bool made;
    int fd = segment_lock_name(paths.lock, &made, error);
    if (fd < 0)
        return -1;
    int result = segment_paths(&paths, name, error);
    if (result == 0 && (removal != REMOVE_REMAINS || paths.object[0] == '\0'))
        result = remove_all(&paths, name, fd, removal == REMOVE_OWN, error);
    close(fd);
    return result;
}

int segment_remove(const char *name, bool force, struct error_text *error)
{
    return remove_world(name, force ? REMOVE_FORCED : REMOVE_UNUSED, error);
}

int segment_remove_own(const char *name, struct error_text *error)
{
    return remove_world(name, REMOVE_OWN, error);
}

int segment_sweep(const char *name, struct error_text *error)
{
    return remove_world(name, REMOVE_REMAINS, error);
}

/* --- lists -------------------------------------------------------------------------------------*/

static bool listed(char names[][SEGMENT_NAME_MAX], int count, const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(names[i], name) == 0)
            return true;
    }
    return false;
}

int segment_list(char names[][SEGMENT_NAME_MAX], int max, bool all, struct error_text *error)
{
    char folder[RUNTIME_FOLDER_MAX];
    int count = 0;
    if (runtime_folder(folder, error) != 0)
        return -1;
    DIR *directory = opendir(folder);
    if (!directory)
        return error_text_set(error, "%s: cannot read: %s", folder, strerror(errno));
    for (struct dirent *entry = readdir(directory); entry && count < max;
         entry = readdir(directory)) {
        struct segment_paths paths;
        struct error_text detail;
        char name[SEGMENT_NAME_MAX];
        size_t length = all ? strcspn(entry->d_name, ".") : strlen(entry->d_name);
        if (length >= sizeof name)
            continue;
        snprintf(name, sizeof name, "%.*s", (int)length, entry->d_name);
        if (segment_name_ok(name) && !listed(names, count, name) &&
            (all || (segment_paths(&paths, name, &detail) == 0 && paths.object[0] != '\0')))
            memcpy(names[count++], name, sizeof name);
    }
    closedir(directory);
    return count;
}

/* Returns true if a name of the runtime folder leads to this file of /dev/shm. */
static bool named_here(const char *file)
{
    struct segment_paths paths;
    struct error_text error;
    char path[SEGMENT_PATH_MAX], name[SEGMENT_NAME_MAX];
    const char *begin = strchr(file + strlen("jolon."), '.') + 1;
    size_t length = strcspn(begin, ".");
    if (length >= sizeof name)
        return false;
    snprintf(name, sizeof name, "%.*s", (int)length, begin);
    snprintf(path, sizeof path, SEGMENT_DIR "/%s", file);
    return segment_name_ok(name) && segment_paths(&paths, name, &error) == 0 &&
           strcmp(paths.object, path) == 0;
}

int segment_list_lost(char files[][SEGMENT_LOST_MAX], int max)
{
    char prefix[32];
    struct stat status;
    int length = snprintf(prefix, sizeof prefix, "jolon.%u.", (unsigned)getuid());
    int count = 0;
    DIR *directory = opendir(SEGMENT_DIR);
    if (!directory)
        return 0;
    for (struct dirent *entry = readdir(directory); entry && count < max;
         entry = readdir(directory)) {
        /* Any user may make a file of such a name, so only this user's are listed. */
        if (strncmp(entry->d_name, prefix, (size_t)length) == 0 &&
            strlen(entry->d_name) < SEGMENT_LOST_MAX && !named_here(entry->d_name) &&
            fstatat(dirfd(directory), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
            status.st_uid == getuid())
            snprintf(files[count++], SEGMENT_LOST_MAX, "%.*s", SEGMENT_LOST_MAX - 1, entry->d_name);
    }
    closedir(directory);
    return count;
}
