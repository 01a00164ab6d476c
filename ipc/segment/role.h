/* Roles: the kinds of processes, their locks and their slots.
 *
 * A role has one live holder at a time, the process that locks the role's byte of the world's lock
 * file by an open-file-description lock. The kernel drops the lock when the process dies. A slot is
 * a region of the segment that only the role's holder writes. */
#ifndef JOLON_IPC_SEGMENT_ROLE_H
#define JOLON_IPC_SEGMENT_ROLE_H

#include "ipc/segment/histogram.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The registry of roles: a row each, in the order of their slots.
 *
 *     X(TAG, "name", system calls, traits, first region, last region, start, stop)
 *
 * The role's program is jolon-NAME, and its manual page is docs/man/jolon-NAME.1. The system calls
 * are a list of ipc/sandbox/syscall_filter.c. The traits are of enum role_trait. Beside its own
 * slot the role writes the regions from the first to the last (ipc/segment/layout.h; REGION_COUNT:
 * none). The keeper starts and stops the roles of a set in the order of the last two columns; it
 * does not start a role that has 0 there. The mover starts last, so that frames begin when every
 * other role is there to see them; it stops first, and the roles that report what it did stop last.
 *
 * Renderers 2 to 4 are started by hand, side by side with the set's own. The console is the set's
 * own as well: further consoles are readers. A set has a gateway when the world's parameters say
 * so.
 */
#define ROLES(X)                                                                                   \
    X(MOVER, "mover", frame, ROLE_NEEDED | ROLE_MAKES_FRAMES | ROLE_RINGS, REGION_MOVED_WORD,      \
      REGION_MOVED, 8, 1)                                                                          \
    X(COLLIDER, "collider", frame, ROLE_NEEDED | ROLE_MAKES_FRAMES | ROLE_RINGS, REGION_COMMIT,    \
      REGION_EVENTS, 1, 2)                                                                         \
    X(INTAKE, "intake", intake, ROLE_NEEDED | ROLE_RINGS, REGION_COMMANDS + RING_CLIENTS,          \
      REGION_COMMANDS + RING_CLIENTS, 3, 3)                                                        \
    X(REPORTER, "reporter", reporter, ROLE_OPTIONAL, REGION_COUNT, REGION_COUNT, 4, 7)             \
    X(RECORDER, "recorder", recorder, ROLE_OPTIONAL | ROLE_RINGS, REGION_COMMANDS + RING_RECORDER, \
      REGION_COMMANDS + RING_RECORDER, 2, 4)                                                       \
    X(RENDERER, "renderer", renderer, ROLE_OPTIONAL | ROLE_RINGS | ROLE_DRAWS, REGION_COUNT,       \
      REGION_COUNT, 5, 6)                                                                          \
    X(RENDERER_2, "renderer-2", renderer, ROLE_RINGS | ROLE_DRAWS, REGION_COUNT, REGION_COUNT, 0,  \
      0)                                                                                           \
    X(RENDERER_3, "renderer-3", renderer, ROLE_RINGS | ROLE_DRAWS, REGION_COUNT, REGION_COUNT, 0,  \
      0)                                                                                           \
    X(RENDERER_4, "renderer-4", renderer, ROLE_RINGS | ROLE_DRAWS, REGION_COUNT, REGION_COUNT, 0,  \
      0)                                                                                           \
    X(CONSOLE, "console", console, 0, REGION_COUNT, REGION_COUNT, 6, 5)                            \
    X(GATEWAY, "gateway", gateway, ROLE_RINGS, REGION_COMMANDS + RING_GATEWAY,                     \
      REGION_COMMANDS + RING_GATEWAY, 7, 8)

enum role {
#define X(tag, ...) ROLE_##tag,
    ROLES(X)
#undef X
        ROLE_COUNT,
    ROLE_NONE = ROLE_COUNT /* a reader: no slot, no lock, any number of them */
};

enum role_trait {
    ROLE_MAKES_FRAMES = 1, /* no frame without it: another process stands by for the role, and the
                              set ends when the role fails too often */
    ROLE_RINGS = 2,        /* writes the doorbells */
    ROLE_DRAWS = 4,        /* a renderer: woken for each frame, and may open graphics drivers */
    ROLE_OPTIONAL = 8,     /* may be left out of a set */
    ROLE_NEEDED = 16       /* part of every set */
};

/* Returns true if the role has the trait, false for ROLE_NONE. */
bool role_has(enum role role, enum role_trait trait);

/* Fills order with the roles that the keeper starts, in the order of starting or stopping. Returns
 * their number. */
int role_order(enum role order[ROLE_COUNT], bool stopping);

/* Returns "mover", ..., "renderer", "renderer-2", ..., "console", or "?" out of range. */
const char *role_name(enum role role);

/* Writes the names of the roles with the trait (0: of all roles) into text, with ", " between them.
 * Returns text, which is cut off where the size ends. */
const char *role_names(enum role_trait trait, char *text, size_t size);

#define ROLE_NAMES_BYTES 128u /* room for the names of all roles */

/* Returns the role of this name, ROLE_NONE when there is none. */
enum role role_find(const char *name);

enum role_state { ROLE_ABSENT, ROLE_STARTING, ROLE_READY, ROLE_STOPPING, ROLE_STATE_COUNT };

const char *role_state_name(enum role_state state);

/* A role's slot: statistics that only its holder writes and any process reads without waiting. A
 * torn read shows an old number beside a new one. No result depends on a slot. */
struct role_slot {
    _Alignas(64) _Atomic uint64_t beat_ns; /* CLOCK_MONOTONIC of the last sign of life */
    _Atomic uint32_t pid;
    _Atomic uint32_t state; /* enum role_state */
    _Atomic uint64_t started_ns;
    _Atomic uint64_t starts;      /* times the role was taken; restarts are one fewer */
    _Atomic uint64_t frame;       /* the last frame that it worked on */
    _Atomic uint64_t stage_ns;    /* work on its last frame */
    _Atomic uint64_t late_frames; /* mover: frames not committed when the next was due */
    _Atomic uint64_t due_ns;      /* mover: CLOCK_MONOTONIC when the next frame is due */
    _Atomic uint64_t gaps;        /* consumers: events that the ring overwrote unread */
    _Atomic uint32_t detail_pct;  /* renderers: share of the full detail, else 0 */
    _Atomic uint32_t size_pct;    /* renderers: drawn size, of the picture's size */
    _Atomic uint64_t work;        /* mover and collider: grows with progress within a step */
    _Atomic uint32_t unguarded;   /* reporter: 1: takes commands without DDS Security */
    struct histogram stage;       /* the role's work a frame */
    struct histogram whole;       /* collider: mover's and collider's work a frame */
};

#define ROLE_SLOT_BYTES 8192u
_Static_assert(sizeof(struct role_slot) <= ROLE_SLOT_BYTES, "a slot has room in its region");

#endif
