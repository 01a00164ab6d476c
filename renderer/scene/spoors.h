/* Where entities lately were: what they leave behind lies along it. Noted from moments as they are
 * seen; a bounded memory by slot. Pure. */
#ifndef JOLON_RENDERER_SPOORS_H
#define JOLON_RENDERER_SPOORS_H

#include "renderer/scene/moment.h"

#include <stdbool.h>
#include <stdint.h>

#define SPOORS_SLOTS 4096u /* entities in higher slots are taken to have come straight */
#define SPOOR_POINTS 12u

struct spoor_point {
    float at[3], velocity[3]; /* [m, world], [m/s] */
    double time_s;            /* of simulation */
};

/* Of one entity, and how it fared; the points' ring holds the last SPOOR_POINTS. */
struct spoor {
    uint32_t id; /* 0: nobody's */
    uint32_t count;
    uint16_t kind;
    bool wrecked;    /* it was seen to be one */
    double smokes_s; /* since when it smokes, of simulation; INFINITY: it does not */
    struct spoor_point point[SPOOR_POINTS];
};

struct spoors {
    struct spoor spoor[SPOORS_SLOTS]; /* by slot */
};

/* Notes where everything is whose way will show. Called for a moment again it changes nothing. */
void spoors_note(struct spoors *spoors, const struct moment *moment);

/* A munition's last place, from its detonation. */
void spoors_end(struct spoors *spoors, uint32_t id, const double point[3], double time_s);

/* The slot's spoor if it is this entity's, else NULL. */
const struct spoor *spoors_of(const struct spoors *spoors, uint32_t slot, uint32_t id);

/* Where the entity was at a time, on a smooth curve through the points up to now, at a moment when
 * it was there. From before the first point on it came straight. */
struct spoor_point spoor_at(const struct spoor *spoor, const struct spoor_point *now,
                            double time_s);

/* How fast it was at its points since a time, and is now [m/s]. */
double spoor_fastest_mps(const struct spoor *spoor, const struct spoor_point *now, double since_s);

#endif
