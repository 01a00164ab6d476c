/* Runs a small world with real processes, of which one may be told to die at a crash point. A small
 * parent starts dead processes again, as a supervisor does. */
#ifndef JOLON_TESTS_CRASH_TRIAL_H
#define JOLON_TESTS_CRASH_TRIAL_H

#include "ipc/segment/segment.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#define TRIAL_LOG_MAX 65536

/* The role whose first process dies, the point, and at which crossing of it. */
struct death {
    const char *role, *point;
    uint64_t crossing;
};

/* A run: its world and its processes. */
struct plan {
    struct scenario scenario;
    struct world_build built;
    bool commands;      /* a command writer controls the world */
    bool late_recorder; /* the recorder starts after the end of the run */
    /* NULL: no stand-bys. Otherwise a mover and a collider stand by, the first process dies here,
     * and death and count apply to the stand-by that takes over. */
    const struct death *first_death;
};

/* The result of a run. */
struct run_outcome {
    char refused[256]; /* "" when the run reached its end without a fault */
    bool died;         /* a process died as planned */
    uint64_t frame, digest, event_digest;
    size_t log_bytes;
    char log[TRIAL_LOG_MAX]; /* the event log, then the commands and the end of their log */
};

/* Make and remove the folder for the files of the test. */
void trial_open(void);
void trial_close(void);

/* Writes folder/name to path. */
void trial_path(char *path, size_t bytes, const char *name);

/* Reads a scenario from text (see tests/support/fixture.h). The tables are small, because each run
 * makes a world. The ring has event_slots slots. */
void plan_make(struct plan *plan, const char *text, uint32_t event_slots);
void plan_free(struct plan *plan);

/* Publishes a world of the plan under a new name. */
void plan_publish(const struct plan *plan, char name[SEGMENT_NAME_MAX]);

/* Starts a program of the crash build as a role's process. argv[0] is a name in its bin/, or the
 * test's own path. death may be NULL. The process appends its counts to the file count of the
 * folder, unless count is NULL. */
pid_t trial_start(const char *const argv[], const struct death *death, const char *count);

/* Runs a plan's world to its end. death and count: as above. */
void trial_run_to_end(struct run_outcome *outcome, const struct plan *plan, const char *world,
                      const struct death *death, const char *count);

/* Runs the world to its end and removes it. */
void trial_run(struct run_outcome *outcome, const struct plan *plan, const char *world,
               const struct death *death, const char *count);

/* Returns what differs between two runs, or NULL. */
const char *run_outcome_differs(const struct run_outcome *outcome,
                                const struct run_outcome *reference);

#endif
