/* The segment: a world in POSIX shared memory, its creation and its mapping.
 *
 * Object "/jolon.UID.NAME", mode 0600; beside it in the same file system the lock file
 * "jolon.UID.NAME.lock", which holds the roles' locks and is never removed while the world
 * lives. */
#ifndef JOLON_IPC_SEGMENT_H
#define JOLON_IPC_SEGMENT_H

#include "ipc/door.h"
#include "ipc/layout.h"
#include "ipc/role.h"
#include "world/genesis.h"
#include "world/world.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define SEGMENT_NAME_MAX 32 /* of a world, with the NUL */
#define SEGMENT_PATH_MAX 96

struct commit_words {                      /* only writer: collider */
    _Alignas(64) _Atomic uint64_t commit;  /* last committed frame */
    _Alignas(64) _Atomic uint64_t writing; /* frame being written into W[writing & 1] */
};

struct moved_word {                      /* only writer: mover */
    _Alignas(64) _Atomic uint64_t moved; /* frame that M holds */
};

struct command_ring_words {             /* only writer: the ring's process */
    _Alignas(64) _Atomic uint64_t head; /* commands ever written */
    _Alignas(64) struct command slot[]; /* [command_slots] */
};

/* A mapped world. Everything const is mapped read-only for this role, by the page tables. */
struct view {
    char name[SEGMENT_NAME_MAX];
    enum role role;
    int lock_fd;  /* holds the role's lock; -1 for a reader */
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
    struct doors *doors;
    struct role_slot *slot[ROLE_COUNT];
};

/* A place to say in one line what was refused and why. */
struct reason {
    char text[512];
};

/* Formats into reason and returns -1, so that a failing path reads "return reason_set(...)". */
int reason_set(struct reason *reason, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Is this a name a world may have: 1..31 of a-z A-Z 0-9 _ - ? */
bool segment_name_ok(const char *name);

/* Paths as seen in the file system (for the lock file, and to list worlds). */
void segment_paths(const char *name, char shm[SEGMENT_PATH_MAX], char lock[SEGMENT_PATH_MAX]);

/* Creation, in one process that nobody else can see yet:
 *   segment_begin   makes a temporary object with space for every region of header, mapped
 *                   writable; fill the static regions and frame 0 through view
 *   segment_publish hashes, writes the magic and moves it to its name; fails with EEXIST when the
 *                   world exists
 *   segment_abandon frees what begin made.
 * 0, or -1 with the reason. header gives counts and sizes; the rest of it is filled here. */
int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct reason *reason);
int segment_publish(struct view *view, struct reason *reason);
void segment_abandon(struct view *view);

/* The same layout in anonymous memory that nobody else can attach to (children of fork share it):
 * tests and benchmarks run the steps on it. Fill it like a created one; segment_abandon frees it.
 * 0, or -1 with the reason. */
int segment_private(struct view *view, const struct segment_header *header, struct reason *reason);

/* The header fields that follow from a scenario's parameters and a genesis' counts. */
struct segment_header segment_header_for(const struct params *params, const struct counts *counts);

/* Copies a genesis and its parameters into a begun or private segment, as frame 0. */
void segment_fill(struct view *view, const struct genesis *genesis);

/* Attaches to a world in a role: takes the role's lock, checks magic, version, layout hash, size,
 * owner, mode and counts, maps, and marks the slot as starting. -1 with the reason when the world
 * does not exist, is not this build's, or the role is held by a live process. Does not block. */
int segment_attach(struct view *view, const char *name, enum role role, struct reason *reason);

/* The holder says that it is up; readers may now count on it. */
void segment_ready(struct view *view);

/* Unmaps and drops the lock; marks the slot absent. */
void segment_detach(struct view *view);

/* Hashes the static regions (about a millisecond) and compares. 0, or -1 with the reason. */
int segment_verify(const struct view *view, struct reason *reason);

/* Removes the world's object, and its lock file unless a supervisor holds that. Refuses while a
 * role is held, unless force. 0, or -1 with the reason. */
int segment_remove(const char *name, bool force, struct reason *reason);

/* Pid of the live holder of a role, 0 when none. */
int segment_holder(const char *name, enum role role);

/* Names of this user's worlds, at most max; how many there are. */
int segment_list(char names[][SEGMENT_NAME_MAX], int max);

#endif
