/* Watches the commits and measures recoveries: from a strike to the first commit that the struck
 * stage took part in after it. A thread of its own; frames come to it by the commit word's futex.
 */
#ifndef JOLON_TESTS_STORM_WATCHER_H
#define JOLON_TESTS_STORM_WATCHER_H

#include "tests/storm/storm.h"

#include <pthread.h>

/* What a recovery was of. Those of one strike alone say what one costs; a strike that fell into
 * another's recovery lengthens both, and both are counted as compound. */
enum recovery {
    RECOVERY_MOVER_KILLED,
    RECOVERY_COLLIDER_KILLED,
    RECOVERY_MOVER_STOPPED,
    RECOVERY_COLLIDER_STOPPED,
    RECOVERY_CONTINUED, /* a stopped stage that went on by itself, or was replaced */
    RECOVERY_SUPERVISOR,
    RECOVERY_COMPOUND,
    RECOVERY_COUNT
};

const char *recovery_name(enum recovery recovery);

struct times {
    uint64_t *ns;
    size_t count, room;
};

/* The value below which the fraction lies; sorts. 0 when there are none. */
uint64_t times_quantile(struct times *times, double fraction);

struct fault {
    uint32_t victim; /* role, or STRUCK_SUPERVISOR */
    enum deed deed;
    int mover, collider; /* pids then, the victim's among them */
    uint64_t at_ns, commit, moved;
    bool compound;
};

#define FAULTS_MAX 256

struct watcher {
    const struct view *view;
    pthread_t thread;
    pthread_mutex_t mutex;
    struct fault fault[FAULTS_MAX]; /* not yet recovered from; under mutex */
    uint32_t faults;                /* under mutex */
    _Atomic bool end;
    uint64_t first_frame, last_frame, wakes;
    uint64_t back; /* commits that were lower than one before */
    struct times recovered[RECOVERY_COUNT];
};

int watcher_start(struct watcher *watcher, const struct view *view);

/* A strike of mover, collider or supervisor, which is pid, is about to be made: called just before.
 */
void watcher_fault(struct watcher *watcher, uint32_t victim, int pid, enum deed deed);

/* Waits until every fault is recovered from, at most until until_ns; false when one is not. */
bool watcher_calm(struct watcher *watcher, uint64_t until_ns);

/* Ends the thread; faults that are still open stay in watcher->fault. */
void watcher_stop(struct watcher *watcher);
void watcher_free(struct watcher *watcher);

#endif
