/* The connected pieces of a model, each with its convex hull. Triangles that share the place of a
 * corner are connected, if they belong to the same part that collides (world/entity/hull.h). Of a
 * model with a solid part, only that part counts. */
#ifndef JOLON_CONFIG_MESH_CONNECTED_PIECES_H
#define JOLON_CONFIG_MESH_CONNECTED_PIECES_H

#include "config/mesh/convex_hull.h"
#include "world/entity/hull.h"

#include <stdint.h>

struct model;
struct scenario;

/* A piece flatter than this becomes CONNECTED_PIECES_THICKNESS_M thick, half of it to either side,
 * so that every hull has a volume: bodies collide with a rotor blade that is one quad [m]. */
#define CONNECTED_PIECES_FLAT_M      0.001
#define CONNECTED_PIECES_THICKNESS_M 0.02

/* Most pieces of one model; joining them compares every pair. */
#define CONNECTED_PIECES_MAX 256

struct piece {
    struct vec3 *point; /* every corner */
    uint32_t count;     /* 0: it was joined to another piece */
    enum hull_part part;
    struct convex_hull hull;
};

struct connected_pieces {
    struct piece
        piece[CONNECTED_PIECES_MAX]; /* by part, in the order of their first points by x, y, z */
    uint32_t count;
};

/* Finds the pieces of a model of the scenario. The caller frees pieces in any case. 0; -1 with
 * errno ENOMEM, E2BIG (more than CONNECTED_PIECES_MAX pieces) or that of convex_hull_points(). */
int connected_pieces_find(struct connected_pieces *pieces, const struct scenario *scenario,
                          const struct model *model);
void connected_pieces_free(struct connected_pieces *pieces);

/* Moves the points of another piece to a piece. hull: the hull of both, which the piece then owns;
 * NULL: the hull of the piece holds the other. 0; -1 with errno ENOMEM. */
int connected_pieces_join(struct piece *piece, struct piece *other, struct convex_hull *hull);

#endif
