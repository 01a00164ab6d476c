/* The collider's step: from committed world k and the moved table to world k + 1 and its events.
 * Pure: no IPC, no clock, no I/O; the same bytes with any number of threads.
 *
 * Contacts that last are solved first, all together. Every other contact of the frame is found with
 * its time of impact and resolved in the order of time. If the response changes a body's path, the
 * new path is swept again from that time on. At the end no body is left deeper in another than it
 * was. */
#ifndef JOLON_COLLIDER_STEP_H
#define JOLON_COLLIDER_STEP_H

#include "collider/broad_phase/broad_phase.h"
#include "collider/narrow_phase/contact_queue.h"
#include "collider/method/method.h"
#include "collider/parting/aircraft_parting.h"
#include "collider/parting/sphere_parting.h"
#include "collider/response/contact_table.h"
#include "collider/response/island.h"
#include "collider/guard/end_guard.h"
#include "collider/resting/free_bodies.h"
#include "collider/resting/resting.h"
#include "collider/motion/body_motion.h"
#include "collider/response/explosion.h"
#include "world/checksum.h"
#include "world/runtime/thread_pool.h"
#include "world/terrain/crater.h"
#include "world/terrain/square_bounds.h"

struct event;
struct moved;
struct state;
struct world;

struct collider {
    const struct world *world;
    struct crater_index craters;  /* cache of the committed craters */
    struct square_bounds heights; /* of the ground */
    struct thread_pool *workers;  /* NULL: on the caller's thread */
    struct broad_phase broad;
    struct contact_queue contacts;
    struct body_motion motion;
    struct island island;
    struct contact_table table;
    struct resting resting;
    struct free_bodies free;
    struct end_guard guard;
    struct sphere_parting spheres;
    struct aircraft_parting aircraft;
    struct charges charges;
    struct method_workspace *workspace;
    struct pair_list pairs; /* what the method found */
    struct pair_list ends;  /* rows, and the ticks at which their stretches end earlier */
    bool slept; /* all contacts did in the last frame: the helpers need not stay awake */
    /* state_fixed_hash() of frame fixed_hash_frame; UINT64_MAX: none yet */
    uint64_t fixed_hash, fixed_hash_frame;
    struct list_hashes lists; /* of the committed craters and dents */
    /* A bit for each row that the mover wrote in the last two frames, as this process saw it; and
     * for each of this frame's that is on its springs, and that holds another body than before. */
    uint64_t *written[2], *sprung, *fresh;
    uint64_t left[2]; /* checksums of the two buffers as this process left them; 0: none */
};

/* Where the frame's events go: the ring, from the committed end on. */
struct event_ring {
    struct event *slot;
    uint64_t slots; /* power of two */
};

/* craters: the world's list. Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the
 * caller's. */
int collider_init(struct collider *collider, const struct world *world,
                  const struct crater *craters, struct thread_pool *workers);
void collider_free(struct collider *collider);

/* Takes the memory of the steps of this many rows, so that no step waits for its pages, and the
 * pages of the tables: of the world's two buffers for writing, of the moved table for reading. For
 * a stand-by process too. */
void collider_touch(const struct collider *collider, const struct moved *moved,
                    const struct state states[2], uint32_t rows);

/* Fills next and the ring; reads committed and moved, and writes neither. Takes no memory, and
 * makes no system call except to wake the workers. */
void collider_step(struct collider *collider, const struct state *committed,
                   const struct moved *moved, struct state *next, const struct event_ring *ring);

/* Returns the context of the responses for the frame that body_motion_begin was given; the caller
 * sets the event writer. Part of collider_step, and for tests. */
struct response_context collider_response_context(struct collider *collider, struct state *next);

#endif
