/* The world as the console reads it: attached to when it is there, without a role, looked at now
 * and then, and copied only when somebody asks. However many ask, a copy is taken at most ten times
 * a second and for at most one part in WORLD_READER_SHARE of the time; it serves all who ask
 * meanwhile.
 *
 * Under the console's lock, by any thread. */
#ifndef JOLON_CLIENTS_CONSOLE_WORLD_READER_H
#define JOLON_CLIENTS_CONSOLE_WORLD_READER_H

#include "ipc/frame/snapshot.h"
#include "world/entity/kind.h"

#include <stdbool.h>

#define WORLD_READER_COPY_NS      100000000u
#define WORLD_READER_LOOK_NS      250000000u /* is the world still there, or back? */
#define WORLD_READER_RATE_SAMPLES 11u /* of WORLD_READER_COPY_NS: the frame rate over a second */
#define WORLD_READER_SHARE        8u

struct world_reader {
    const char *name;
    bool attached;            /* what follows is attached */
    struct error_text detail; /* there is none */
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
    } rate[WORLD_READER_RATE_SAMPLES];
    uint32_t rate_next, rate_count;
};

void world_reader_open(struct world_reader *reader, const char *name);
void world_reader_close(struct world_reader *reader);

/* Attaches, lets go of a world that was removed or made anew, measures the rate. To be called ten
 * times a second. True when the world came or went. */
bool world_reader_turn(struct world_reader *reader, uint64_t now_ns);

/* Sees to it that the snapshot is as new as it has to be. 0, or -1: there is no world, or no whole
 * frame of it; why says it. */
int world_reader_copy(struct world_reader *reader, uint64_t now_ns);

/* Frames a second of the clock, over the last one. */
double world_reader_rate_hz(const struct world_reader *reader);

/* "running", "paused", "finished", "stopped" (there is no mover), "stalled" (... that moves). */
const char *world_reader_state(const struct world_reader *reader, const struct state_head *head);

/* Row of the entity with this id in the snapshot, SLOT_NONE when there is none. */
uint32_t world_reader_row(const struct world_reader *reader, uint32_t id);

#endif
