/* Aircraft that nobody steers, and that the guard at the frame's end sends back. They go back along
 * their own path, which conserves both momenta. Where that is not enough they go back to where they
 * began the frame, and what this has changed of their momenta is put back. Pure; one thread. */
#ifndef JOLON_COLLIDER_GUARD_DRIFT_GUARD_H
#define JOLON_COLLIDER_GUARD_DRIFT_GUARD_H

#include "collider/response/response_context.h"
#include "collider/solver/contact_solver.h"

#include <stdbool.h>

/* The collider's own memory. */
struct drift_guard {
    struct solver_body *before, *after; /* [capacity of the world] of rows that met, and theirs */
    uint32_t *row;
    uint32_t count;
    uint8_t *seen;      /* [capacity of the world] 1: in seen_row */
    uint32_t *seen_row; /* of all groups of this frame */
    uint32_t seen_count;
};

/* Returns 0, or -1 with errno ENOMEM. */
int drift_guard_init(struct drift_guard *drift, const struct world *world);
void drift_guard_free(struct drift_guard *drift);

/* Returns true for an aircraft that nobody steers: it only holds its course. */
bool drift_guard_drifts(const struct response_context *context, uint32_t row);

/* Returns true if one of the bodies of a contact drifts, and both are still there. They turn freely
 * past each other, and may get into each other where they do not close by their velocities: that is
 * no impact. */
bool drift_guard_heeds(const struct response_context *context,
                       const struct persistent_contact *contact);

/* Puts a row where it was at an earlier time of its path: at this share of what its last impact has
 * left of the frame. Below 0: where it began the frame. It keeps its velocity and the angular
 * momentum of its rotation. */
void drift_guard_send_back(struct response_context *context, uint32_t row, double share);

/* Gives a row that is back where it began the frame, and those that it has met in the frame, the
 * momenta that they had before they went back, if all of them drift. Their energy does not grow.
 * Does nothing if that would take more energy than they have. */
void drift_guard_restore(struct drift_guard *drift, struct response_context *context, uint32_t row);

/* Forgets the frame. */
void drift_guard_forget(struct drift_guard *drift);

#endif
