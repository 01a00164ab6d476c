/* Commands: requests of players and outside programs. They reach the mover through one ring for
 * each writing process. Each is applied in exactly one frame and answered by an EVENT_COMMAND of
 * that frame. The key (source, sequence) is the sender's own; a repeated key is dropped. */
#ifndef JOLON_WORLD_ENTITY_COMMAND_H
#define JOLON_WORLD_ENTITY_COMMAND_H

#include <stdint.h>

/* The command rings, each with one writing process. */
enum command_ring {
    RING_CLIENTS,  /* of all clients of the command socket */
    RING_RECORDER, /* pauses and resumes, as recorder.when_full requests */
    RING_GATEWAY,  /* what other simulators say (remote.h), and commands of the gateway */
    COMMAND_RING_COUNT
};

enum command_type {
    COMMAND_NONE,
    COMMAND_PAUSE,
    COMMAND_RESUME,
    COMMAND_STEP,    /* amount: frames to advance while paused */
    COMMAND_SCALE,   /* value[0]: simulated seconds a second of the clock */
    COMMAND_DRIVE,   /* entity; value: throttle, steer, climb, traverse, elevate, each -1..1, and
                        brake, 0..1; force: enum gearing; amount: frames for which the source alone
                        drives it, after which it goes back to its agent; 0: any source, without a
                        time limit */
    COMMAND_RELEASE, /* entity: back to its agent; amount 1: also from another source */
    COMMAND_FIRE,    /* entity shoots: at target if not 0, else ahead; entity 0: kind detonates a
                        munition falling on value[0], value[1] (x, z) */
    COMMAND_SPAWN,   /* kind, force, value: x, z, altitude above ground, heading, speed; amount:
                        enum behaviour */
    COMMAND_REMOVE,  /* entity */
    COMMAND_QUIT,    /* the run ends with this frame */
    COMMAND_TYPE_COUNT
};

enum command_result {
    COMMAND_DONE,
    COMMAND_NO_SUCH_ENTITY,
    COMMAND_NO_SUCH_KIND,
    COMMAND_OUT_OF_RANGE,
    COMMAND_TABLE_FULL,
    COMMAND_CANNOT,  /* no rounds, destroyed, still reloading, not paused; the spot is crowded */
    COMMAND_UNKNOWN, /* not a type */
    COMMAND_TAKEN,   /* another source drives it */
    COMMAND_REMOTE,  /* another simulator owns it (remote.h) */
    COMMAND_RESULT_COUNT
};

struct command {
    uint64_t sequence;        /* number of the command in its ring, from 0; set with the slot */
    uint64_t source;          /* the sender: a number that it chose */
    uint64_t source_sequence; /* counted by the sender, from 1 */
    uint32_t type;            /* enum command_type */
    uint32_t entity;
    uint32_t target;
    uint32_t amount;
    uint16_t kind, force;
    uint32_t reserved;
    double value[6];
    uint64_t spare[4];
};

_Static_assert(sizeof(struct command) == 128, "two cache lines a slot");

/* Frames of simulation for which a DRIVE can hold a vehicle, at most. */
#define COMMAND_LEASE_MAX 1000000u

/* A vehicle is not spawned where this many stand within this many metres. */
#define COMMAND_SPOT_VEHICLES 8u
#define COMMAND_SPOT_M        10.0

#endif
