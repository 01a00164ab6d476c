/* The segment: a world in POSIX shared memory, its creation and its mapping.
 *
 * The object is "/dev/shm/jolon.UID.NAME.X", mode 0600, where X is 32 random hexadecimal digits: so
 * nobody can take its name before it. The world's name is a symbolic link NAME to it in the runtime
 * folder (ipc/segment/runtime_folder.h), which nobody else can enter. Beside the link lies
 * NAME.lock, which holds the roles' locks and is never removed while the world lives. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_H
#define JOLON_IPC_SEGMENT_SEGMENT_H

#include "ipc/segment/doorbell.h"
#include "ipc/segment/layout.h"
#include "ipc/segment/role.h"
#include "ipc/segment/runtime_folder.h"
#include "world/entity/command.h"
#include "world/state.h"
#include "world/world.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct error_text;
struct event;
struct params;
struct world_build;

#define SEGMENT_NAME_MAX 32 /* of a world, with the NUL */
#define SEGMENT_PATH_MAX (RUNTIME_FOLDER_MAX + 64)

struct commit_words {                      /* only writer: collider */
    _Alignas(64) _Atomic uint64_t commit;  /* last committed frame */
    _Alignas(64) _Atomic uint64_t writing; /* frame being written into W[writing & 1] */
};

struct moved_word {                      /* only writer: mover */
    _Alignas(64) _Atomic uint64_t moved; /* frame that M holds */
    /* Written by segment_repair() alone, while nobody runs: frame again (0: none) is made a second
     * time and takes the commands of each ring up to again_end, as it did the first time. */
    _Alignas(64) uint64_t again;
    uint64_t again_end[COMMAND_RING_COUNT];
};

struct command_ring_words {             /* only writer: the ring's process */
    _Alignas(64) _Atomic uint64_t head; /* commands ever written */
    _Alignas(64) struct command slot[]; /* [command_slots] */
};

/* A frame word or a ring's head, with all that was stored before it. */
static inline uint64_t segment_load(const _Atomic uint64_t *word)
{
    return atomic_load_explicit(word, memory_order_acquire);
}

/* A mapped world. Everything const is mapped read-only for this role, by the page tables. */
struct view {
    char name[SEGMENT_NAME_MAX];
    enum role role;
    int lock_fd;  /* of the role's lock; -1 for a reader */
    int made_fd;  /* of an object that has no name yet; -1 for any other */
    bool holds;   /* the role's lock is ours */
    bool checked; /* a stage has checked the frame that it found against its checksum */
    void *base;
    struct layout layout;
    const struct segment_header *header;
    struct world world;
    struct commit_words *commit;
    struct moved_word *moved_word;
    struct state w[2];
    struct moved m;
    struct event *events;
    struct command_ring_words *commands[COMMAND_RING_COUNT];
    struct doorbells *doors;
    struct role_slot *slot[ROLE_COUNT];
};

/* A place to say in one line what was refused and why. */
struct reason {
    char text[512];
    bool foreign; /* what was refused is no world of this build: nothing is lost with it */
    bool damaged; /* a check looked at the world and found it damaged; else it may be good */
};

/* Formats into reason and returns -1, so that a failing path reads "return reason_set(...)". */
int reason_set(struct reason *reason, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Is this a name a world may have: 1..31 of a-z A-Z 0-9 _ - ? The second says so: 0, or -1 with the
 * reason. */
bool segment_name_ok(const char *name);
int segment_name_check(const char *name, struct reason *reason);

/* The same as the check of an option's value: why does not repeat the name. */
int segment_name_option(const char *name, const struct error_text *why);

/* Where a world is in the file system. */
struct segment_paths {
    char name[SEGMENT_PATH_MAX];   /* the link in the runtime folder */
    char lock[SEGMENT_PATH_MAX];   /* the lock file beside it */
    char object[SEGMENT_PATH_MAX]; /* in /dev/shm; "" when the name leads to no world */
};

/* Looks where a world's name leads now. 0, also when it leads to no world. -1 with the reason when
 * it is no name, when there is no runtime folder, or when something else lies under the name. */
int segment_paths(struct segment_paths *paths, const char *name, struct reason *reason);

/* Creation, in one process that nobody else can see yet:
 *   segment_begin   makes an object without a name, with space for every region of header, mapped
 *                   writable; fill the static regions and frame 0 through view
 *   segment_publish hashes, writes the magic and gives it its names; refuses when the world exists
 *   segment_abandon frees what begin made. The kernel does so too, when the process ends.
 * 0, or -1 with the reason. header gives counts and sizes; the rest of it is filled here. */
int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct reason *reason);
int segment_publish(struct view *view, struct reason *reason);
void segment_abandon(struct view *view);

/* The same layout in anonymous memory that nobody else can attach to (children of fork share it):
 * tests and benchmarks run the steps on it. Fill it like a created one; segment_abandon frees it.
 * 0, or -1 with the reason. */
int segment_private(struct view *view, const struct segment_header *header, struct reason *reason);

/* The header fields that follow from a scenario's parameters and the counts of a built world. */
struct segment_header segment_header_for(const struct params *params, const struct counts *counts);

/* Do the parameters that sizes and waits are computed from fit the header? path is for the message.
 * 0, or -1 with the reason. */
int segment_params_fit(const struct params *params, const struct segment_header *header,
                       const char *path, struct reason *reason);

/* Copies a built world and its parameters into a begun or private segment, as frame 0. */
void segment_fill(struct view *view, const struct world_build *built);

/* Attaches to a world in a role: takes the role's lock, checks magic, version, layout hash, size,
 * owner, mode and counts, maps, and marks the slot as starting. -1 with the reason when the world
 * does not exist, is not this build's, or the role is held by a live process. Does not block. */
int segment_attach(struct view *view, const char *name, enum role role, struct reason *reason);

/* The same without the role's lock: to be ready for the day that its holder dies. */
int segment_stand_by(struct view *view, const char *name, enum role role, struct reason *reason);

/* Waits, blocked in the kernel, until the role's lock is free, and takes it. Nothing of the world
 * may have been written, and nothing read from it counts, before this returns 0. -1 with EINTR when
 * the process is asked to stop meanwhile. A view that holds its role already has it at once. */
int segment_take(struct view *view);

/* The holder says that it is up, and who it is; readers may now count on it. */
void segment_ready(struct view *view);

/* Unmaps and drops the lock; marks the slot absent. */
void segment_detach(struct view *view);

/* Takes the hash of every region that never changes into the header of a begun or private view. */
void segment_hash_static(struct view *view);

/* All of them as one. */
uint64_t segment_static_hash(const struct segment_header *header);

/* Hashes the static regions (about a millisecond) and compares. 0, or -1 with the reason. */
int segment_verify(const struct view *view, struct reason *reason);

/* Are a head's counts within the tables and lists that they count in? Is W[frame & 1] whole and
 * this frame? Is the moved table? The last two hash what there is (1 ms for about 20,000 entities).
 * 0, or -1 with what is wrong, by its field. */
int segment_check_head(const struct view *view, const struct state_head *head,
                       struct reason *reason);
int segment_check_state(const struct view *view, uint64_t frame, struct reason *reason);
int segment_check_moved(const struct view *view, uint64_t frame, struct reason *reason);

/* Looks at a world that no mover and no collider runs (their locks are held meanwhile) and puts its
 * words right: when the last frame is damaged it goes back to the one before, if that is whole;
 * when the moved table is, the frame is moved again. What was lost is computed again, to the same
 * bytes. 0 when the world is good, 1 when it was repaired, -1 when it cannot be or is run; report
 * says in one line what was found and done. Hashes the whole world: milliseconds, more with many
 * entities. */
int segment_repair(const char *name, struct reason *report);

/* Removes the world's object, its name and its sockets, and its lock file unless a supervisor holds
 * that. A name that leads to no world is removed too. Refuses while a role is held, unless force.
 * 0, or -1 with the reason. segment_remove_own() is for the supervisor that holds the lock file: it
 * removes that too. segment_sweep() leaves a world as it is, and removes only what lies around a
 * name that leads to none. */
int segment_remove(const char *name, bool force, struct reason *reason);
int segment_remove_own(const char *name, struct reason *reason);
int segment_sweep(const char *name, struct reason *reason);

/* Has the role a live holder? For a view that holds a role itself; opens nothing. */
bool segment_held(const struct view *view, enum role role);

/* Pid that the holder of a role has said, 0 when none holds it. For people to read: a holder that
 * has just taken the role has not said it yet (0), or the one before it is still named. */
int segment_holder(const char *name, enum role role);

/* Pid of the live holder of a role. Waits until until_ns (CLOCK_MONOTONIC) for one that has just
 * taken it to say its pid. 0 when nobody holds the role, or has not said it by then. */
int segment_holder_alive(const char *name, enum role role, uint64_t until_ns);

/* Waits until none of the roles 0 .. last is held, by their locks, at most until until_ns
 * (CLOCK_MONOTONIC). 0, or -1 with the reason: which role is held and, if that is known, by whom.
 */
int segment_wait_free(const char *name, enum role last, uint64_t until_ns, struct reason *reason);

/* Names in this user's runtime folder: of worlds, or, with all, of whatever is left of one too.
 * Writes at most max of them and returns how many it wrote; -1 with the reason. */
int segment_list(char names[][SEGMENT_NAME_MAX], int max, bool all, struct reason *reason);

/* Objects and lock files of this user in /dev/shm to which no name in the runtime folder leads: of
 * an earlier version, of another runtime folder, or of one that is gone. Nobody can tell which, so
 * they are only listed. At most max names of files; how many it wrote. */
#define SEGMENT_LOST_MAX 128
int segment_list_lost(char files[][SEGMENT_LOST_MAX], int max);

#endif
