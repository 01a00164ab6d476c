/* The segment: a world in POSIX shared memory, its creation and its mapping.
 *
 * The object is "/dev/shm/jolon.UID.NAME.X", mode 0600. X is 32 random hexadecimal digits, so that
 * no other user can create the name first. The world's name is a symbolic link NAME to the object
 * in the runtime folder (ipc/segment/runtime_folder.h), which no other user can enter. NAME.lock
 * beside the link holds the roles' locks, and stays as long as the world. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_H
#define JOLON_IPC_SEGMENT_SEGMENT_H

#include "world/runtime/error_text.h"
#include "ipc/segment/doorbell.h"
#include "ipc/segment/layout.h"
#include "ipc/segment/role.h"
#include "ipc/segment/world_names.h"
#include "world/entity/command.h"
#include "world/state.h"
#include "world/terrain/posts_file.h"
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
    /* Written by segment_repair() alone, while no role runs. Frame repeat_frame (0: none) is made
     * again and takes the commands of each ring up to repeat_end, as it did the first time. */
    _Alignas(64) uint64_t repeat_frame;
    uint64_t repeat_end[COMMAND_RING_COUNT];
};

struct command_ring_words {             /* only writer: the ring's process */
    _Alignas(64) _Atomic uint64_t head; /* commands ever written */
    _Alignas(64) struct command slot[]; /* [layout_ring_slots()] */
};

/* Loads a frame word or a ring's head with acquire order. */
static inline uint64_t segment_load(const _Atomic uint64_t *word)
{
    return atomic_load_explicit(word, memory_order_acquire);
}

/* A mapped world. The page tables map everything that is const here read-only for this role. */
struct view {
    char name[SEGMENT_NAME_MAX];
    enum role role;
    int lock_fd;     /* of the lock file; -1 for a reader */
    int object_fd;   /* of an object that has no name yet, else -1 */
    bool holds_role; /* this process holds the role's lock */
    bool checked;    /* a stage has checked the frame that it found against its checksum */
    void *base;
    struct layout layout;
    const struct segment_header *header;
    struct world world;
    struct posts_file posts_file; /* with counts.posts_in_file: where terrain's posts are */
    struct commit_words *commit;
    struct moved_word *moved_word;
    struct state w[2];
    struct moved m;
    struct event *events;
    struct command_ring_words *commands[COMMAND_RING_COUNT];
    struct doorbells *doorbells;
    struct role_slot *slot[ROLE_COUNT];
};

/* Creation. No other process can see the world before it is published.
 *
 *   segment_begin    makes an object without a name, reserves the space of every region and maps
 *                    it writable; the caller then fills the static regions and frame 0
 *   segment_publish  hashes the static regions, writes the magic word and gives the object its
 *                    names; refuses when the world exists
 *   segment_abandon  frees what segment_begin made, as the kernel does when the process ends
 *
 * header gives counts and sizes; the rest of it is filled here. Return 0, or -1 with the reason. */
int segment_begin(struct view *view, const char *name, const struct segment_header *header,
                  struct error_text *error);
int segment_publish(struct view *view, struct error_text *error);
void segment_abandon(struct view *view);

/* Makes the same layout in anonymous memory, which only children of fork() share: tests and
 * benchmarks run the steps on it. The caller fills it, and frees it by segment_abandon(). Returns
 * 0, or -1 with the reason. */
int segment_private(struct view *view, const struct segment_header *header,
                    struct error_text *error);

/* Returns the header fields that follow from a scenario's parameters and the counts of a built
 * world. */
struct segment_header segment_header_for(const struct params *params, const struct counts *counts);

/* Maps the posts file of a large world, which the recipe names; other worlds have none. Attaching
 * does so; who fills a segment calls it before terrain is used. Returns 0, or -1 with the reason:
 * which file is missing, and what makes it. */
int segment_map_posts(struct view *view, struct error_text *error);

/* Takes the pages of what never changes in a world, so that no step waits for them. */
void segment_prefault(const struct view *view);

/* Copies a built world and its parameters into a begun or private segment, as frame 0. */
void segment_fill(struct view *view, const struct world_build *built);

#endif
