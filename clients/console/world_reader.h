/* Reads the world for the console. The reader attaches without a role when the world exists. It
 * copies the state only on request, at most ten times a second and for at most one part in
 * WORLD_READER_SHARE of the time; all requests meanwhile share the copy.
 *
 * Any thread may call the functions, under the console's lock. */
#ifndef JOLON_CLIENTS_CONSOLE_WORLD_READER_H
#define JOLON_CLIENTS_CONSOLE_WORLD_READER_H

#include "ipc/frame/motion_table.h"
#include "world/entity/kind.h"

#include <stdbool.h>

#define WORLD_READER_COPY_NS      100000000u
#define WORLD_READER_LOOK_NS      250000000u /* period of the check whether the world exists */
#define WORLD_READER_RATE_SAMPLES 11u /* every WORLD_READER_COPY_NS: the rate over a second */
#define WORLD_READER_SHARE        8u

struct world_reader {
    const char *name;
    bool attached;            /* the members below are valid */
    struct error_text detail; /* why no world is attached, or why no frame can be read */
    struct view view;
    char object[SEGMENT_PATH_MAX]; /* the shared memory object that is mapped */
    bool turret[KIND_COUNT_MAX];   /* the kind has a turret */
    uint64_t looked_ns;
    double time_s, scale; /* of the simulation, at the last turn */
    struct snapshot snapshot;
    bool copied; /* the snapshot holds a frame */
    bool told;   /* motions has been asked for, and is brought up to date with each copy */
    struct motion_table motions;
    uint64_t copied_ns, spent_ns;
    struct {
        uint64_t at_ns, commit;
    } rate[WORLD_READER_RATE_SAMPLES];
    uint32_t rate_next, rate_count;
};

void world_reader_open(struct world_reader *reader, const char *name);
void world_reader_close(struct world_reader *reader);

/* Attaches to the world, or detaches from one that was removed or replaced, and measures the rate.
 * To be called at least ten times a second. Returns true if the attached world has changed. */
bool world_reader_turn(struct world_reader *reader, uint64_t now_ns);

/* Brings the snapshot up to date. Returns 0, or -1 if there is no world or no complete frame of it;
 * detail then says why. */
int world_reader_copy(struct world_reader *reader, uint64_t now_ns);

/* Brings the snapshot and the motions up to date, which are made at the first call. As
 * world_reader_copy(). */
int world_reader_tell(struct world_reader *reader, uint64_t now_ns);

/* Returns the frame rate over the last second [1/s]. */
double world_reader_rate_hz(const struct world_reader *reader);

/* Returns "running", "paused", "finished", "stopped" (there is no mover) or "stalled" (no frame in
 * the last second). */
const char *world_reader_state(const struct world_reader *reader, const struct state_head *head);

/* Returns the row of the entity with this id in the snapshot, or SLOT_NONE. */
uint32_t world_reader_row(const struct world_reader *reader, uint32_t id);

#endif
