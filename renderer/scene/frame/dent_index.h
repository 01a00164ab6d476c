/* An index of the shared list of dents by body (thesis rows 33, 47). It is private to the
 * renderer. */
#ifndef JOLON_RENDERER_SCENE_FRAME_DENT_INDEX_H
#define JOLON_RENDERER_SCENE_FRAME_DENT_INDEX_H

#include "world/entity/dent.h"

#include <stdbool.h>
#include <stdint.h>

#define DENT_INDEX_PER_BODY 12u /* the deepest dents of a body are shown */

struct dent_index {
    const struct dent *dent; /* shared, append-only */
    uint32_t count;          /* dents that the index holds */
    uint32_t capacity;       /* of the list */
    uint32_t *older;  /* [capacity] 1 + index of the previous dent of the same body; 0: none */
    uint32_t *newest; /* [mask + 1] 1 + index of a body's last dent, by hash of the id; 0: free */
    uint32_t mask;
};

/* A dent at some time. */
struct dented {
    float point[3];     /* [m, body axes] */
    float direction[3]; /* unit, body axes */
    float depth_m;
};

/* The list may grow to capacity. Returns 0, or -1 with errno ENOMEM. */
int dent_index_init(struct dent_index *dents, const struct dent *list, uint32_t capacity);
void dent_index_free(struct dent_index *dents);

/* Adds the new dents of the list. count: from a committed head. */
void dent_index_update(struct dent_index *dents, uint32_t count);

/* Returns true if the body has ever been dented. */
bool dent_index_any(const struct dent_index *dents, uint32_t id);

/* Fills in the deepest dents of a body at a tick, the deepest first, and returns their number. The
 * depth is the plastic part and what is left of the elastic part. */
uint32_t dent_index_of(const struct dent_index *dents, uint32_t id, uint64_t tick, double dt_s,
                       struct dented of[DENT_INDEX_PER_BODY]);

#endif
