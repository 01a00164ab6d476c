/* Verbs about worlds' names: list, paths, remove, sweep. */
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "ipc/segment/segment.h"
#include "ipc/segment/world_partition.h"
#include "recorder/replay/arguments.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define LISTED_MAX 256

static void list_names(bool all)
{
    static char names[LISTED_MAX][SEGMENT_NAME_MAX];
    struct error_text error;
    int count = segment_list(names, LISTED_MAX, all, &error);
    if (count < 0)
        die_refused("%s", error.text);
    for (int i = 0; i < count; i++)
        printf("%s\n", names[i]);
}

static void list_lost(void)
{
    static char files[LISTED_MAX][SEGMENT_LOST_MAX];
    int count = segment_list_lost(files, LISTED_MAX);
    for (int i = 0; i < count; i++)
        printf("/dev/shm/%s\n", files[i]);
}

int verb_list(const struct arguments *arguments)
{
    const char *what = arguments->path ? arguments->path : "worlds";
    if (strcmp(what, "lost") == 0)
        list_lost();
    else if (strcmp(what, "all") == 0 || strcmp(what, "worlds") == 0)
        list_names(what[0] == 'a');
    else
        die_usage("list %s: there are worlds, all, lost", what);
    return EXIT_OK;
}

int verb_paths(const struct arguments *arguments)
{
    struct segment_paths paths;
    char partition[WORLD_PARTITION_MAX];
    struct error_text error;
    if (segment_paths(&paths, arguments->world, &error) != 0 ||
        world_partition_own(partition, arguments->world, &error) != 0)
        die_refused("%s", error.text);
    const char *const rows[][2] = {{"name", paths.name},
                                   {"lock", paths.lock},
                                   {"object", paths.object},
                                   {"partition", partition}};
    bool found = arguments->path == NULL;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (!arguments->path) {
            printf("%s %s\n", rows[i][0], rows[i][1]);
        } else if (strcmp(arguments->path, rows[i][0]) == 0) {
            printf("%s\n", rows[i][1]);
            found = true;
        }
    }
    if (!found)
        die_usage("paths %s: there are name, lock, object, partition", arguments->path);
    return EXIT_OK;
}

int verb_remove(const struct arguments *arguments)
{
    struct error_text error;
    if (segment_remove(arguments->world, arguments->force, &error) != 0)
        die_refused("%s", error.text);
    return EXIT_OK;
}

int verb_sweep(const struct arguments *arguments)
{
    struct error_text error;
    if (segment_sweep(arguments->world, &error) != 0)
        die_refused("%s", error.text);
    return EXIT_OK;
}
