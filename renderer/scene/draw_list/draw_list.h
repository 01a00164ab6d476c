/* The draw list: what one picture shows, as lists that a back end draws. It holds what lies in view
 * of the camera, each thing at the level of detail for its size in the picture. The lists name no
 * graphics library. Of the world they need only the ground, which the back ends tile.
 *
 * Positions in the lists are metres relative to the camera's eye, along the world's axes. Pure. */
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

#define BODY_MIN_PIXELS 1.3  /* smaller than this nobody sees it */
#define BENT_MIN_PIXELS 48.0 /* nor that it is bent, smaller than this */

/* How parts move (enum model_part), about the pivots of their joints (struct mesh_skeleton), in the
 * order in which a back end does it to a corner and its normal: a wheel rolls about z, the top
 * ahead, by its side's way over its radius: pivot left of the middle (z < 0) is the left side; a
 * front wheel then turns about y by the steering; then come dents, what fell in and what is broken:
 * all that changes the form; a gun tilts about z by gun_rad, muzzle up, then turns as the turret
 * does; a turret turns about y by turret_rad, a rotor about y and a tail rotor about z by
 * rotor_rad. A track's shade alternates with (along + way / length of a link), light and dark by
 * turns. */

/* Trees, bushes, tufts of grass: upright pictures that turn to the eye. Seen from more than 45
 * degrees above, they lie back by the angle beyond that, their tops away from the eye, so that from
 * the air they are no thinner: with the foot at (level, -below) from the eye, by
 * asin((below - level) / distance * DRAW_LIST_PLANT_STEEP). */
struct draw_list_plant {
    float at[3]; /* the foot */
    float width, height;
    float lean;     /* to its right, as a share of the height: broken trees */
    float picture;  /* enum plant_impostors */
    float slope[2]; /* of the ground: rise a metre to the east, to the south */
    float tint[3];  /* on the picture's colours */
};

/* Anything made of polygons. */
struct draw_list_body {
    float at[3];
    float forward[3], up[3], right[3];               /* body axes, scaled */
    float tint[3];                                   /* the force's colour */
    float burn;                                      /* 0 as built .. 1 burnt out */
    float turret_rad, gun_rad, rotor_rad, steer_rad; /* to the right, up, around, to the right */
    float travel_m[2]; /* that its left and its right wheels and tracks have run, wrapped */
    float plane[4];    /* n.xyz, d: its shadow falls where n.p == d; 0: nowhere */
    float dents[2];    /* first and count in the scene's list */
    float noise_seed;  /* a number of its own, for what a heap looks like */
    float
        collapse[3]; /* x, z [1/m, body axes] and more: it fell in where x * falls[0] + z * falls[1]
                     + falls[2] is above 1, raggedly */
    float broken[3]; /* x, y [m, body axes], and how far what is above is bent ahead [rad] */
};

/* The surface within reach of the point is moved along the way, most at the point. */
struct draw_list_dent {
    float point[3], depth_m;     /* [m, body axes] */
    float direction[3], reach_m; /* unit, body axes */
};

/* What a body in the same place of the list is a copy of. */
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
    PARTICLE_DISC,  /* of a rotor */
    PARTICLE_SPRAY, /* soil or water thrown up, towards the upper edge */
    PARTICLE_PICTURE_COUNT
};

/* Smoke, dust, fire, tracers: pictures that face the eye, farthest first. */
struct draw_list_particle {
    float at[3];
    float axis[3]; /* stretched so far to both sides of the place; 0: round */
    float size;    /* half the side, half the width of a stretched one */
    float turn_rad;
    float picture; /* enum particle_picture */
    float glow;    /* 0 covers what is behind it .. 1 adds light to it */
    float colour[4];
};

/* A body's place in the order. */
struct body_order {
    struct draw_list_instance instance;
    uint32_t index;
};

/* A puff's place in the order. */
struct particle_key {
    uint32_t key, index;
};

struct draw_list {
    struct camera camera;
    struct frustum frustum; /* of the camera */
    float detail;  /* above 0 .. 1, full: how far tufts and woods reach, how dense puffs are;
                      the caller's, 1 at first */
    double time_s; /* of simulation, for what moves in the picture */
    bool fog, haze, texture; /* thesis row 5 */
    struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX];
    uint32_t patch_count;
    uint32_t
        texture_budget; /* ground tiles that the picture may paint; TERRAIN_TILES_ALL but live */
    struct draw_list_plant *plants;
    uint32_t plant_count;
    struct draw_list_body *bodies; /* copies of one model and detail follow each other */
    struct draw_list_instance *instances;
    uint32_t body_count;
    struct draw_list_particle *particles;
    uint32_t particle_count;
    struct draw_list_dent *dents;
    uint32_t dent_count;
    uint32_t omitted;                            /* things in view for which a list had no room */
    struct body_order *order;                    /* scratch */
    struct particle_key *particle_keys;          /* scratch, twice as many */
    struct draw_list_particle *particles_sorted; /* scratch */
    struct grass *grass;                         /* kept from picture to picture */
};

/* Level of detail of a body that shows so large [pixel]; never finer for a smaller one. bent: its
 * polygons are moved, and must be fine enough for it. */
enum mesh_detail draw_list_detail(double pixels, bool bent);

/* A free place at the end of the list of bodies, cleared; NULL, and counted, when there is none. */
struct draw_list_body *draw_list_add_body(struct draw_list *list, uint16_t model,
                                          enum mesh_detail detail);

/* Brings copies of one mesh together, so that each mesh is drawn once. */
void draw_list_sort_bodies(struct draw_list *list);

/* Where it is, how it is turned, and its size over its model's. */
void draw_list_place_body(const struct draw_list *list, struct draw_list_body *body,
                          struct vec3 position, const struct body_axes *axes, double scale);

/* Gives the last body of the list a shadow, unless it is too small or too far for one to show. */
void draw_list_add_shadow(struct draw_list *list, const struct frame_view *frame_view,
                          struct vec3 position, double pixels);

/* Places relative to the eye, in float. */
static inline void draw_list_relative(const struct draw_list *list, struct vec3 position,
                                      float at[3])
{
    at[0] = (float)(position.x - list->camera.eye.x);
    at[1] = (float)(position.y - list->camera.eye.y);
    at[2] = (float)(position.z - list->camera.eye.z);
}

#endif
