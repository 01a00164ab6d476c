/* Landlock's rules, by the system calls themselves: the C library has no functions for them. */
#include "sandbox/files.h"

#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <linux/landlock.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Of later kernels than the headers. */
#ifndef LANDLOCK_ACCESS_FS_REFER
#define LANDLOCK_ACCESS_FS_REFER (1ull << 13)
#endif
#ifndef LANDLOCK_ACCESS_FS_TRUNCATE
#define LANDLOCK_ACCESS_FS_TRUNCATE (1ull << 14)
#endif

#define ACCESS_FIRST                                                                               \
    (LANDLOCK_ACCESS_FS_MAKE_SYM | (LANDLOCK_ACCESS_FS_MAKE_SYM - 1)) /* all of version 1 */
#define ACCESS_READ   ((uint64_t)(LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR))
#define ACCESS_DEVICE (ACCESS_READ | LANDLOCK_ACCESS_FS_WRITE_FILE)
#define ACCESS_FOLDER                                                                              \
    (ACCESS_READ | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE |                \
     LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_TRUNCATE)

/* Where distributions keep drivers, their settings and fonts; and what drivers ask of the machine.
 * Of /proc, Landlock itself leaves out what belongs to processes that are not confined. */
static const char *const driver_paths[] = {"/usr",       "/lib*", "/etc",  "/opt",
                                           "/nix/store", "/sys",  "/proc", "/run/opengl-driver"};
static const char *const device_paths[] = {"/dev/dri",     "/dev/nvidia*", "/dev/null",
                                           "/dev/urandom", "/dev/random",  "/dev/zero"};

/* Worlds, and what the C library and DDS ask of the machine when they start. */
static const char *const visitor_paths[] = {"/dev/shm", "/usr", "/lib*", "/etc", "/sys", "/proc"};

static uint64_t known(long version)
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

/* Those that there are; a rule for what is no folder may not speak of folders. */
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

int files_confine(enum role role, const int *folders, size_t count)
{
    long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 0)
        return -errno;
    const struct landlock_ruleset_attr handled = {.handled_access_fs = known(version)};
    int ruleset = (int)syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0);
    if (ruleset < 0)
        return -errno;
    int result = 0;
    for (size_t i = 0; i < count && result == 0; i++)
        result = allow(ruleset, folders[i], ACCESS_FOLDER & known(version));
    bool drivers = role >= ROLE_RENDERER && role <= ROLE_RENDERER_4;
    if (drivers && result == 0)
        result = allow_paths(ruleset, driver_paths, COUNT(driver_paths), ACCESS_READ);
    if (role == ROLE_CONSOLE && result == 0)
        result = allow_paths(ruleset, visitor_paths, COUNT(visitor_paths), ACCESS_READ);
    if (drivers && result == 0)
        result = allow_paths(ruleset, device_paths, COUNT(device_paths), ACCESS_DEVICE);
    if (result == 0 && syscall(SYS_landlock_restrict_self, ruleset, 0) != 0)
        result = -errno;
    close(ruleset);
    return result;
}
