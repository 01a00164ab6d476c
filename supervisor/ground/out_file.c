/* Keeps maps, pipes and devices from being replaced by what is made, and pipes from being read. */
#include "supervisor/ground/out_file.h"

#include "world/runtime/error_text.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int check_folder(const char *path, struct error_text *error)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    int length = slash ? (int)(slash - path) + 1 : 2;
    if (length >= (int)sizeof folder)
        return error_text_set(error, "%s: is no name for a file", path);
    snprintf(folder, sizeof folder, "%.*s", length, slash ? path : "./");
    return access(folder, W_OK | X_OK) == 0
               ? 0
               : error_text_set(error, "%s: cannot be written: %s", path, strerror(errno));
}

int out_file_check(const char *path, char *const *maps, uint32_t count, struct error_text *error)
{
    struct stat out, map;
    if (check_folder(path, error) != 0)
        return -1;
    bool old = stat(path, &out) == 0;
    if (old && !S_ISREG(out.st_mode))
        return error_text_set(error,
                              "%s: is %s, not a file; right would be the name of a new file, or "
                              "of one that may be replaced",
                              path, S_ISDIR(out.st_mode) ? "a folder" : "a pipe or a device");
    for (uint32_t i = 0; i < count; i++) {
        if (stat(maps[i], &map) != 0)
            continue;
        if (old && map.st_dev == out.st_dev && map.st_ino == out.st_ino)
            return error_text_set(error,
                                  "%s: is read, and what is made would replace it; right would be "
                                  "another name",
                                  path);
        if (!S_ISREG(map.st_mode) && !S_ISDIR(map.st_mode))
            return error_text_set(error,
                                  "%s: is a pipe or a device, which cannot be read as a map; right "
                                  "would be a file with its content",
                                  maps[i]);
    }
    return 0;
}
