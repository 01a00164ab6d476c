/* Checks of heartbeats and of stopped processes. */
#include "supervisor/watchdog.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <dirent.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#define LATE_NS        (6 * WATCHDOG_TICK_NS)    /* the watchdog itself stood still */
#define STARTING_NS    (10 * (uint64_t)NS_PER_S) /* from start to the first frame */
#define OTHERS_NS      (2 * (uint64_t)NS_PER_S)  /* roles outside the frame loop */
#define STAGES_ALLOWED 8 /* a heartbeat may be as old as this many of the last frames' work */

static uint64_t later(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* The allowed age of a heartbeat: max(5 frames, the limit), and longer for a role that starts or
 * works on long frames. */
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

/* Reads the processor time of all threads of a process [ns], and whether a thread waits for a
 * processor, a page or a disk. Returns false if that is unknown. */
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

/* Returns true if the process wanted to run, but got too little processor time. */
static bool starved(const struct service *service, int pid, uint64_t silent_ns)
{
    uint64_t used;
    bool waits;
    return processor_time(pid, &used, &waits) && waits &&
           used < service->quiet_used_ns + silent_ns / 2;
}

static void kill_hung(const struct process_set *set, enum role role, struct child *child,
                      const char *how, uint64_t silent_ns)
{
    process_set_log(set, "%s (pid %d) %s for %.0f ms: killing it", role_name(role), child->pid, how,
                    (double)silent_ns / 1e6);
    child->hung = true;
    kill(child->pid, SIGKILL);
}

/* Kills children that have been stopped for too long, whether they hold the role, stand by for it
 * or start. */
static void check_stopped(const struct process_set *set, struct service *service,
                          const struct watchdog *watchdog, uint64_t now)
{
    uint64_t limit = set->plan->hang_ms * NS_PER_MS;
    for (int j = 0; j < PROCESS_SET_CHILDREN; j++) {
        struct child *child = &service->child[j];
        uint64_t from = later(child->stopped_ns, watchdog->since_ns);
        if (child->pid != 0 && child->stopped_ns != 0 && !child->hung && now > from + limit)
            kill_hung(set, service->role, child, "has been stopped", now - from);
    }
}

/* Updates the role's work counter. Returns true if it has changed within this time. */
static bool makes_progress(struct service *service, uint64_t work, uint64_t now, uint64_t within_ns)
{
    if (work != service->work) {
        service->work = work;
        service->work_ns = now;
    }
    return now <= service->work_ns + within_ns;
}

static void note_long_frame(const struct process_set *set, struct service *service,
                            const struct child *child, uint64_t from, uint64_t now)
{
    if (service->long_since_ns == from)
        return;
    service->long_since_ns = from;
    service->long_frames++;
    process_set_log(set,
                    "%s (pid %d) works on one frame for %.0f ms and gets on: leaving it alone "
                    "(long frame %" PRIu64 ")",
                    role_name(service->role), child->pid, (double)(now - from) / 1e6,
                    service->long_frames);
}

/* Handles a role whose heartbeat is older than allowed. */
static void check_silent(const struct process_set *set, struct service *service,
                         struct child *child, uint64_t from, uint64_t now, bool working)
{
    if (starved(service, child->pid, now - service->quiet_ns))
        return;
    if (working && now <= from + WATCHDOG_FRAME_MAX_NS)
        note_long_frame(set, service, child, from, now);
    else
        kill_hung(set, service->role, child, working ? "has worked on one frame" : "has not beaten",
                  now - from);
}

static void check_heartbeat(struct process_set *set, struct service *service,
                            const struct watchdog *watchdog, uint64_t now)
{
    const struct role_slot *slot = set->view.slot[service->role];
    struct child *child = process_set_holder(set, service->role);
    uint64_t beat = atomic_load(&slot->beat_ns);
    uint32_t state = atomic_load(&slot->state);
    if (child && state == ROLE_READY)
        child->was_ready = true;
    if (!child || child->hung || (state != ROLE_STARTING && state != ROLE_READY))
        return;
    uint64_t from = later(beat, watchdog->since_ns);
    uint64_t allowed = allowed_ns(set, service->role);
    bool working = makes_progress(service, atomic_load(&slot->work), now, allowed);
    if (now <= from + allowed / 2)
        return;
    /* Processor time is measured over the second half of the allowed silence only, so that a
     * healthy role costs no measurement. */
    if (service->quiet_ns < from) {
        bool waits;
        service->quiet_ns = now;
        if (!processor_time(child->pid, &service->quiet_used_ns, &waits))
            service->quiet_used_ns = 0;
        return;
    }
    if (now > from + allowed)
        check_silent(set, service, child, from, now, working);
}

void watchdog_check(struct watchdog *watchdog, struct process_set *set, uint64_t now_ns)
{
    if (now_ns > watchdog->last_ns + LATE_NS)
        watchdog->since_ns = now_ns;
    watchdog->last_ns = now_ns;
    for (int i = 0; i < ROLE_COUNT; i++) {
        check_stopped(set, &set->service[i], watchdog, now_ns);
        check_heartbeat(set, &set->service[i], watchdog, now_ns);
    }
}
