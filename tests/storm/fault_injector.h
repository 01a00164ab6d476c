/* Draws from the seed which role is struck, how, and when. Which process holds the role at that
 * time depends on the machine's timing. Main thread. */
#ifndef JOLON_TESTS_STORM_FAULT_INJECTOR_H
#define JOLON_TESTS_STORM_FAULT_INJECTOR_H

#include "tests/storm/tested_set.h"
#include "tests/storm/recovery_monitor.h"

#define PENDING_MAX 32

struct fault_injector {
    struct tested_set *set;
    struct recovery_monitor *monitor;
    struct prng prng;
    uint64_t struck[STRUCK_ROLES + 1][FAULT_COUNT];
    enum fault_kind last;
    uint64_t done;         /* strikes that met a living process */
    uint64_t pairs;        /* rounds that struck two roles at once */
    uint64_t replacements; /* replacements struck while they started, or within their first
                              millisecond in the role */
    uint64_t before_role;  /* of these, struck before they held the role */
    uint64_t stand_bys;    /* stand-bys struck */
    struct {
        int pidfd; /* -1: entry is free */
        uint64_t due_ns;
    } pending[PENDING_MAX]; /* stopped processes to be continued */
    struct {
        uint64_t commit; /* at the role's last strike */
        uint32_t count;  /* strikes since the last commit */
    } without_progress[STRUCK_ROLES];
    int killed[STRUCK_ROLES]; /* pid killed last: a dying process cannot be told from a living one
                                 for a moment */
    struct error_text error;  /* why a round failed */
};

void fault_injector_begin(struct fault_injector *injector, struct tested_set *set,
                          struct recovery_monitor *monitor, uint64_t seed);

/* Makes one strike, or two that belong together. Returns -1 with an error when the set is broken:
 * no process could be struck for 20 s, or the set does not start again. */
int fault_injector_round(struct fault_injector *injector);

/* Waits until the time. Meanwhile continues stopped processes whose time has come. */
void fault_injector_wait(struct fault_injector *injector, uint64_t until_ns);

/* Waits for the drawn gap before the next round. */
void fault_injector_gap(struct fault_injector *injector);

/* Continues all processes that are still stopped. */
void fault_injector_end(struct fault_injector *injector);

#endif
