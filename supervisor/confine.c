/* The folders that a set of processes writes in. */
#include "supervisor/confine.h"

#include "ipc/segment/runtime_folder.h"
#include "ipc/sandbox/sandbox.h"

#include <stdio.h>
#include <string.h>

#define FOLDERS_MAX   8
#define PATH_BYTES    4096
#define SHARED_MEMORY "/dev/shm"

struct folders {
    char path[FOLDERS_MAX][PATH_BYTES];
    const char *name[FOLDERS_MAX];
    size_t count;
};

static void add(struct folders *folders, const char *path, size_t length)
{
    char *copy = folders->path[folders->count];
    snprintf(copy, PATH_BYTES, "%.*s", (int)length, path);
    folders->name[folders->count++] = copy;
}

/* Adds the folder of a file; does nothing if file is NULL. */
static void add_folder_of(struct folders *folders, const char *file)
{
    const char *slash = file ? strrchr(file, '/') : NULL;
    if (slash)
        add(folders, file, slash == file ? 1 : (size_t)(slash - file));
    else if (file)
        add(folders, ".", 1);
}

static const char *video(const struct plan *plan)
{
    const struct role_options *role_options = &plan->role_options[ROLE_RENDERER];
    for (int i = 0; i + 1 < role_options->count; i += 2) {
        if (strcmp(role_options->argument[i], "--video") == 0)
            return role_options->argument[i + 1];
    }
    return NULL;
}

int confine_keeper(const struct plan *plan, struct error_text *error)
{
    struct folders folders = {.count = 0};
    char runtime[RUNTIME_FOLDER_MAX];
    if (plan->sandbox_off)
        return 0;
    if (runtime_folder(runtime, error) != 0)
        return -1;
    add(&folders, runtime, strlen(runtime));
    add(&folders, SHARED_MEMORY, strlen(SHARED_MEMORY));
    add(&folders, plan->out, strlen(plan->out));
    add_folder_of(&folders, plan->log);
    add_folder_of(&folders, plan->commands);
    add_folder_of(&folders, plan->events);
    add_folder_of(&folders, plan->checkpoint);
    add_folder_of(&folders, video(plan));
    return sandbox_keeper(folders.name, folders.count, error);
}
