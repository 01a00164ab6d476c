/* The parts of the OpenGL back end. Each owns its programs and buffers and draws one kind of thing
 * from a draw list. All run in the thread that holds the context. Private to gl*.c. */
#ifndef JOLON_RENDERER_GL_GL_INTERNAL_H
#define JOLON_RENDERER_GL_GL_INTERNAL_H

#include "ipc/segment/segment.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/terrain/terrain_tiles.h"

#include <epoxy/gl.h>

#include <stdint.h>

/* Texture units, fixed for all programs. */
enum gl_unit {
    UNIT_TILE,
    UNIT_DETAIL,
    UNIT_PLANT,
    UNIT_FACING,
    UNIT_PARTICLE,
    UNIT_CLOUD,
    UNIT_DENTS,
};

/* The data of the picture that all shaders read; the layout is std140. */
struct gl_frame {
    float matrix[16];
    float right[4], up[4], forward[4]; /* the camera's axes; w: tan_x, tan_y, time [s] */
    float sun[4];                      /* unit; w: 1 with textures, 0 without */
    float fog[4]; /* haze [1/m], fog at its base [1/m], rate of thinning [1/m], eye above the base
                     [m] */
};

/* --- programs (gl_program.c) --- */

/* Links a vertex and a fragment shader, each after the shared text of light and air, and binds
 * gl_frame and the texture units. Returns 0 with the reason when the driver refuses. */
GLuint gl_program(const char *name, const char *vertex, const char *fragment,
                  struct error_text *error);

/* The same with text before the vertex shader. */
GLuint gl_program_on(const char *name, const char *before, const char *vertex, const char *fragment,
                     struct error_text *error);

/* Describes a vertex attribute of floats in the bound buffer, at a byte offset; divisor 1: one
 * value for each instance. */
void gl_attribute(GLuint index, GLint floats, size_t stride, size_t offset, GLuint divisor);

/* --- textures (gl_textures.c) --- */

/* Builds and binds the textures that never change. Returns 0, or -1 with the reason. */
struct gl_textures {
    GLuint detail, plants, facing, particles, clouds;
};
int gl_textures_open(struct gl_textures *textures, struct error_text *error);
void gl_textures_close(struct gl_textures *textures);

/* --- ground (gl_ground.c) --- */

/* The driver's copy of a tile; it has the tile's index in the cache. */
struct gl_tile {
    GLuint texture, vertices, triangles, array;
    uint64_t mesh_version, texture_version; /* of the tile when it was sent */
};

struct gl_ground_shader {
    GLuint program;
    GLint u_origin, u_detail, u_part, u_texel, u_surf;
};

struct gl_ground {
    const struct static_scene *static_scene;
    struct gl_ground_shader land, shore;
    struct terrain_tiles cache;
    struct gl_tile tiles[TILE_CAPACITY];
};
int gl_ground_open(struct gl_ground *ground, const struct static_scene *static_scene,
                   struct error_text *error);
void gl_ground_close(struct gl_ground *ground);
void gl_ground_draw(struct gl_ground *ground, const struct draw_list *list,
                    const struct frame_view *frame_view);

/* --- bodies (gl_bodies.c, gl_deform.c) --- */

/* The start of the vertex shaders of bodies: inputs, formed(), turned(), in_world(). */
extern const char gl_deform_text[];

struct gl_mesh {
    GLint first;
    GLsizei count;
};

struct gl_bodies {
    const struct static_scene *static_scene;
    GLuint program, shadow_program, array, meshes, instances;
    GLuint dents, dent_texture; /* the buffer, and a texture that views it */
    GLint u_pivots, u_low, u_shadow_pivots;
    struct gl_mesh *mesh; /* [models * MESH_DETAIL_COUNT] */
};
int gl_bodies_open(struct gl_bodies *bodies, const struct static_scene *static_scene,
                   struct error_text *error);
void gl_bodies_close(struct gl_bodies *bodies);
/* Sends the instances that the following draws use. */
void gl_bodies_send(struct gl_bodies *bodies, const struct draw_list *list);
void gl_bodies_draw_shadows(struct gl_bodies *bodies, const struct draw_list *list);
void gl_bodies_draw(struct gl_bodies *bodies, const struct draw_list *list);

/* --- plants, particles (gl_billboards.c) --- */

/* The plants or the particles of a picture: a vertex array and its buffer. */
struct gl_instances {
    GLuint array, buffer;
};

struct gl_billboards {
    GLuint plant_program, shadow_program, particle_program;
    struct gl_instances plants, particles;
};
int gl_billboards_open(struct gl_billboards *billboards, struct error_text *error);
void gl_billboards_close(struct gl_billboards *billboards);
void gl_billboards_send(struct gl_billboards *billboards, const struct draw_list *list);
void gl_plants_draw_shadows(struct gl_billboards *billboards, const struct draw_list *list);
void gl_plants_draw(struct gl_billboards *billboards, const struct draw_list *list);
void gl_particles_draw(struct gl_billboards *billboards, const struct draw_list *list);

#endif
