/* The highest ground in each gridsquare: who stays above it needs no look at the ground itself. */
#ifndef JOLON_COLLIDER_CREST_H
#define JOLON_COLLIDER_CREST_H

#include "world/square.h"
#include "world/terrain.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define CREST_LEAST_M (-1000.0)
#define CREST_STEP_M  0.25

/* Filled as squares are asked for: a world of 50 km would take a collider's start too long. */
struct crest {
    const struct terrain *terrain;
    _Atomic uint16_t *top; /* [SQUARE_COUNT] never below the square's ground without craters
                              [CREST_STEP_M above CREST_LEAST_M]; 0: not looked at yet */
};

/* 0, or -1 with errno ENOMEM. The terrain stays the caller's. */
int crest_init(struct crest *crest, const struct terrain *terrain);
void crest_free(struct crest *crest);

/* The memory that crest_below will need of a way near (x, z), to be asked for. */
static inline const _Atomic uint16_t *crest_at(const struct crest *crest, double x, double z)
{
    return &crest->top[square_of(x, z)];
}

/* Is a way from p to q surely above the ground and its craters, so that sweep_ground() is false?
 * May be false when it is. Any thread; what it tells does not depend on what was asked before. */
bool crest_below(const struct crest *crest, const struct crater_index *craters, struct vec3 p,
                 struct vec3 q);

#endif
