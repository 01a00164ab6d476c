/* Computes the partition that no other world has. */
#include "ipc/segment/world_partition.h"

#include "ipc/segment/runtime_folder.h"
#include "world/maths/hash.h"
#include "world/runtime/error_text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BOOT_FILE   "/proc/sys/kernel/random/boot_id"
#define BOOT_DIGITS 36

/* A device and an inode name a folder on one machine until it starts anew. */
struct identity {
    char boot[BOOT_DIGITS];
    uint32_t unused; /* 0: the hash covers every byte */
    uint64_t device, inode;
};
_Static_assert(sizeof(struct identity) == BOOT_DIGITS + 4 + 16, "the hash covers no padding");

static int read_boot(struct identity *identity, struct error_text *error)
{
    int fd = open(BOOT_FILE, O_RDONLY | O_CLOEXEC);
    ssize_t bytes = fd < 0 ? -1 : read(fd, identity->boot, sizeof identity->boot);
    int code = errno;
    if (fd >= 0)
        (void)close(fd);
    if (bytes == (ssize_t)sizeof identity->boot)
        return 0;
    return error_text_set(error, BOOT_FILE ": %s; Jolon tells worlds of one name apart by it",
                          bytes < 0 ? strerror(code) : "is too short");
}

int world_partition_own(char own[WORLD_PARTITION_MAX], const char *world, struct error_text *error)
{
    struct identity identity = {.unused = 0};
    struct stat status;
    if (read_boot(&identity, error) != 0)
        return -1;
    int fd = runtime_folder_open(error);
    if (fd < 0)
        return -1;
    int result = fstat(fd, &status);
    int code = errno;
    (void)close(fd);
    if (result != 0)
        return error_text_set(error, "the runtime folder: %s", strerror(code));
    identity.device = status.st_dev;
    identity.inode = status.st_ino;
    (void)snprintf(own, WORLD_PARTITION_MAX, "%s@%016" PRIx64, world,
                   (uint64_t)XXH3_64bits(&identity, sizeof identity));
    return 0;
}
