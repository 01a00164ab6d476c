/* Arguments that the verbs of jolon-world share, and attaching to the world that they name. */
#ifndef JOLON_RECORDER_REPLAY_ARGUMENTS_H
#define JOLON_RECORDER_REPLAY_ARGUMENTS_H

#include "ipc/segment/segment.h"
#include "ipc/frame/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

#define ARGUMENT_SETS_MAX 256

struct arguments {
    const char *world; /* "default" when not given */
    bool json, follow, fixed, force, adopt, inputs, physics;
    const char *terrain, *events, *path; /* NULL when not given; path is the first plain argument */
    const char *other;                   /* the second plain argument */
    const char *from;       /* a frame or an image's file, by verb; NULL when not given */
    uint64_t frames;        /* 0: not given */
    uint32_t threads;       /* 1 */
    double wall_s, seconds; /* seconds 0: not given */
    const char *set[ARGUMENT_SETS_MAX];
    int sets;
};

/* Returns the index in argv of the verb: the first word that is neither an option nor an option's
 * value; argc if there is none. */
int arguments_verb(int argc, char **argv);

/* Reads a verb's arguments: the options that its usage names, and at most plain_max others. --help
 * prints the usage and ends the process (exit 0). A wrong argument ends it with what would be right
 * (exit 2). argv[0] is ignored. */
struct arguments arguments_read(int argc, char **argv, const char *verb, const char *usage,
                                int plain_max);

/* Adds one --set; wrong usage ends the process (exit 2). */
void arguments_set(struct arguments *arguments, const char *text);

/* Sets the run's end to --seconds after its frame 0, if the option is given. */
void arguments_seconds(const struct arguments *arguments, struct params *params);

/* Attaches as a reader, or ends the process with the reason (exit 1). */
void arguments_attach(const struct arguments *arguments, struct view *view);

/* Attaches and takes a snapshot, or ends the process with the reason (exit 1). */
void arguments_snapshot(const struct arguments *arguments, struct view *view,
                        struct snapshot *snapshot);

#endif
