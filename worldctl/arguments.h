/* Arguments that the verbs share, and attaching to the world they name. */
#ifndef JOLON_WORLDCTL_ARGUMENTS_H
#define JOLON_WORLDCTL_ARGUMENTS_H

#include "ipc/segment.h"
#include "ipc/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

#define ARGUMENT_SETS_MAX 256

struct arguments {
    const char *world; /* "default" */
    bool json, follow, fixed, force, progress, adopt;
    const char *terrain, *log, *path; /* NULL when not given; path is the one plain argument */
    uint64_t from_frame, hang_ms;
    double wall_s, seconds; /* seconds 0: as the scenario says */
    int parent, pid;
    const char *set[ARGUMENT_SETS_MAX];
    int sets;
};

/* Reads a verb's arguments; wrong ones end the process with what would be right (exit 2). */
struct arguments arguments_read(int argc, char **argv);

/* Attaches as a reader, or ends the process with the reason (exit 1). */
void arguments_attach(const struct arguments *arguments, struct view *view);

/* Attaches and takes a snapshot, or ends the process with the reason (exit 1). */
void arguments_snapshot(const struct arguments *arguments, struct view *view,
                        struct snapshot *snapshot);

#endif
