/* Bodies that are prepared for the picture: the set-up kernel fills this, the fill kernels read it.
 * Private to soft_bodies.c and its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_BODIES_H
#define JOLON_RENDERER_SOFT_SOFT_BODIES_H

#include "renderer/soft/band_lists.h"
#include "renderer/soft/soft_mesh.h"
#include "renderer/soft/soft_texture.h"

#define TEXTURED_PIXELS_MIN 24.0f /* [pixel] the faces of a smaller body have one colour each */
#define PATTERN_BROAD_PER_M 0.035f
#define PATTERN_FINE_PER_M  0.31f

/* A face of a small body. */
struct soft_flat_face {
    struct triangle_edges edges;
    struct triangle_plane depth;
    uint32_t colour;
};

/* The values that vary over a textured face, each divided by the distance. FELL and BARE are for
 * deformed bodies, ALONG is for tracks. */
enum face_value {
    VALUE_RED, /* the light's colour */
    VALUE_GREEN,
    VALUE_BLUE,
    VALUE_X, /* [m, body axes] before any deformation */
    VALUE_Y,
    VALUE_Z,
    VALUE_COLLAPSED,
    VALUE_BARE,
    VALUE_ALONG,
    VALUE_COUNT
};

/* A textured face: the light is interpolated between its corners. */
struct soft_textured_face {
    struct triangle_edges edges;
    struct triangle_plane depth;
    struct triangle_plane value[VALUE_COUNT];
    float colour[3];
    float worn;          /* 1: camouflage paint */
    float links;         /* of a track: how clearly single links show, 0 .. 1 */
    uint16_t material;   /* index in the list of materials */
    uint8_t broad, fine; /* mips of the detail texture for its broad and its fine pattern */
    bool track;
};

/* What all textured faces of a body have in common. */
struct soft_material {
    float soot_low, soot_over; /* start of the transition from paint to soot; 1 / its width */
    float soot_most;           /* the greatest share that soot covers */
    float burnt, rust;         /* the least share that is burnt; the greatest share of rust */
    float plain;               /* the share that is burnt when textures are off */
    float air[3], clear;       /* the air's colour times its opacity; 1 - opacity */
    bool deformed;
};

/* A face's shadow on the ground. */
struct soft_shadow_face {
    struct triangle_edges edges;
    struct triangle_plane depth; /* moved towards the eye, as the ground is not exactly the plane */
    uint32_t dark;               /* 1 .. SOFT_SHADOW_FULL */
};

/* Faces of one kind, and the bands that they touch. */
struct soft_faces {
    void *list; /* owned */
    struct band_rows *rows;
    size_t list_room, row_room;
    uint32_t count;
    struct band_lists lists;
};

/* The columns of one body's corners: those of its mesh, then those that clipping adds. The first
 * set is projected for the body, the second, from CORNER_SHADOW on, for its shadow. */
enum corner_column {
    CORNER_AHEAD, /* [m] along the view */
    CORNER_ACROSS,
    CORNER_DOWN, /* dot products with the frame's vectors of that name */
    CORNER_OVER, /* 1 / ahead */
    CORNER_COLUMN,
    CORNER_ROW, /* [pixel] */
    CORNER_SHADOW,
    CORNER_VALUE = 2 * CORNER_SHADOW,          /* as enum face_value, not divided by the distance */
    CORNER_PLACE = CORNER_VALUE + VALUE_COUNT, /* three: after deformation [m, body axes] */
    CORNER_NORMAL = CORNER_PLACE + 3,
    CORNER_COLUMNS = CORNER_NORMAL + 3
};

#define CORNERS_CUT 32u /* for the corners that clipping adds to the faces at hand */

struct soft_bodies {
    const struct static_scene *static_scene;
    struct soft_mesh *mesh; /* [models * MESH_DETAIL_COUNT]; owned */
    bool *built;            /* [meshes] true when the mesh has been built; owned */
    uint32_t meshes;
    float *column[CORNER_COLUMNS]; /* scratch; [0] owns the memory of all */
    size_t column_room;            /* corners of each */
    const struct soft_detail *detail;
    struct soft_faces flat_faces, textured_faces, shadow_faces;
    struct soft_material *materials; /* owned; one for each textured body */
    size_t material_room;
    uint32_t material_count;
};

/* A body's bounding sphere: its diameter in the picture [pixel], its radius [m] and its middle's
 * distance along the view [m]. */
struct soft_bounds {
    float pixels, metres, ahead;
};
struct soft_bounds soft_bodies_bounds(const struct soft_bodies *bodies,
                                      const struct soft_frame *frame, uint32_t index);

/* Returns NULL with the reason on failure. */
struct soft_bodies *soft_bodies_open(const struct static_scene *static_scene,
                                     const struct soft_detail *detail, struct error_text *error);
void soft_bodies_close(struct soft_bodies *bodies);
/* Sorts the bodies and their shadows into the bands. May run in a thread of its own. Returns 0, or
 * -1 with errno ENOMEM. */
int soft_bodies_prepare(struct soft_bodies *bodies, const struct soft_frame *frame);

#endif
