/* Measures recoveries: the time from a strike to the first commit in which the struck stage took
 * part after it. Its own thread waits on the futex of the commit word. */
#ifndef JOLON_TESTS_STORM_RECOVERY_MONITOR_H
#define JOLON_TESTS_STORM_RECOVERY_MONITOR_H

#include "tests/storm/storm.h"

#include <pthread.h>

/* What was recovered from. A strike that falls into another's recovery lengthens both. Both are
 * counted as compound, so that the other classes tell what one strike costs. */
enum recovery {
    RECOVERY_MOVER_KILLED,
    RECOVERY_COLLIDER_KILLED,
    RECOVERY_MOVER_STOPPED,
    RECOVERY_COLLIDER_STOPPED,
    RECOVERY_CONTINUED, /* a stopped stage was continued or replaced */
    RECOVERY_SUPERVISOR,
    RECOVERY_COMPOUND,
    RECOVERY_COUNT
};

const char *recovery_name(enum recovery recovery);

struct times {
    uint64_t *ns;
    size_t count, room;
};

/* Returns the value below which the fraction of the times lies, 0 when there are none. Sorts the
 * times. */
uint64_t times_quantile(struct times *times, double fraction);

struct fault {
    uint32_t target; /* role or STRUCK_SUPERVISOR */
    enum fault_kind kind;
    int mover, collider; /* pids at the strike, the target's among them */
    uint64_t at_ns, commit, moved;
    bool compound;
};

#define FAULTS_MAX 256

struct recovery_monitor {
    const struct view *view;
    pthread_t thread;
    pthread_mutex_t mutex;
    struct fault fault[FAULTS_MAX]; /* without a recovery so far; under mutex */
    uint32_t faults;                /* under mutex */
    _Atomic bool end;
    uint64_t first_frame, last_frame, wakes;
    uint64_t backward; /* commits with a lower number than the one before */
    struct times recovered[RECOVERY_COUNT];
};

int recovery_monitor_start(struct recovery_monitor *monitor, const struct view *view);

/* Notes a strike of mover, collider or supervisor. Called just before the signal is sent. pid: the
 * target's. */
void recovery_monitor_fault(struct recovery_monitor *monitor, uint32_t target, int pid,
                            enum fault_kind kind);

/* Waits until the set has recovered from every fault, at most until until_ns. Returns false at that
 * time. */
bool recovery_monitor_wait(struct recovery_monitor *monitor, uint64_t until_ns);

/* Ends the thread. Faults without a recovery stay in monitor->fault. */
void recovery_monitor_stop(struct recovery_monitor *monitor);
void recovery_monitor_free(struct recovery_monitor *monitor);

#endif
