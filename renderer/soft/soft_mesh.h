/* A model's mesh for the rasteriser: faces share corners, which are stored as columns for vector
 * loops. The corners of one part and joint are consecutive. Pure. */
#ifndef JOLON_RENDERER_SOFT_SOFT_MESH_H
#define JOLON_RENDERER_SOFT_SOFT_MESH_H

#include "renderer/scene/model/mesh.h"

#include <stdbool.h>
#include <stdint.h>

#define SOFT_MESH_PAD 8u /* a group's corners begin at a multiple of this, one vector */

struct soft_face {
    uint32_t corner[3];
    uint8_t red, green, blue;
    uint8_t force_tint; /* 255: has the force's colour */
    bool track;
};

/* Corners that move together. */
struct soft_group {
    uint32_t first, end; /* corners, padded with copies to a multiple of SOFT_MESH_PAD */
    uint16_t part;       /* enum model_part */
    uint16_t joint;
};

enum mesh_column {
    MESH_PLACE_X, /* [m, body axes] */
    MESH_PLACE_Y,
    MESH_PLACE_Z,
    MESH_NORMAL_X, /* unit */
    MESH_NORMAL_Y,
    MESH_NORMAL_Z,
    MESH_ALONG, /* distance along a track [links] */
    MESH_COLUMNS
};

struct soft_mesh {
    float *column[MESH_COLUMNS]; /* [corner_count]; [0] owns the memory of all */
    struct soft_face *faces;     /* owned */
    struct soft_group *groups;   /* owned */
    uint32_t corner_count, face_count, group_count;
    bool closed; /* no face can be seen from behind */
};

/* Builds the mesh of a model. Returns 0, or -1 with errno ENOMEM. */
int soft_mesh_open(struct soft_mesh *mesh, const struct world *world, uint32_t model,
                   enum mesh_detail detail);
void soft_mesh_close(struct soft_mesh *mesh);

#endif
