/* One run of a small world by real processes, of which one may be told to die at a crash point. A
 * small parent waits for deaths and starts anew whoever died, as a supervisor does. */
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

/* Who dies where; its first process only. */
struct death {
    const char *role, *point;
    uint64_t crossing;
};

/* What is run. */
struct plan {
    struct scenario scenario;
    struct world_build built;
    bool commands;      /* a commander steers it */
    bool late_recorder; /* the recorder comes when all is over */
    /* A mover and a collider stand by and take over from the first that dies. NULL: none. Else the
     * first dies here, and death and count are of those that stand by. */
    const struct death *first_death;
};

/* What a run comes to. */
struct ending {
    char refused[256]; /* "" when the run went to its end and left nothing wrong */
    bool died;         /* somebody died as told */
    uint64_t frame, digest, event_digest;
    size_t log_bytes;
    char log[TRIAL_LOG_MAX]; /* the event log, then the commands and the end of theirs */
};

/* The folder for what the test writes, made anew; removed by trial_close. */
void trial_open(void);
void trial_close(void);

/* path = folder/name. */
void trial_path(char *path, size_t bytes, const char *name);

/* Reads the scenario's text (see tests/support/fixture.h). Tables are made small, because a world
 * is made for every run; the ring has event_slots. */
void plan_make(struct plan *plan, const char *text, uint32_t event_slots);
void plan_free(struct plan *plan);

/* Publishes a world of the plan under a new name. */
void plan_publish(const struct plan *plan, char name[SEGMENT_NAME_MAX]);

/* Starts a program of the crash build as a role's process: argv[0] is a name in its bin/, or the
 * test's own path. death may be NULL; count: append to this file of the folder, NULL for none. */
pid_t trial_start(const char *const argv[], const struct death *death, const char *count);

/* Runs a plan's world to its end. death and count as above. */
void trial_play(struct ending *ending, const struct plan *plan, const char *world,
                const struct death *death, const char *count);

/* The same, and removes it. */
void trial_run(struct ending *ending, const struct plan *plan, const char *world,
               const struct death *death, const char *count);

/* NULL when both runs came to the same, else what differs. */
const char *ending_differs(const struct ending *ending, const struct ending *calm);

#endif
