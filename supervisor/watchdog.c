/* Hearts, and processes that a signal keeps stopped. */
#include "supervisor/watchdog.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <dirent.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#define LATE_NS        (6 * WATCHDOG_TICK_NS)    /* the watcher itself stood still */
#define STARTING_NS    (10 * (uint64_t)NS_PER_S) /* from start to the first frame */
#define OTHERS_NS      (2 * (uint64_t)NS_PER_S)  /* roles outside the frame loop */
#define STAGES_ALLOWED 8 /* a beat may be this many of its last frame's work old */

static uint64_t later(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* max(5 frames, the limit), and longer for who just starts or works on long frames. */
static uint64_t allowed_ns(const struct process_set *set, enum role role)
{
    const struct role_slot *slot = set->view.slot[role];
    uint64_t frames_ns = (uint64_t)(5e9 * world_dt_s(&set->view.world));
    uint64_t allowed = later(set->plan->hang_ms * NS_PER_MS, frames_ns);
    if (atomic_load(&slot->state) == ROLE_STARTING || atomic_load(&slot->frame) == 0)
        return STARTING_NS;
    if (!role_has(role, ROLE_MAKES_FRAMES))
        allowed = later(allowed, OTHERS_NS);
    return later(allowed, STAGES_ALLOWED * atomic_load(&slot->stage_ns));
}

/* What the machine gave a process: processor time of all its threads [ns], and whether one of them
 * waits for more of it, or for a page or a disk. false when it cannot be told. */
static bool processor_time(int pid, uint64_t *used_ns, bool *waits)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/task", pid);
    DIR *tasks = opendir(path);
    if (!tasks)
        return false;
    *used_ns = 0;
    *waits = false;
    for (const struct dirent *task = readdir(tasks); task; task = readdir(tasks)) {
        char line[128], name[64];
        int thread = atoi(task->d_name);
        if (thread <= 0)
            continue;
        snprintf(name, sizeof name, "/proc/%d/task/%d/schedstat", pid, thread);
        FILE *file = fopen(name, "re");
        if (file && fgets(line, sizeof line, file))
            *used_ns += strtoull(line, NULL, 10);
        if (file)
            fclose(file);
        char state = process_state(thread);
        *waits |= state == 'R' || state == 'D';
    }
    closedir(tasks);
    return true;
}

/* Starved by the machine, and no replacement would do better. */
static bool starved(const struct post *post, int pid, uint64_t silent_ns)
{
    uint64_t used;
    bool waits;
    return processor_time(pid, &used, &waits) && waits &&
           used < post->quiet_used_ns + silent_ns / 2;
}

static void kill_hung(const struct process_set *set, enum role role, struct child *child,
                      const char *how, uint64_t silent_ns)
{
    process_set_note(set, "%s (pid %d) %s for %.0f ms: killing it", role_name(role), child->pid,
                     how, (double)silent_ns / 1e6);
    child->hung = true;
    kill(child->pid, SIGKILL);
}

/* A stopped process does nothing at all, whether it has the role, stands by for it or starts. */
static void check_stopped(const struct process_set *set, struct post *post,
                          const struct watchdog *watchdog, uint64_t now)
{
    uint64_t limit = set->plan->hang_ms * NS_PER_MS;
    for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
        struct child *child = &post->child[j];
        uint64_t from = later(child->stopped_ns, watchdog->since_ns);
        if (child->pid != 0 && child->stopped_ns != 0 && !child->hung && now > from + limit)
            kill_hung(set, post->role, child, "has been stopped", now - from);
    }
}

/* Notes how far the role is; true when it has got on within this time. */
static bool makes_progress(struct post *post, uint64_t work, uint64_t now, uint64_t within_ns)
{
    if (work != post->work) {
        post->work = work;
        post->work_ns = now;
    }
    return now <= post->work_ns + within_ns;
}

static void note_long_frame(const struct process_set *set, struct post *post,
                            const struct child *child, uint64_t from, uint64_t now)
{
    if (post->long_since_ns == from)
        return;
    post->long_since_ns = from;
    post->long_frames++;
    process_set_note(set,
                     "%s (pid %d) works on one frame for %.0f ms and gets on: leaving it alone "
                     "(long frame %" PRIu64 ")",
                     role_name(post->role), child->pid, (double)(now - from) / 1e6,
                     post->long_frames);
}

/* It has been silent for longer than it may. */
static void check_silent(const struct process_set *set, struct post *post, struct child *child,
                         uint64_t from, uint64_t now, bool working)
{
    if (starved(post, child->pid, now - post->quiet_ns))
        return;
    if (working && now <= from + WATCHDOG_FRAME_MAX_NS)
        note_long_frame(set, post, child, from, now);
    else
        kill_hung(set, post->role, child, working ? "has worked on one frame" : "has not beaten",
                  now - from);
}

static void check_heartbeat(struct process_set *set, struct post *post,
                            const struct watchdog *watchdog, uint64_t now)
{
    const struct role_slot *slot = set->view.slot[post->role];
    struct child *child = process_set_holder(set, post->role);
    uint64_t beat = atomic_load(&slot->beat_ns);
    uint32_t state = atomic_load(&slot->state);
    if (child && state == ROLE_READY)
        child->was_ready = true;
    if (!child || child->hung || (state != ROLE_STARTING && state != ROLE_READY))
        return;
    uint64_t from = later(beat, watchdog->since_ns);
    uint64_t allowed = allowed_ns(set, post->role);
    bool working = makes_progress(post, atomic_load(&slot->work), now, allowed);
    if (now <= from + allowed / 2)
        return;
    /* What the machine gives it is measured over the second half: who beats costs no look at it. */
    if (post->quiet_ns < from) {
        bool waits;
        post->quiet_ns = now;
        if (!processor_time(child->pid, &post->quiet_used_ns, &waits))
            post->quiet_used_ns = 0;
        return;
    }
    if (now > from + allowed)
        check_silent(set, post, child, from, now, working);
}

void watchdog_turn(struct watchdog *watchdog, struct process_set *set, uint64_t now_ns)
{
    if (now_ns > watchdog->last_ns + LATE_NS)
        watchdog->since_ns = now_ns;
    watchdog->last_ns = now_ns;
    for (int i = 0; i < ROLE_COUNT; i++) {
        check_stopped(set, &set->post[i], watchdog, now_ns);
        check_heartbeat(set, &set->post[i], watchdog, now_ns);
    }
}
