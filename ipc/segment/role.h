/* Roles: the one table of process kinds, their locks and their slots.
 *
 * A role is held by one live process at a time: it owns one byte of the world's lock file through
 * an open-file-description lock, which the kernel drops when the process dies. A slot is a region
 * of the segment that only the holder writes: who it is, that it lives, what its stages take. */
#ifndef JOLON_IPC_SEGMENT_ROLE_H
#define JOLON_IPC_SEGMENT_ROLE_H

#include <stdatomic.h>
#include <stdint.h>

enum role {
    ROLE_MOVER,
    ROLE_COLLIDER,
    ROLE_INTAKE,
    ROLE_REPORTER,
    ROLE_RECORDER,
    ROLE_RENDERER,
    ROLE_RENDERER_2, /* more renderers side by side, each its own slot */
    ROLE_RENDERER_3,
    ROLE_RENDERER_4,
    ROLE_CONSOLE, /* the set's own; consoles that people start beside it are readers */
    ROLE_COUNT,
    ROLE_NONE = ROLE_COUNT /* a reader: no slot, no lock, any number of them */
};

/* "mover", ..., "renderer", "renderer-2", ..., "console"; "?" out of range. */
const char *role_name(enum role role);

/* The role called name, ROLE_NONE when there is none. */
enum role role_find(const char *name);

enum role_state { ROLE_ABSENT, ROLE_STARTING, ROLE_READY, ROLE_STOPPING, ROLE_STATE_COUNT };

const char *role_state_name(enum role_state state);

/* A log-linear histogram of times: 16 buckets a factor of two, 64 ns to 18 min; error under 7 %. */
#define HISTOGRAM_BUCKETS 560u

struct histogram {
    uint64_t count;
    uint64_t max_ns;
    uint32_t bucket[HISTOGRAM_BUCKETS];
};

void histogram_add(struct histogram *histogram, uint64_t ns);
/* The value below which the fraction (0..1) of the entries lie [ns]; 0 when empty. */
uint64_t histogram_quantile(const struct histogram *histogram, double fraction);

/* The entries that came between two looks at a histogram that somebody else goes on filling; its
 * greatest is that of its highest bucket. */
void histogram_since(struct histogram *since, const struct histogram *now,
                     const struct histogram *before);

/* Written by the role's holder alone, read by anyone without waiting: statistics, of which a torn
 * read shows an old number beside a new one, and of which none goes into the world. */
struct role_slot {
    _Alignas(64) _Atomic uint64_t beat_ns; /* CLOCK_MONOTONIC of the last sign of life */
    _Atomic uint32_t pid;
    _Atomic uint32_t state; /* enum role_state */
    _Atomic uint64_t started_ns;
    _Atomic uint64_t starts;      /* times the role was taken; restarts are one fewer */
    _Atomic uint64_t frame;       /* it last worked on */
    _Atomic uint64_t stage_ns;    /* its last frame's work */
    _Atomic uint64_t late_frames; /* mover: not committed within a frame's time of their due */
    _Atomic uint64_t due_ns;      /* mover: CLOCK_MONOTONIC when the next frame is due */
    _Atomic uint64_t gaps;        /* consumers: events lost to a ring that went round */
    _Atomic uint32_t detail_pct;  /* renderers: what is drawn of all detail; 0: others ... */
    _Atomic uint32_t size_pct;    /* ... and the size it is drawn at, of the picture's */
    _Atomic uint64_t work;      /* mover and collider: goes up as a step gets on, also within it */
    _Atomic uint32_t unguarded; /* reporter: 1: anybody on its network commands the world */
    struct histogram stage;     /* the role's own work a frame */
    struct histogram whole;     /* collider: mover's and collider's work of one frame */
};

#define ROLE_SLOT_BYTES 8192u
_Static_assert(sizeof(struct role_slot) <= ROLE_SLOT_BYTES, "a slot has room in its region");

#endif
