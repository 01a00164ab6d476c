/* Polygon models made ready for drawing: triangles at falling levels of detail, and one finer than
 * the model for bodies that are dented. Curved surfaces are smooth, edges sharp. Pure.
 *
 * A coarser level is what is left when small pieces are dropped and edges collapsed until there are
 * no more triangles than the level may have. What counts is how much of a pixel that moves at the
 * size from which on the level is drawn (draw_list_detail): two neighbours look alike where one
 * follows the other. The coarsest is made of what collides, where the model says what that is. */
#ifndef JOLON_RENDERER_SCENE_MODEL_MESH_H
#define JOLON_RENDERER_SCENE_MODEL_MESH_H

#include "world/model.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

#define MESH_FULL_PIXELS   150.0 /* a body that shows larger is drawn MESH_FULL ... */
#define MESH_MIDDLE_PIXELS 56.0  /* ... larger than this MESH_MIDDLE ... */
#define MESH_COARSE_PIXELS 18.0  /* ... and than this MESH_COARSE */
#define MESH_ERROR_PIXELS  0.6   /* that a surface moves weighs as much as ... */
#define MESH_DROP_PIXELS   0.9   /* ... a piece that is dropped and covers that square */

/* Triangles of a level. */
#define MESH_MIDDLE_MAX   1500u
#define MESH_COARSE_MAX   700u
#define MESH_COARSEST_MAX 150u

enum mesh_detail {
    MESH_FINE, /* divided until a dent can bend it */
    MESH_FULL,
    MESH_MIDDLE,
    MESH_COARSE,
    MESH_COARSEST,
    MESH_DETAIL_COUNT
};

struct mesh_vertex {
    float position[3]; /* [m, body axes] */
    float normal[3];   /* unit, of the surface */
    uint8_t red, green, blue;
    uint8_t force_tint; /* how much of it is the force's colour, 255: all of it */
    uint16_t part;      /* enum model_part */
    uint16_t joint;     /* below MODEL_JOINTS_MAX */
    float along;        /* of a track: [links] around it */
};

struct mesh {
    struct mesh_vertex *vertices; /* three a triangle; owned */
    uint32_t count;               /* vertices */
};

/* What all levels of a model share. */
struct mesh_skeleton {
    float low[3], high[3]; /* [m, body axes] box around what is seen */
    /* [m, body axes] what each joint turns about, and w: a wheel's or a rotor's radius, the length
     * of a track's link [m]. The turret's is the first: a gun is on it. */
    float pivot[MODEL_JOINTS_MAX][4];
    uint8_t part[MODEL_JOINTS_MAX]; /* enum model_part of each; PART_BODY: there is none */
    bool turret;                    /* there is one */
};

/* 0, or -1 with errno ENOMEM. */
int mesh_build(struct mesh *mesh, const struct world *world, uint32_t model,
               enum mesh_detail detail);
void mesh_free(struct mesh *mesh);

/* 0, or -1 with errno ENOMEM. */
int mesh_skeleton(struct mesh_skeleton *skeleton, const struct world *world, uint32_t model);

#endif
