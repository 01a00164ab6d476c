/* The segment: a world in POSIX shared memory, its creation and its mapping.
 *
 * The object is "/dev/shm/jolon.UID.NAME.X", mode 0600, where X is 32 random hexadecimal digits: so
 * nobody can take its name before it. The world's name is a symbolic link NAME to it in the runtime
 * folder (ipc/segment/runtime_folder.h), which nobody else can enter. Beside the link lies
 * NAME.lock, which holds the roles' locks and is never removed while the world lives. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_H
#define JOLON_IPC_SEGMENT_SEGMENT_H

#include "world/runtime/error_text.h"
#include "ipc/segment/doorbell.h"
#include "ipc/segment/layout.h"
#include "ipc/segment/role.h"
#include "ipc/segment/world_names.h"
#include "world/entity/command.h"
#include "world/state.h"
#include "world/world.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct event;
struct params;
struct world_build;

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

/* Creation, in one process that nobody else can see yet:
 *   segment_begin   makes an object without a name, with space for every region of header, mapped
 *                   writable; fill the static regions and frame 0 through view
 *   segment_publish hashes, writes the magic and gives it its names; refuses when the world exists
 *   segment_abandon frees what begin made. The kernel does so too, when the process ends.
 * 0, or -1 with the reason. header gives counts and sizes; the rest of it is filled here. */
int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct error_text *error);
int segment_publish(struct view *view, struct error_text *error);
void segment_abandon(struct view *view);

/* The same layout in anonymous memory that nobody else can attach to (children of fork share it):
 * tests and benchmarks run the steps on it. Fill it like a created one; segment_abandon frees it.
 * 0, or -1 with the reason. */
int segment_private(struct view *view, const struct segment_header *header,
                    struct error_text *error);

/* The header fields that follow from a scenario's parameters and the counts of a built world. */
struct segment_header segment_header_for(const struct params *params, const struct counts *counts);

/* Copies a built world and its parameters into a begun or private segment, as frame 0. */
void segment_fill(struct view *view, const struct world_build *built);

#endif
