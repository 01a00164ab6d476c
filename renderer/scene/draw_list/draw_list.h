/* The draw list: what one picture shows, as lists that a back end draws. It holds what lies in the
 * camera's view, each thing at the level of detail for its size in the picture. It does not depend
 * on a graphics library. The ground is listed as patches, which the back ends turn into tiles.
 *
 * Positions are in metres relative to the camera's eye, along the world's axes. Pure. */
#ifndef JOLON_RENDERER_SCENE_DRAW_LIST_DRAW_LIST_H
#define JOLON_RENDERER_SCENE_DRAW_LIST_DRAW_LIST_H

#include "renderer/scene/camera/camera.h"
#include "renderer/scene/camera/frustum.h"
#include "renderer/scene/frame/body_axes.h"
#include "renderer/scene/frame/frame_view.h"
#include "renderer/scene/model/mesh.h"
#include "renderer/scene/terrain/terrain_quadtree.h"

#include <stdbool.h>
#include <stdint.h>

struct grass;

#define DRAW_LIST_PLANTS_MAX    24576u
#define DRAW_LIST_BODIES_MAX    8192u
#define DRAW_LIST_PARTICLES_MAX 8192u
#define DRAW_LIST_DENTS_MAX     4096u

#define DRAW_LIST_PLANT_STEEP 0.70710678f /* sine and cosine of 45 degrees */

#define BODY_MIN_PIXELS 1.3  /* smaller bodies are left out */
#define BENT_MIN_PIXELS 48.0 /* dents of smaller bodies are left out */

/* A back end moves each vertex and its normal about the pivot of its joint (struct mesh_skeleton),
 * by its part (enum model_part), in this order. A wheel rolls about z by travel over radius; a
 * pivot with z < 0 is on the left side. A front wheel then turns about y by steer_rad. Then the
 * shape changes: first dents, then collapse, then the break. A gun tilts about z by gun_rad, then
 * turns with the turret. A turret turns about y by turret_rad, a rotor about y and a tail rotor
 * about z by rotor_rad. The shade of a track alternates with along + travel / link length. */

/* Trees, bushes and grass: upright pictures that turn to the eye. Seen from more than 45 degrees
 * above, they lean back by the excess angle, so that they do not look thinner from the air. With
 * the foot at (level, -below) from the eye the angle is asin((below - level) / distance *
 * DRAW_LIST_PLANT_STEEP). */
struct draw_list_plant {
    float at[3]; /* the foot */
    float width, height;
    float lean;     /* to the right, as a share of the height: a damaged tree */
    float picture;  /* enum plant_impostors */
    float slope[2]; /* of the ground: rise per metre to the east, to the south */
    float tint[3];  /* multiplies the picture's colours */
};

/* An instance of a polygon model. */
struct draw_list_body {
    float at[3];
    float forward[3], up[3], right[3];               /* body axes times the model's scale */
    float tint[3];                                   /* the force's colour */
    float burn;                                      /* 0 undamaged .. 1 burnt out */
    float turret_rad, gun_rad, rotor_rad, steer_rad; /* to the right, up, around, to the right */
    float travel_m[2]; /* distance rolled by the left and the right wheels and tracks, modulo
                          ARTICULATION_WRAP_M */
    float plane[4];    /* normal and offset of the plane n.p = d that the shadow falls on; n = 0: no
                          shadow */
    float dents[2];    /* first dent in the draw list, number of dents */
    float noise_seed;  /* selects the noise of a collapsed body's heap */
    float collapse[3]; /* x, z [1/m, body axes], offset: the body has collapsed where x *
                          collapse[0] + z * collapse[1] + collapse[2] > 1, with a ragged edge */
    float broken[3];   /* x, y of the break [m, body axes]; forward angle above it [rad] */
};

/* Moves the surface within reach_m of the point along the direction, most at the point. */
struct draw_list_dent {
    float point[3], depth_m;     /* [m, body axes] */
    float direction[3], reach_m; /* unit, body axes */
};

/* The mesh of the body at the same index. */
struct draw_list_instance {
    uint16_t model;
    uint8_t detail; /* enum mesh_detail */
    uint8_t shadow;
};

enum particle_picture {
    PARTICLE_SMOKE_A,
    PARTICLE_SMOKE_B,
    PARTICLE_SMOKE_C,
    PARTICLE_SMOKE_D,
    PARTICLE_FLAME_A,
    PARTICLE_FLAME_B,
    PARTICLE_GLOW,
    PARTICLE_DISC,  /* a rotor disc */
    PARTICLE_SPRAY, /* soil or water thrown up towards the upper edge */
    PARTICLE_PICTURE_COUNT
};

/* Smoke, dust, fire and tracers: pictures that face the eye, in order from the farthest. */
struct draw_list_particle {
    float at[3];
    float axis[3]; /* stretched by this vector to both sides of the centre; 0: round */
    float size;    /* half the side; half the width if stretched */
    float turn_rad;
    float picture; /* enum particle_picture */
    float glow;    /* 0 covers what is behind it .. 1 adds light to it */
    float colour[4];
};

/* An entry of the sort of the bodies. */
struct body_order {
    struct draw_list_instance instance;
    uint32_t index;
};

/* An entry of the sort of the particles. */
struct particle_key {
    uint32_t key, index;
};

struct draw_list {
    struct camera camera;
    struct frustum frustum; /* the camera's */
    float detail;  /* 0..1, set by the caller, initially 1: range of grass and woods, density of
                      particles */
    double time_s; /* simulation time, for what moves in the picture */
    bool fog, haze, texture; /* thesis row 5 */
    struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX];
    uint32_t patch_count;
    uint32_t texture_budget; /* number of ground textures that the picture may make;
                                TERRAIN_TILES_ALL when not live */
    struct draw_list_plant *plants;
    uint32_t plant_count;
    struct draw_list_body *bodies; /* sorted so that instances of one mesh are adjacent */
    struct draw_list_instance *instances;
    uint32_t body_count;
    struct draw_list_particle *particles;
    uint32_t particle_count;
    struct draw_list_dent *dents;
    uint32_t dent_count;
    uint32_t omitted;                            /* things in view for which a list had no room */
    struct body_order *order;                    /* scratch */
    struct particle_key *particle_keys;          /* scratch, twice DRAW_LIST_PARTICLES_MAX */
    struct draw_list_particle *particles_sorted; /* scratch */
    struct grass *grass;                         /* kept from picture to picture */
};

/* Returns the level of detail of a body of this size in the picture [pixel]. A smaller body never
 * gets a finer level. bent: the body has dents, so that its mesh must be fine enough to bend. */
enum mesh_detail draw_list_detail(double pixels, bool bent);

/* Appends a cleared body. Returns NULL if the list is full, and counts the body in omitted. */
struct draw_list_body *draw_list_add_body(struct draw_list *list, uint16_t model,
                                          enum mesh_detail detail);

/* Sorts the bodies so that instances of one mesh are adjacent and each mesh is drawn once. */
void draw_list_sort_bodies(struct draw_list *list);

/* Sets the body's position, axes and scale. */
void draw_list_place_body(const struct draw_list *list, struct draw_list_body *body,
                          struct vec3 position, const struct body_axes *axes, double scale);

/* Gives the last body of the list a shadow, unless it is too small or too far away for one. */
void draw_list_add_shadow(struct draw_list *list, const struct frame_view *frame_view,
                          struct vec3 position, double pixels);

/* Sets at to the position relative to the eye, in float. */
static inline void draw_list_relative(const struct draw_list *list, struct vec3 position,
                                      float at[3])
{
    at[0] = (float)(position.x - list->camera.eye.x);
    at[1] = (float)(position.y - list->camera.eye.y);
    at[2] = (float)(position.z - list->camera.eye.z);
}

#endif
