/* Removes the unfinished files of killed processes. */
#include "ipc/process/stale_files.h"

#include "ipc/process/crash_point.h"
#include "ipc/process/process.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void stale_files_sweep(const char *folder, const char *prefix)
{
    size_t length = strlen(prefix);
    DIR *directory = opendir(folder);
    if (!directory)
        return;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strncmp(entry->d_name, prefix, length) != 0)
            continue;
        char *end;
        long pid = strtol(entry->d_name + length, &end, 10);
        if (*end != '\0' || pid <= 0)
            continue;
        /* A file with our own pid was left by an earlier process. */
        if (pid != getpid() && !process_has_ended((int)pid))
            continue;
        CRASH_POINT("swept temporary");
        unlinkat(dirfd(directory), entry->d_name, 0);
    }
    closedir(directory);
}
