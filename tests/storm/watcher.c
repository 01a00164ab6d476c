/* Commits and recoveries. */
#include "tests/storm/watcher.h"

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
    if (fault->victim == STRUCK_SUPERVISOR)
        return RECOVERY_SUPERVISOR;
    if (fault->deed == DEED_STOP_CONTINUE)
        return RECOVERY_CONTINUED;
    if (fault->deed == DEED_STOP)
        return fault->victim == ROLE_MOVER ? RECOVERY_MOVER_STOPPED : RECOVERY_COLLIDER_STOPPED;
    return fault->victim == ROLE_MOVER ? RECOVERY_MOVER_KILLED : RECOVERY_COLLIDER_KILLED;
}

/* Did the struck stage take part in the commit of this frame? The collider in any after the last
 * before the strike; the mover in any after the last that was moved before it. Replaced means that
 * the slot shows another process: that of a stage killed so late that it had just handed over shows
 * the old one until the next is up. */
static bool recovered(const struct watcher *watcher, const struct fault *fault, uint64_t frame)
{
    bool mover = pid_of(watcher->view, ROLE_MOVER) != fault->mover;
    bool collider = pid_of(watcher->view, ROLE_COLLIDER) != fault->collider;
    if (fault->victim == STRUCK_SUPERVISOR)
        return mover && collider && frame > fault->moved;
    if (fault->victim == ROLE_MOVER)
        return frame > fault->moved && (mover || fault->deed == DEED_STOP_CONTINUE);
    return frame > fault->commit && (collider || fault->deed == DEED_STOP_CONTINUE);
}

static void look(struct watcher *watcher, uint64_t frame, uint64_t now)
{
    uint32_t left = 0;
    pthread_mutex_lock(&watcher->mutex);
    for (uint32_t i = 0; i < watcher->faults; i++) {
        const struct fault *fault = &watcher->fault[i];
        if (recovered(watcher, fault, frame))
            times_add(&watcher->recovered[recovery_of(fault)], now - fault->at_ns);
        else
            watcher->fault[left++] = *fault;
    }
    watcher->faults = left;
    pthread_mutex_unlock(&watcher->mutex);
}

static void *watch(void *argument)
{
    struct watcher *watcher = argument;
    uint64_t seen = watcher->first_frame;
    while (!atomic_load(&watcher->end)) {
        uint64_t frame = frame_protocol_wait(watcher->view, seen, clock_now_ns() + WAIT_NS);
        uint64_t now = clock_now_ns();
        if (frame < seen)
            watcher->back++;
        if (frame == seen)
            continue;
        seen = frame;
        watcher->wakes++;
        look(watcher, frame, now);
    }
    watcher->last_frame = seen;
    return NULL;
}

int watcher_start(struct watcher *watcher, const struct view *view)
{
    *watcher = (struct watcher){.view = view, .mutex = PTHREAD_MUTEX_INITIALIZER};
    watcher->first_frame = atomic_load(&view->commit->commit);
    return pthread_create(&watcher->thread, NULL, watch, watcher) == 0 ? 0 : -1;
}

void watcher_fault(struct watcher *watcher, uint32_t victim, int pid, enum deed deed)
{
    const struct view *view = watcher->view;
    pthread_mutex_lock(&watcher->mutex);
    for (uint32_t i = 0; i < watcher->faults; i++)
        watcher->fault[i].compound = true;
    CHECK(watcher->faults < FAULTS_MAX);
    watcher->fault[watcher->faults] = (struct fault){
        .victim = victim,
        .deed = deed,
        .mover = victim == ROLE_MOVER ? pid : pid_of(view, ROLE_MOVER),
        .collider = victim == ROLE_COLLIDER ? pid : pid_of(view, ROLE_COLLIDER),
        .at_ns = clock_now_ns(),
        .commit = atomic_load(&view->commit->commit),
        .moved = atomic_load(&view->moved_word->moved),
        .compound = watcher->faults > 0,
    };
    watcher->faults++;
    pthread_mutex_unlock(&watcher->mutex);
}

bool watcher_calm(struct watcher *watcher, uint64_t until_ns)
{
    for (;;) {
        pthread_mutex_lock(&watcher->mutex);
        bool calm = watcher->faults == 0;
        pthread_mutex_unlock(&watcher->mutex);
        if (calm || clock_now_ns() > until_ns)
            return calm;
        clock_sleep_until_ns(clock_now_ns() + NS_PER_MS);
    }
}

void watcher_stop(struct watcher *watcher)
{
    atomic_store(&watcher->end, true);
    pthread_join(watcher->thread, NULL);
}

void watcher_free(struct watcher *watcher)
{
    for (int i = 0; i < RECOVERY_COUNT; i++)
        free(watcher->recovered[i].ns);
}
