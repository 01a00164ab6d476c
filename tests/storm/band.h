/* The set under storm. The storm is the subreaper of all it starts, so that whatever loses its
 * parent becomes a child of the storm and cannot escape the account; and only a descendant that is
 * pinned by a pidfd is ever signalled. Main thread, but where it says otherwise. */
#ifndef JOLON_TESTS_STORM_BAND_H
#define JOLON_TESTS_STORM_BAND_H

#include "tests/storm/storm.h"

struct band {
    const struct storm_options *options;
    struct view view;        /* read-only; stays mapped when the world's file is gone */
    _Atomic int supervisor;  /* pid, 0: none just now */
    uint64_t starts;         /* of the set */
    uint64_t starts_refused; /* tried again */
    int descriptors;         /* of this supervisor, when it first had come to rest */
    int descriptors_over;    /* most above that, seen at rest */
};

/* Starts the set and attaches. 0, or -1 with the reason. */
int band_start(struct band *band, const struct storm_options *options, struct error_text *error);

/* The same set again over the world that a killed supervisor left. 0, or -1 with the reason. */
int band_adopt(struct band *band, struct error_text *error);

/* `jolon stop`; then the world is gone and band->view still shows its last frame. Exit code. */
int band_stop(struct band *band);

/* A pidfd of the process, if it lives and descends from the supervisor; else -1. */
int band_pin(const struct band *band, int pid);

/* A pidfd of the supervisor, if it lives and is ours; else -1. */
int band_pin_supervisor(const struct band *band);

/* Sends the signal to the pinned process: true when it was still there. */
bool band_signal(int pidfd, int signal_number);

/* Pids of the children of a process, at most max; how many. Any thread. */
int band_children(int pid, int *children, int max);

/* Waits (at most 20 s) until every role of the set is ready and beats; false when one is not. */
bool band_rest(const struct band *band);

/* Takes the number of the supervisor's descriptors; the set must be at rest. */
void band_count_descriptors(struct band *band);

/* Waits for what became ours because its parent died. */
void band_reap(void);

/* Processes that are still there after the set's end, and files of its world in /dev/shm and
 * in the runtime folder. */
int band_processes_left(void);
int band_files_left(const struct storm_options *options);

/* Runs a program of ours, its standard output into text (may be NULL). Its exit code; -1 when it
 * did not end by itself within the limit. */
int band_run(const char *const *arguments, char *text, size_t bytes, unsigned limit_s);

#endif
