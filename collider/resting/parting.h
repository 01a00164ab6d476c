/* How bodies part that overlap deeply, for instance because they began in each other. They are
 * displaced without a velocity, and no displacement brings two bodies deeper into each other.
 *
 * Sweeps over the points find how far each body would go. A crowd that has less room than
 * its bodies need spreads about its centre of mass instead: that parts every pair at once. So does
 * one that is locked: two of its bodies are deep in each other and did not move a frame ago. Then
 * each body in turn goes as far as its points allow, where all others are by then, several times.
 * So those at the edge go first, and those behind follow. At last those that only make way go back
 * as far as nobody needs it. Each intermediate state keeps the bounds of all points: the result
 * does not depend on convergence. Pure; one caller. */
#ifndef JOLON_COLLIDER_RESTING_PARTING_H
#define JOLON_COLLIDER_RESTING_PARTING_H

#include "collider/response/response.h"
#include "collider/resting/crowds.h"
#include "collider/solver/level_solver.h"

#include <stdbool.h>
#include <stdint.h>

struct resting_pair;

/* Of an overlap this share is recovered in a frame, and never faster than this. */
#define PARTING_SHARE 0.5
#define PARTING_MPS   10.0

/* A body of this frame's resting contacts. */
struct parting_body {
    uint32_t parent;       /* of bodies near each other */
    uint32_t first, end;   /* its bounds in parting.bound */
    bool parts;            /* of a root: two of its bodies are deep in each other */
    bool goes;             /* it belongs to such a group */
    bool spreads;          /* its crowd is dense */
    bool opens;            /* it belongs to a crowd that is locked */
    bool back;             /* it passes a bound */
    bool makes_way;        /* it goes, and is deep in nothing */
    uint32_t backs;        /* how often it went back */
    double wish_x, wish_z; /* [m/s] how it would go */
    double light;          /* [kg^-0.5] root of its inverse mass */
    /* Bodies in each other's way; the rest is of a root. */
    uint32_t crowd;
    bool locked;
    double mass_kg, centre_x, centre_z, reach_m;
};

/* The body's speed along a direction is at least that of the other body along it, less the slack.
 */
struct parting_bound {
    uint32_t other; /* body */
    double x, z;    /* unit, away from the other */
    double slack_mps;
};

/* The collider's own memory. */
struct parting {
    struct parting_body *body;
    struct parting_bound *bound;
    uint32_t *wishing; /* points whose bodies wish to part, a subset in order */
    uint64_t body_capacity, bound_capacity; /* half as many points */
};

/* What is parted: the solver's bodies, of which row is SLOT_NONE for a fixed object, and points,
 * those of a pair beside each other. */
struct parting_input {
    const struct response_context *context;
    struct crowds *crowds;     /* of all bodies that are deep in each other, measured */
    struct level_lanes *lanes; /* the solver's */
    const uint32_t *row;
    struct level_body *body;
    struct level_contact *point;
    const struct resting_pair *pair;
    uint32_t bodies, points, pairs;
};

/* Returns 0, or -1 with errno ENOMEM. */
int parting_init(struct parting *parting, uint64_t bodies, uint64_t points);
void parting_free(struct parting *parting);

/* Finds what pushes bodies apart (level_motion.pushed): those that are deep in each other, and all
 * that they may push, as above, and others by level_solver_part(). The contacts are solved. */
void parting_run(struct parting *parting, const struct parting_input *input);

#endif
