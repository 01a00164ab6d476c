/* The world as the console reads it: attached to when it is there, without a role, looked at now
 * and then, and copied only when somebody asks. However many ask, a copy is taken at most ten times
 * a second and for at most one part in WATCH_SHARE of the time; it serves all who ask meanwhile.
 *
 * Under the console's lock, by any thread. */
#ifndef JOLON_CONSOLE_WATCH_H
#define JOLON_CONSOLE_WATCH_H

#include "ipc/snapshot.h"

#include <stdbool.h>

#define WATCH_COPY_NS      100000000u
#define WATCH_LOOK_NS      250000000u /* is the world still there, or back? */
#define WATCH_RATE_SAMPLES 11u        /* of WATCH_COPY_NS: the frame rate over a second */
#define WATCH_SHARE        8u

struct watch {
    const char *name;
    bool there;        /* what follows is attached */
    struct reason why; /* there is none */
    struct view view;
    char object[SEGMENT_PATH_MAX]; /* the one that is mapped */
    bool turret[KIND_COUNT_MAX];   /* has the kind one? */
    uint64_t looked_ns;
    double time_s, scale; /* of the simulation, at the last turn */
    struct snapshot snapshot;
    bool copied; /* the snapshot holds a frame */
    uint64_t copied_ns, spent_ns;
    struct {
        uint64_t at_ns, commit;
    } rate[WATCH_RATE_SAMPLES];
    uint32_t rate_next, rate_count;
};

void watch_open(struct watch *watch, const char *name);
void watch_close(struct watch *watch);

/* Attaches, lets go of a world that was removed or made anew, measures the rate. To be called ten
 * times a second. True when the world came or went. */
bool watch_turn(struct watch *watch, uint64_t now_ns);

/* Sees to it that the snapshot is as new as it has to be. 0, or -1: there is no world, or no whole
 * frame of it; why says it. */
int watch_copy(struct watch *watch, uint64_t now_ns);

/* Frames a second of the clock, over the last one. */
double watch_rate_hz(const struct watch *watch);

/* "running", "paused", "finished", "stopped" (there is no mover), "stalled" (... that moves). */
const char *watch_state(const struct watch *watch, const struct state_head *head);

/* Row of the entity with this id in the snapshot, SLOT_NONE when there is none. */
uint32_t watch_row(const struct watch *watch, uint32_t id);

#endif
