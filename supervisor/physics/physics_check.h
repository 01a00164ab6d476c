/* A judge of the physics of a run: it looks at every vehicle and wreck of every frame, and keeps
 * the worst value of each measure (docs/collisions.md, "Bounds"). It reads states, and shares no
 * code with the mover and the collider: it has its own ground, rotations, overlaps of hulls,
 * neighbours and energies. It changes nothing. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_PHYSICS_CHECK_H
#define JOLON_SUPERVISOR_PHYSICS_PHYSICS_CHECK_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/energy.h"
#include "supervisor/physics/measure.h"
#include "supervisor/physics/overlaps.h"
#include "supervisor/physics/surface.h"
#include "world/terrain/crater.h"

#include <stdint.h>

struct event;
struct persistent_contact;
struct state;
struct world;

/* The ring of the world's events. */
struct physics_events {
    const struct event *slot;
    uint64_t slots; /* power of two */
};

struct physics_check {
    const struct world *world;
    struct hull_shape *shape; /* [counts.hulls] */
    struct surface surface;
    struct crater_index craters;
    struct body_looks looks;
    struct overlaps overlaps;
    struct energy energy;
    struct measures measures;
    struct persistent_contact *contact; /* [contact_count] of the frame before */
    uint32_t contact_count;
    uint64_t event_end; /* events that were looked at */
    uint64_t frames;    /* looked at, the first one not counted */
    uint64_t bodies;    /* looked at in all these frames */
    uint32_t most;      /* bodies in a frame */
};

/* Prepares for a world and looks at the state with which the run begins. Returns 0, or -1 with
 * errno ENOMEM. */
int physics_check_begin(struct physics_check *check, const struct world *world,
                        const struct state *state);
void physics_check_free(struct physics_check *check);

/* Looks at the next frame and its events. Returns 0, or -1 with errno ENOMEM. */
int physics_check_frame(struct physics_check *check, const struct state *state,
                        const struct physics_events *events);

#endif
