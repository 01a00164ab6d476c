/* Makes a few convex hulls of a model's triangles, for the narrow phase (world/entity/hull.h).
 *
 * Each connected piece of the model gets its convex hull, and a piece inside the hull of another
 * becomes part of that piece. Then the two pieces are joined whose common hull has the least volume
 * beyond their own hulls. This is repeated until at most HULLS_A_MODEL pieces are left, and further
 * while joining adds next to no volume. Pieces of body, turret and gun are never joined with each
 * other. Every corner of the model is within a hull. The vertices of
 * a hull are corners of the model, except those of flat pieces (config/mesh/connected_pieces.h).
 * The same model gives the same hulls to the bit on every machine. */
#ifndef JOLON_CONFIG_MESH_HULLS_H
#define JOLON_CONFIG_MESH_HULLS_H

#include "config/syntax/key_table.h"
#include "world/maths/maths.h"

#include <stdint.h>

struct model;
struct scenario;

/* Two pieces are always joined when that adds no more volume than this [m3], the volume of a can of
 * fuel: fewer hulls make a faster narrow phase. */
#define HULLS_FREE_M3 0.02

/* When two pieces must be joined, others that add as much volume to within this share are joined
 * too. So a model that is the same on both sides mostly keeps the same hulls on both sides. */
#define HULLS_TIE_SHARE 0.01

/* Faces whose corners are this near to one plane are one face [m]. */
#define HULLS_FLAT_M 2e-6

/* A model's hulls, as its kinds have them. */
struct hulls {
    uint32_t first, count;               /* in the scenario's hulls */
    uint32_t outer;                      /* in the scenario's hulls: the hull around all of them */
    uint32_t first_part;                 /* in the scenario's hulls: one around each part */
    uint32_t parts;                      /* 0: the model has no turret */
    uint32_t body;                       /* the first so many hulls are of the body */
    struct vec3 turret_pivot, gun_pivot; /* [m] body axes */
    double bound_m;                      /* this and the next: as in struct kind */
    double level_m;
    double low_m, high_m;
};

/* Adds a model's hulls to the scenario's tables. place: where the message says the model is. 0; -1
 * with the message: too many pieces, a hull of more than HULL_VERTICES_MAX vertices, no memory. */
int hulls_build(struct hulls *hulls, struct scenario *scenario, const struct model *model,
                struct key_place place, struct error_text *error);

/* Adds hulls of convex pieces of a body, which are given as points: those of a piece begin where
 * those of the piece before it end, and end before point[end[i]]; 1..HULLS_A_MODEL pieces. Sets
 * *hulls as hulls_build() does. 0; -1 with errno ENOMEM, EDOM (a piece takes up no space) or ERANGE
 * (too many corners). */
int hulls_of_points(struct hulls *hulls, struct scenario *scenario, const struct vec3 *point,
                    const uint32_t *end, uint32_t pieces);

#endif
