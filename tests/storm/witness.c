/* The reader of snapshots and the housekeeper. */
#include "tests/storm/witness.h"

#include "ipc/process/clock.h"
#include "ipc/process/process.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>

#define PAUSE_NS     (2 * (uint64_t)NS_PER_MS) /* longest between two snapshots */
#define HOUSE_NS     (50 * (uint64_t)NS_PER_MS)
#define ZOMBIE_NS    ((uint64_t)NS_PER_S)
#define ZOMBIE_LOOKS 10 /* at a supervisor that slept beside it */

static void *read_all_the_time(void *argument)
{
    struct witness *witness = argument;
    struct chance chance = {witness->seed};
    uint64_t last = 0;
    while (!atomic_load(&witness->end)) {
        if (snapshot_take(&witness->snapshot, &witness->band->view) == 0) {
            uint64_t frame = witness->snapshot.head.frame;
            witness->snapshots++;
            witness->back += frame < last;
            last = frame;
        } else if (errno == EBADMSG) {
            witness->torn++;
        } else {
            witness->missed++;
        }
        clock_sleep_until_ns(clock_now_ns() + chance_below(&chance, PAUSE_NS));
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

/* Its entry, a new one if there is none yet; NULL when there is no room. */
static struct zombie *entry_of(struct witness *witness, int pid, uint64_t now)
{
    struct zombie *empty = NULL;
    for (int i = 0; i < ZOMBIES_MAX; i++) {
        if (witness->zombie[i].pid == pid)
            return &witness->zombie[i];
        if (witness->zombie[i].pid == 0)
            empty = &witness->zombie[i];
    }
    if (empty)
        *empty = (struct zombie){.pid = pid, .since_ns = now};
    return empty;
}

/* Dead as a whole: while threads of it still die, nobody can wait for it. */
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

static void look_for_zombies(struct witness *witness)
{
    int children[ZOMBIES_MAX];
    uint64_t now = clock_now_ns();
    int supervisor = witness->band->supervisor;
    int count = band_children(supervisor, children, ZOMBIES_MAX);
    /* One that wants to run, or whose new child does, is not let by the machine. */
    bool idle = process_state(supervisor) == 'S';
    for (int i = 0; i < ZOMBIES_MAX; i++) {
        if (!is_among(witness->zombie[i].pid, children, count))
            witness->zombie[i].pid = 0;
    }
    for (int i = 0; i < count; i++) {
        if (!idle || !is_zombie(children[i]))
            continue;
        struct zombie *zombie = entry_of(witness, children[i], now);
        if (!zombie || zombie->counted)
            continue;
        zombie->looks++;
        zombie->counted = zombie->looks >= ZOMBIE_LOOKS && now - zombie->since_ns > ZOMBIE_NS;
        witness->zombies += zombie->counted;
    }
}

static void *keep_house(void *argument)
{
    struct witness *witness = argument;
    while (!atomic_load(&witness->end)) {
        look_for_zombies(witness);
        clock_sleep_until_ns(clock_now_ns() + HOUSE_NS);
    }
    return NULL;
}

int witness_start(struct witness *witness, const struct band *band, uint64_t seed)
{
    *witness = (struct witness){.band = band, .seed = seed};
    if (snapshot_init(&witness->snapshot, &band->view) != 0)
        return -1;
    int error = pthread_create(&witness->reader, NULL, read_all_the_time, witness);
    if (error == 0)
        error = pthread_create(&witness->housekeeper, NULL, keep_house, witness);
    errno = error;
    return error == 0 ? 0 : -1;
}

void witness_stop(struct witness *witness)
{
    atomic_store(&witness->end, true);
    pthread_join(witness->reader, NULL);
    pthread_join(witness->housekeeper, NULL);
    snapshot_free(&witness->snapshot);
}
