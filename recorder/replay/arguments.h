/* Arguments that the verbs share, and attaching to the world they name. */
#ifndef JOLON_RECORDER_REPLAY_ARGUMENTS_H
#define JOLON_RECORDER_REPLAY_ARGUMENTS_H

#include "ipc/segment/segment.h"
#include "ipc/frame/snapshot.h"

#include <stdbool.h>
#include <stdint.h>

#define ARGUMENT_SETS_MAX 256

struct arguments {
    const char *world; /* "default" */
    bool json, follow, fixed, force, adopt, inputs;
    const char *terrain, *events, *path; /* NULL when not given; path is the one plain argument */
    const char *other;                   /* the second one, of verbs that take two */
    const char *from; /* a frame or an image's file, as the verb means it; NULL when not given */
    uint64_t frames;  /* 0: not given */
    uint32_t threads; /* 1 */
    double wall_s, seconds; /* seconds 0: as the scenario says */
    const char *set[ARGUMENT_SETS_MAX];
    int sets;
};

/* The place of the verb in the command line: the first word that is no option nor an option's
 * value; argc when there is none. */
int arguments_verb(int argc, char **argv);

/* Reads a verb's arguments: the options that its usage names, and at most plain_max others. Ends
 * the process with the usage on standard output for --help (exit 0), and with what would be right
 * for anything else (exit 2). argv[0] is not looked at. */
struct arguments arguments_read(int argc, char **argv, const char *verb, const char *usage,
                                int plain_max);

/* Adds one --set; wrong usage ends the process (exit 2). */
void arguments_set(struct arguments *arguments, const char *text);

/* Sets the run's end by --seconds, if given: of the run since its frame 0. */
void arguments_seconds(const struct arguments *arguments, struct params *params);

/* Attaches as a reader, or ends the process with the reason (exit 1). */
void arguments_attach(const struct arguments *arguments, struct view *view);

/* Attaches and takes a snapshot, or ends the process with the reason (exit 1). */
void arguments_snapshot(const struct arguments *arguments, struct view *view,
                        struct snapshot *snapshot);

#endif
