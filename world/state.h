/* The state of a world: the parts that a frame changes. The structs point into memory with another
 * owner: the shared segment, or a test's heap. */
#ifndef JOLON_WORLD_STATE_H
#define JOLON_WORLD_STATE_H

#include "world/entity/command.h"
#include "world/entity/entity.h"
#include "world/entity/battery.h"
#include "world/entity/debris.h"
#include "world/entity/mission.h"

#include <stddef.h>
#include <stdint.h>

struct crater;
struct dent;
struct event;
struct persistent_contact;
struct world;

/* Counters since the world began; part of the digest. */
struct counters {
    uint64_t collisions, fires, detonations, destroyed, fixed_damaged, agent_changes, commands;
    uint64_t events_dropped;   /* more in a frame than events_per_frame: counted, never silent */
    uint64_t craters_refused;  /* no room in the list of craters */
    uint64_t spawns_refused;   /* no free slot */
    uint64_t dents_refused;    /* no room in the list of dents */
    uint64_t contacts_refused; /* no room in the list of contacts */
};

/* The head of a world buffer and, as the mover stages it, of the moved table. */
struct state_head {
    uint64_t frame;        /* this buffer holds this frame */
    uint64_t tick;         /* steps of simulated time: frames without those that were paused */
    uint64_t event_end;    /* events of the run so far */
    uint64_t event_digest; /* over all of them, in order */
    uint64_t command_cursor[COMMAND_RING_COUNT]; /* commands taken from each ring */
    /* Behind the cursor of the last ring, RING_GATEWAY: see state_digest(). */
    double time_scale; /* simulated seconds a second of the clock; pacing only */
    uint32_t paused;
    uint32_t steps_left; /* frames to advance while paused */
    uint32_t quit;
    uint32_t used;       /* slots 0 .. used - 1 may hold an entity; those after them are zero */
    uint32_t alloc_next; /* where the search for a free slot continues */
    uint32_t next_id;
    uint32_t vehicles, munitions; /* active or wrecks; in flight */
    uint32_t crater_count;
    uint32_t dent_count;
    uint32_t contact_count;
    uint32_t fire_cursor;   /* fire orders of the scenario carried out */
    uint32_t intent_count;  /* M only: events the mover hands to the collider */
    uint32_t advanced;      /* 1: simulated time moved in this frame */
    uint32_t battery_count; /* entries of battery that are in use or cool down: the first ones */
    uint32_t debris_count;  /* entries of debris that are in use: the first ones */
    struct battery battery[BATTERIES_MAX];
    uint64_t mover_ns; /* M only: time of the mover's step; not in the digest */
    struct counters tally;
    struct battle_state battle;
    uint64_t checksum;                /* state_checksum(), moved_checksum() */
    struct debris debris[DEBRIS_MAX]; /* moving debris; unused entries are 0 */
};

/* Returns the bytes of a head that are in use: without the unused entries at its end. */
static inline size_t state_head_bytes(const struct state_head *head)
{
    uint32_t count = head->debris_count < DEBRIS_MAX ? head->debris_count : DEBRIS_MAX;
    return offsetof(struct state_head, debris) + count * sizeof(struct debris);
}

/* One buffer of the world. fixed_damage, contacts, craters and dents belong to W only. */
struct state {
    struct state_head *head;
    struct entities entities;
    uint64_t *hashes; /* of the blocks of rows (checksum.h); a reader's copy has none: NULL */
    /* A bit for each row, of whole blocks; in no checksum. A row without it is as in the moved
     * table from which the collider made the frame, to the bit. Bits of rows that are not in use
     * mean nothing. A reader's copy has none: NULL. */
    uint64_t *written;
    uint8_t *fixed_damage; /* [counts.fixed] as in world/terrain/fallen.h */
    struct persistent_contact
        *contacts;          /* [contact_count] sorted by ids; written by the collider */
    struct crater *craters; /* shared by both buffers, append-only: committed by crater_count */
    struct dent *dents;     /* the same, committed by dent_count */
};

/* The mover's output. */
struct moved {
    struct state_head *head;
    struct entities entities;
    uint64_t *hashes;      /* as in struct state */
    struct event *intents; /* [params.intents_per_frame]; sequence, frame, index not yet set */
    /* A bit for each row, of whole blocks; in no checksum. A row without it is as in the committed
     * frame from which the mover made the table, to the bit. */
    uint64_t *written;
};

_Static_assert(RING_GATEWAY == COMMAND_RING_COUNT - 1, "its cursor is the last");

/* Simulated time of a state [s]. */
double state_time_s(const struct world *world, const struct state_head *head);

/* Returns the digest of a frame: everything on which the next frame depends, in a fixed order, as
 * XXH3-64. It leaves out pacing, stage times and slots beyond used. */
uint64_t state_digest(const struct world *world, const struct state *state);

#endif
