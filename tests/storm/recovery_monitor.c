/* Observes commits and measures recoveries. */
#include "tests/storm/recovery_monitor.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "world/runtime/check.h"

#include <stdlib.h>

#define WAIT_NS (20 * (uint64_t)NS_PER_MS)

const char *recovery_name(enum recovery recovery)
{
    static const char *const names[RECOVERY_COUNT] = {
        "mover killed",       "collider killed",   "mover stopped",  "collider stopped",
        "stopped, continued", "supervisor killed", "several at once"};
    return names[recovery];
}

static void times_add(struct times *times, uint64_t ns)
{
    if (times->count == times->room) {
        times->room = times->room ? times->room * 2 : 256;
        times->ns = realloc(times->ns, times->room * sizeof *times->ns);
        if (!times->ns)
            die_refused("out of memory for recovery times");
    }
    times->ns[times->count++] = ns;
}

static int ascending(const void *p, const void *q)
{
    const uint64_t *a = p, *b = q;
    return (*a > *b) - (*a < *b);
}

uint64_t times_quantile(struct times *times, double fraction)
{
    if (times->count == 0)
        return 0;
    qsort(times->ns, times->count, sizeof *times->ns, ascending);
    return times->ns[(size_t)(fraction * (double)(times->count - 1) + 0.5)];
}

static int pid_of(const struct view *view, enum role role)
{
    return (int)atomic_load(&view->slot[role]->pid);
}

static enum recovery recovery_of(const struct fault *fault)
{
    if (fault->compound)
        return RECOVERY_COMPOUND;
    if (fault->target == STRUCK_SUPERVISOR)
        return RECOVERY_SUPERVISOR;
    if (fault->kind == FAULT_STOP_CONTINUE)
        return RECOVERY_CONTINUED;
    if (fault->kind == FAULT_STOP)
        return fault->target == ROLE_MOVER ? RECOVERY_MOVER_STOPPED : RECOVERY_COLLIDER_STOPPED;
    return fault->target == ROLE_MOVER ? RECOVERY_MOVER_KILLED : RECOVERY_COLLIDER_KILLED;
}

/* Returns true if the struck stage took part in the commit of this frame. The collider took part in
 * every frame after the last commit before the strike, the mover in every frame after the last that
 * was moved before it. The slot must also show another process, because a stage killed just after
 * handing over leaves a frame that the other stage can still commit. */
static bool recovered(const struct recovery_monitor *monitor, const struct fault *fault,
                      uint64_t frame)
{
    bool mover = pid_of(monitor->view, ROLE_MOVER) != fault->mover;
    bool collider = pid_of(monitor->view, ROLE_COLLIDER) != fault->collider;
    if (fault->target == STRUCK_SUPERVISOR)
        return mover && collider && frame > fault->moved;
    if (fault->target == ROLE_MOVER)
        return frame > fault->moved && (mover || fault->kind == FAULT_STOP_CONTINUE);
    return frame > fault->commit && (collider || fault->kind == FAULT_STOP_CONTINUE);
}

static void update_recoveries(struct recovery_monitor *monitor, uint64_t frame, uint64_t now)
{
    uint32_t left = 0;
    pthread_mutex_lock(&monitor->mutex);
    for (uint32_t i = 0; i < monitor->faults; i++) {
        const struct fault *fault = &monitor->fault[i];
        if (recovered(monitor, fault, frame))
            times_add(&monitor->recovered[recovery_of(fault)], now - fault->at_ns);
        else
            monitor->fault[left++] = *fault;
    }
    monitor->faults = left;
    pthread_mutex_unlock(&monitor->mutex);
}

static void *observe_commits(void *argument)
{
    struct recovery_monitor *monitor = argument;
    uint64_t seen = monitor->first_frame;
    while (!atomic_load(&monitor->end)) {
        uint64_t frame = frame_protocol_wait(monitor->view, seen, clock_now_ns() + WAIT_NS);
        uint64_t now = clock_now_ns();
        if (frame < seen)
            monitor->backward++;
        if (frame == seen)
            continue;
        seen = frame;
        monitor->wakes++;
        update_recoveries(monitor, frame, now);
    }
    monitor->last_frame = seen;
    return NULL;
}

int recovery_monitor_start(struct recovery_monitor *monitor, const struct view *view)
{
    *monitor = (struct recovery_monitor){.view = view, .mutex = PTHREAD_MUTEX_INITIALIZER};
    monitor->first_frame = atomic_load(&view->commit->commit);
    return pthread_create(&monitor->thread, NULL, observe_commits, monitor) == 0 ? 0 : -1;
}

void recovery_monitor_fault(struct recovery_monitor *monitor, uint32_t target, int pid,
                            enum fault_kind kind)
{
    const struct view *view = monitor->view;
    pthread_mutex_lock(&monitor->mutex);
    for (uint32_t i = 0; i < monitor->faults; i++)
        monitor->fault[i].compound = true;
    CHECK(monitor->faults < FAULTS_MAX);
    monitor->fault[monitor->faults] = (struct fault){
        .target = target,
        .kind = kind,
        .mover = target == ROLE_MOVER ? pid : pid_of(view, ROLE_MOVER),
        .collider = target == ROLE_COLLIDER ? pid : pid_of(view, ROLE_COLLIDER),
        .at_ns = clock_now_ns(),
        .commit = atomic_load(&view->commit->commit),
        .moved = atomic_load(&view->moved_word->moved),
        .compound = monitor->faults > 0,
    };
    monitor->faults++;
    pthread_mutex_unlock(&monitor->mutex);
}

bool recovery_monitor_wait(struct recovery_monitor *monitor, uint64_t until_ns)
{
    for (;;) {
        pthread_mutex_lock(&monitor->mutex);
        bool recovered_all = monitor->faults == 0;
        pthread_mutex_unlock(&monitor->mutex);
        if (recovered_all || clock_now_ns() > until_ns)
            return recovered_all;
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
}

void recovery_monitor_stop(struct recovery_monitor *monitor)
{
    atomic_store(&monitor->end, true);
    pthread_join(monitor->thread, NULL);
}

void recovery_monitor_free(struct recovery_monitor *monitor)
{
    for (int i = 0; i < RECOVERY_COUNT; i++)
        free(monitor->recovered[i].ns);
}
