/* Polygon models prepared for drawing: triangles at falling levels of detail, and one level finer
 * than the model for bodies with dents. Curved surfaces are smooth, edges sharp. Pure.
 *
 * A coarser level is made by dropping small parts and collapsing edges until the level has few
 * enough triangles. Errors are measured in pixels at the largest size at which the level is drawn
 * (draw_list_detail), so that the change from level to level is hardly visible. The coarsest level
 * is made from the collision geometry, if the model has any. */
#ifndef JOLON_RENDERER_SCENE_MODEL_MESH_H
#define JOLON_RENDERER_SCENE_MODEL_MESH_H

#include "world/model.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

#define MESH_FULL_PIXELS   150.0 /* larger bodies are drawn MESH_FULL ... */
#define MESH_MIDDLE_PIXELS 56.0  /* ... larger than this MESH_MIDDLE ... */
#define MESH_COARSE_PIXELS 18.0  /* ... and larger than this MESH_COARSE */
#define MESH_ERROR_PIXELS  0.6   /* a surface moved this far counts as much as ... */
#define MESH_DROP_PIXELS   0.9   /* ... a dropped part that covers the square of this */

/* Most triangles of a level. */
#define MESH_MIDDLE_MAX   1500u
#define MESH_COARSE_MAX   700u
#define MESH_COARSEST_MAX 150u

enum mesh_detail {
    MESH_FINE, /* divided finely enough for dents */
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
    uint8_t force_tint; /* share of the force's colour, 255: all */
    uint16_t part;      /* enum model_part */
    uint16_t joint;     /* below MODEL_JOINTS_MAX */
    float along;        /* of a track: position along it [links] */
};

struct mesh {
    struct mesh_vertex *vertices; /* three for each triangle; owned */
    uint32_t count;               /* vertices */
};

/* Data that all levels of a model share: its joints and its size. */
struct mesh_skeleton {
    float low[3], high[3]; /* [m, body axes] box around the visible triangles */
    /* [m, body axes] centre of each joint; fourth: radius of a wheel or rotor, length of a track's
     * link [m]. Joint 0 is the turret, which carries the gun. */
    float pivot[MODEL_JOINTS_MAX][4];
    uint8_t part[MODEL_JOINTS_MAX]; /* enum model_part of each joint; PART_BODY: none */
    bool turret;                    /* the model has one */
};

/* Returns 0, or -1 with errno ENOMEM. */
int mesh_build(struct mesh *mesh, const struct world *world, uint32_t model,
               enum mesh_detail detail);
void mesh_free(struct mesh *mesh);

/* Returns 0, or -1 with errno ENOMEM. */
int mesh_skeleton(struct mesh_skeleton *skeleton, const struct world *world, uint32_t model);

#endif
