/* Opening a regular file. */
#include "ipc/process/regular_file.h"

#include "world/runtime/error_text.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int regular_file_open(const char *path, uint64_t *bytes, struct error_text *error)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0 && errno == ELOOP)
        return error_text_set(error, "%s: is a symbolic link; name the file itself", path);
    if (fd < 0)
        return error_text_set(error, "%s: cannot open: %s", path, strerror(errno));
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(fd);
        return error_text_set(error, "%s: is no plain file", path);
    }
    *bytes = (uint64_t)status.st_size;
    return fd;
}
