/* Polygon models of the kinds, as they are drawn; world/entity/hull.h has the shapes that collide.
 * Written once at creation, read-only to all. */
#ifndef JOLON_WORLD_MODEL_H
#define JOLON_WORLD_MODEL_H

#include "world/entity/kind.h"

#include <stdint.h>

/* Polygon models. Body axes: x forward, y up, z right, origin at the entity's position, metres.
 * Triangles are counter-clockwise from outside. */
struct model {
    char name[KIND_NAME_MAX];
    uint32_t first_triangle, triangle_count;
    uint32_t first_vertex, vertex_count;
    uint32_t solid_triangles, solid_vertices; /* the first ones collide and are invisible, the
                                                 others are only visible; 0: all are both */
};

struct model_vertex {
    float x, y, z;
};

/* How a part of a model moves (docs/scenario.md, Models). */
enum model_part {
    PART_BODY,
    PART_TURRET,
    PART_GUN, /* on the turret, where there is one */
    PART_ROTOR,
    PART_TAIL_ROTOR,
    PART_WHEEL,
    PART_FRONT_WHEEL, /* steers */
    PART_TRACK,
    PART_COUNT
};

#define MODEL_JOINTS_MAX 32u /* parts of a model that move independently, the turret included */

/* The share of the force's colour in a triangle's colour, 255 being all of it: for the materials
 * "force" (flags and panels), "paint" (in camouflage), and "wash" and those below (plain). */
#define MODEL_TINT_FORCE 255
#define MODEL_TINT_PAINT 80
#define MODEL_TINT_WASH  70

struct model_triangle {
    uint32_t vertex[3];       /* index within the model */
    uint8_t red, green, blue; /* 0..255, sRGB */
    uint8_t force_tint;       /* MODEL_TINT_..., or 0 */
    uint16_t part;            /* enum model_part */
    uint16_t joint;           /* which of them; 0: the body and the turret */
};

/* Returns how many of a model's first triangles collide. */
static inline uint32_t model_solid_triangles(const struct model *model)
{
    return model->solid_triangles > 0 ? model->solid_triangles : model->triangle_count;
}

#endif
