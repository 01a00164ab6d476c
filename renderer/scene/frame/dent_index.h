/* Where bodies are bent (thesis rows 33, 47): a private index over the shared list of dents, by
 * whose they are. */
#ifndef JOLON_RENDERER_SCENE_FRAME_DENT_INDEX_H
#define JOLON_RENDERER_SCENE_FRAME_DENT_INDEX_H

#include "world/entity/dent.h"

#include <stdbool.h>
#include <stdint.h>

#define DENT_INDEX_PER_BODY 12u /* shown of one body: its deepest */

struct dent_index {
    const struct dent *dent; /* shared, append-only */
    uint32_t count;          /* of them that the index knows */
    uint32_t capacity;       /* the list's */
    uint32_t *older;         /* [capacity] + 1: the one before of the same body; 0: none */
    uint32_t *newest;        /* [mask + 1] + 1: a body's last, by its id; 0: free */
    uint32_t mask;
};

/* A dent as it is at some moment. */
struct dented {
    float point[3];     /* [m, body axes] */
    float direction[3]; /* unit, body axes */
    float depth_m;
};

/* The list may grow to capacity. 0, or -1 with errno ENOMEM. */
int dent_index_init(struct dent_index *dents, const struct dent *list, uint32_t capacity);
void dent_index_free(struct dent_index *dents);

/* Takes in what the list has grown by; count as a committed head has it. */
void dent_index_update(struct dent_index *dents, uint32_t count);

/* Has the body ever been dented? */
bool dent_index_any(const struct dent_index *dents, uint32_t id);

/* The body's dents at a tick, the deepest first; how many. Deep is what stays and what has not yet
 * come back. */
uint32_t dent_index_of(const struct dent_index *dents, uint32_t id, uint64_t tick, double dt_s,
                       struct dented of[DENT_INDEX_PER_BODY]);

#endif
