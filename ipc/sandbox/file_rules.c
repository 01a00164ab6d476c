/* Landlock rules, by system calls: the C library has no functions for them. */
#include "ipc/sandbox/file_rules.h"

#include "ipc/segment/runtime_folder.h"
#include "ipc/segment/segment.h"

#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <linux/landlock.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <unistd.h>

/* The headers may be older than the kernel. */
#ifndef LANDLOCK_ACCESS_FS_REFER
#define LANDLOCK_ACCESS_FS_REFER (1ull << 13)
#endif
#ifndef LANDLOCK_ACCESS_FS_TRUNCATE
#define LANDLOCK_ACCESS_FS_TRUNCATE (1ull << 14)
#endif

#ifndef LANDLOCK_SCOPE_SIGNAL
#define LANDLOCK_SCOPE_SIGNAL (1ull << 1)
#endif

/* What a ruleset handles. Older kernels take only the first members. */
struct handled {
    uint64_t files, network, scoped;
};

#define ACCESS_FIRST                                                                               \
    (LANDLOCK_ACCESS_FS_MAKE_SYM | (LANDLOCK_ACCESS_FS_MAKE_SYM - 1)) /* all rights of version 1   \
                                                                       */
#define ACCESS_READ   ((uint64_t)(LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR))
#define ACCESS_DEVICE (ACCESS_READ | LANDLOCK_ACCESS_FS_WRITE_FILE)
#define ACCESS_FOLDER                                                                              \
    (ACCESS_READ | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE |                \
     LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_TRUNCATE)
/* Beneath a folder of the set: also sockets, and renames from one folder into another. */
#define ACCESS_KEPT (ACCESS_FOLDER | LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_REFER)

/* Where distributions keep drivers, their settings and fonts, and where drivers read the machine's
 * properties. Landlock itself leaves out the entries of /proc of processes that are not
 * confined. */
static const char *const driver_paths[] = {"/usr",       "/lib*", "/etc",  "/opt",
                                           "/nix/store", "/sys",  "/proc", "/run/opengl-driver"};
static const char *const device_paths[] = {"/dev/dri",     "/dev/nvidia*", "/dev/null",
                                           "/dev/urandom", "/dev/random",  "/dev/zero"};

/* Worlds' objects, and what the C library and DDS read when they start. */
static const char *const visitor_paths[] = {"/dev/shm", "/usr", "/lib*", "/etc", "/sys", "/proc"};

static uint64_t known_rights(long version)
{
    uint64_t access = ACCESS_FIRST;
    if (version >= 2)
        access |= LANDLOCK_ACCESS_FS_REFER;
    if (version >= 3)
        access |= LANDLOCK_ACCESS_FS_TRUNCATE;
    return access;
}

static int allow(int ruleset, int fd, uint64_t access)
{
    const struct landlock_path_beneath_attr rule = {.allowed_access = access, .parent_fd = fd};
    return syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0
               ? 0
               : -errno;
}

/* Allows those paths that exist. A rule for a file may not have rights of folders. */
static int allow_paths(int ruleset, const char *const *paths, size_t count, uint64_t access)
{
    int result = 0;
    for (size_t i = 0; i < count; i++) {
        glob_t found;
        if (glob(paths[i], 0, NULL, &found) != 0)
            continue;
        for (size_t k = 0; k < found.gl_pathc && result == 0; k++) {
            int fd = open(found.gl_pathv[k], O_PATH | O_CLOEXEC);
            if (fd < 0)
                continue;
            result = allow(ruleset, fd, access);
            if (result == -EINVAL)
                result = allow(ruleset, fd, access & ~(uint64_t)LANDLOCK_ACCESS_FS_READ_DIR);
            close(fd);
        }
        globfree(&found);
    }
    return result;
}

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* What the console reads: visitor_paths, and the worlds' names and locks. */
static int allow_worlds(int ruleset)
{
    struct error_text error;
    int folder = runtime_folder_open(&error);
    int result = allow_paths(ruleset, visitor_paths, COUNT(visitor_paths), ACCESS_READ);
    if (folder < 0 || result != 0)
        return result;
    result = allow(ruleset, folder, ACCESS_READ);
    close(folder);
    return result;
}

/* Returns the version of the kernel's Landlock, or a negative errno. */
static long landlock_version(void)
{
    long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    return version < 0 ? -errno : version;
}

static int new_ruleset(long version, uint64_t scoped)
{
    const struct handled handled = {.files = known_rights(version), .scoped = scoped};
    size_t size = version >= 6 ? sizeof handled : sizeof handled.files;
    int ruleset = (int)syscall(SYS_landlock_create_ruleset, &handled, size, 0);
    return ruleset < 0 ? -errno : ruleset;
}

/* Confines the calling thread by the ruleset and closes it. result is that of the rules before. */
static int restrict_self(int ruleset, int result)
{
    if (result == 0 && syscall(SYS_landlock_restrict_self, ruleset, 0) != 0)
        result = -errno;
    close(ruleset);
    return result;
}

int file_rules_confine(enum role role, const int *folders, size_t count)
{
    long version = landlock_version();
    int ruleset = version < 0 ? (int)version : new_ruleset(version, 0);
    if (ruleset < 0)
        return ruleset;
    int result = 0;
    for (size_t i = 0; i < count && result == 0; i++)
        result = allow(ruleset, folders[i], ACCESS_FOLDER & known_rights(version));
    bool drivers = role_has(role, ROLE_DRAWS);
    if (drivers && result == 0)
        result = allow_paths(ruleset, driver_paths, COUNT(driver_paths), ACCESS_READ);
    if (role == ROLE_CONSOLE && result == 0)
        result = allow_worlds(ruleset);
    if (drivers && result == 0)
        result = allow_paths(ruleset, device_paths, COUNT(device_paths), ACCESS_DEVICE);
    return restrict_self(ruleset, result);
}

int file_rules_confine_keeper(const char *const *folders, size_t count)
{
    static const char *const everything[] = {"/"};
    long version = landlock_version();
    int ruleset =
        version < 0 ? (int)version : new_ruleset(version, version >= 6 ? LANDLOCK_SCOPE_SIGNAL : 0);
    if (ruleset < 0)
        return ruleset;
    int result = allow_paths(ruleset, everything, 1, ACCESS_READ | LANDLOCK_ACCESS_FS_EXECUTE);
    for (size_t i = 0; i < count && result == 0; i++) {
        int fd = open(folders[i], O_PATH | O_DIRECTORY | O_CLOEXEC);
        if (fd < 0)
            continue; /* nothing can be written there */
        result = allow(ruleset, fd, ACCESS_KEPT & known_rights(version));
        close(fd);
    }
    if (result == 0)
        result = allow_paths(ruleset, device_paths, COUNT(device_paths), ACCESS_DEVICE);
    return restrict_self(ruleset, result);
}
