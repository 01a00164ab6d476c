/* Polygon models made ready for drawing: flat-shaded triangles at falling levels of detail, and one
 * finer than the model for bodies that are dented. Pure. */
#ifndef JOLON_RENDERER_MESH_H
#define JOLON_RENDERER_MESH_H

#include "world/world.h"

#include <stdint.h>

enum mesh_detail {
    MESH_FINE, /* divided until a dent can bend it */
    MESH_FULL,
    MESH_COARSE,
    MESH_COARSEST,
    MESH_DETAIL_COUNT
};

struct mesh_vertex {
    float position[3]; /* [m, body axes] */
    float normal[3];   /* unit, of the triangle */
    uint8_t red, green, blue;
    uint8_t force_tint; /* 255: takes the force's colour */
    uint32_t part;      /* enum model_part */
};

struct mesh {
    struct mesh_vertex *vertices; /* three a triangle; owned */
    uint32_t count;               /* vertices */
};

/* What all levels of a model share. */
struct mesh_frame {
    float low[3], high[3];      /* [m, body axes] box around the vertices */
    float pivot[PART_COUNT][3]; /* [m] what a part turns about */
};

/* 0, or -1 with errno ENOMEM. */
int mesh_build(struct mesh *mesh, const struct world *world, uint32_t model,
               enum mesh_detail detail);
void mesh_free(struct mesh *mesh);

void mesh_frame(struct mesh_frame *frame, const struct world *world, uint32_t model);

#endif
