/* Takes snapshots and looks for zombies. */
#include "tests/storm/invariant_monitor.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>

#define PAUSE_NS         (2 * (uint64_t)NS_PER_MS) /* longest between two snapshots */
#define ZOMBIE_PERIOD_NS (50 * (uint64_t)NS_PER_MS)
#define ZOMBIE_NS        ((uint64_t)NS_PER_S)
#define ZOMBIE_LOOKS     10 /* at a zombie while the supervisor slept */

static void *take_snapshots(void *argument)
{
    struct invariant_monitor *invariants = argument;
    struct prng prng = {invariants->seed};
    uint64_t last = 0;
    while (!atomic_load(&invariants->end)) {
        if (snapshot_take(&invariants->snapshot, &invariants->set->view) == 0) {
            uint64_t frame = invariants->snapshot.head.frame;
            invariants->snapshots++;
            invariants->backward += frame < last;
            last = frame;
        } else if (errno == EBADMSG) {
            invariants->torn++;
        } else {
            invariants->missed++;
        }
        clock_sleep_until_ns(clock_now_ns() + prng_below(&prng, PAUSE_NS));
    }
    return NULL;
}

static bool is_among(int pid, const int *pids, int count)
{
    for (int i = 0; i < count; i++) {
        if (pids[i] == pid)
            return true;
    }
    return false;
}

/* Returns the entry of the pid, a new entry if there is none, or NULL when there is no room. */
static struct zombie *entry_of(struct invariant_monitor *invariants, int pid, uint64_t now)
{
    struct zombie *empty = NULL;
    for (int i = 0; i < ZOMBIES_MAX; i++) {
        if (invariants->zombie[i].pid == pid)
            return &invariants->zombie[i];
        if (invariants->zombie[i].pid == 0)
            empty = &invariants->zombie[i];
    }
    if (empty)
        *empty = (struct zombie){.pid = pid, .since_ns = now};
    return empty;
}

/* Returns true if all threads of the process are dead. While one still dies, its parent cannot reap
 * it. */
static bool is_zombie(int pid)
{
    char path[64];
    int threads = 0;
    if (process_state(pid) != 'Z')
        return false;
    snprintf(path, sizeof path, "/proc/%d/task", pid);
    DIR *directory = opendir(path);
    if (!directory)
        return false;
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        threads += entry->d_name[0] != '.';
    closedir(directory);
    return threads == 1;
}

static void check_zombies(struct invariant_monitor *invariants)
{
    int children[ZOMBIES_MAX];
    uint64_t now = clock_now_ns();
    int supervisor = invariants->set->supervisor;
    int count = tested_set_children(supervisor, children, ZOMBIES_MAX);
    /* A supervisor that is ready to run may get no processor time. Its zombies are no fault then.
     */
    bool idle = process_state(supervisor) == 'S';
    for (int i = 0; i < ZOMBIES_MAX; i++) {
        if (!is_among(invariants->zombie[i].pid, children, count))
            invariants->zombie[i].pid = 0;
    }
    for (int i = 0; i < count; i++) {
        if (!idle || !is_zombie(children[i]))
            continue;
        struct zombie *zombie = entry_of(invariants, children[i], now);
        if (!zombie || zombie->counted)
            continue;
        zombie->looks++;
        zombie->counted = zombie->looks >= ZOMBIE_LOOKS && now - zombie->since_ns > ZOMBIE_NS;
        invariants->zombies += zombie->counted;
    }
}

static void *watch_zombies(void *argument)
{
    struct invariant_monitor *invariants = argument;
    while (!atomic_load(&invariants->end)) {
        check_zombies(invariants);
        clock_sleep_until_ns(clock_now_ns() + ZOMBIE_PERIOD_NS);
    }
    return NULL;
}

int invariant_monitor_start(struct invariant_monitor *invariants, const struct tested_set *set,
                            uint64_t seed)
{
    *invariants = (struct invariant_monitor){.set = set, .seed = seed};
    if (snapshot_init(&invariants->snapshot, &set->view) != 0)
        return -1;
    int error = pthread_create(&invariants->snapshot_thread, NULL, take_snapshots, invariants);
    if (error == 0)
        error = pthread_create(&invariants->zombie_thread, NULL, watch_zombies, invariants);
    errno = error;
    return error == 0 ? 0 : -1;
}

void invariant_monitor_stop(struct invariant_monitor *invariants)
{
    atomic_store(&invariants->end, true);
    pthread_join(invariants->snapshot_thread, NULL);
    pthread_join(invariants->zombie_thread, NULL);
    snapshot_free(&invariants->snapshot);
}
