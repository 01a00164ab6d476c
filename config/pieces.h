/* Pieces: what of a model hangs together. Corners at the same place are joined, whatever part of
 * the model they belong to; each piece is wrapped. Of a model with a part that is solid, that part
 * alone. */
#ifndef JOLON_CONFIG_PIECES_H
#define JOLON_CONFIG_PIECES_H

#include "config/wrap.h"
#include "world/scenario.h"

#include <stdint.h>

/* A piece flatter than this gets PIECES_THICKNESS_M, half of it to either side, so that every hull
 * has a volume: a rotor blade of a single quad is something that one can run into. */
#define PIECES_FLAT_M      0.001
#define PIECES_THICKNESS_M 0.02

/* Of one model: joining them looks at every pair. */
#define PIECES_MAX 256

struct piece {
    struct vec3 *point; /* every corner */
    uint32_t count;     /* 0: gone, there is no piece */
    struct wrap wrap;
};

struct pieces {
    struct piece piece[PIECES_MAX]; /* in the order of their first points by x, y, z */
    uint32_t count;
};

/* Finds the pieces of a model of the scenario; pieces is to be freed in any case. 0; -1 with errno
 * ENOMEM, E2BIG (more than PIECES_MAX pieces), or wrap_points()'s. */
int pieces_find(struct pieces *pieces, const struct scenario *scenario, const struct model *model);
void pieces_free(struct pieces *pieces);

/* Adds another's points to a piece's and takes the other away. wrap is that of both, and is taken;
 * NULL: the piece's own holds them. 0; -1 with errno ENOMEM. */
int pieces_join(struct piece *piece, struct piece *other, struct wrap *wrap);

#endif
