/* Bodies made ready for the picture: what set-up leaves for the bands. Private to soft_bodies.c and
 * its kernels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_BODIES_H
#define JOLON_RENDERER_SOFT_SOFT_BODIES_H

#include "renderer/soft/band_lists.h"
#include "renderer/soft/soft_mesh.h"
#include "renderer/soft/soft_texture.h"

#define SIDE_LEAST_PIXELS 24.0f /* a smaller body's faces are of one colour each */
#define PAINT_BROAD_PER_M 0.035f
#define PAINT_FINE_PER_M  0.31f

/* A face of a small body. */
struct soft_flat {
    struct triangle_edges edges;
    struct triangle_plane depth;
    uint32_t colour;
};

/* What varies over a side, each divided by the distance. The last three: of a body that is not as
 * it was built how far it fell in and is bare of paint, of a track the links along it. */
enum side_value {
    SIDE_RED, /* light */
    SIDE_GREEN,
    SIDE_BLUE,
    SIDE_X, /* [m, body axes] as built */
    SIDE_Y,
    SIDE_Z,
    SIDE_FELL,
    SIDE_BARE,
    SIDE_ALONG,
    SIDE_VALUES
};

/* A face with detail: light from corner to corner, paint by texture. */
struct soft_side {
    struct triangle_edges edges;
    struct triangle_plane depth;
    struct triangle_plane value[SIDE_VALUES];
    float colour[3];
    float worn;          /* 1: paint in camouflage */
    float links;         /* of a track: 0 plain .. 1 each link shows */
    uint16_t paint;      /* place in the list of paints */
    uint8_t broad, fine; /* mips of the fine texture for its broad and its fine pattern */
    bool track;
};

/* What all sides of a body have in common. */
struct soft_paint {
    float soot_low, soot_over; /* the step from paint to soot: where, and 1 over how wide */
    float soot_most;           /* that it covers */
    float burnt, rust;         /* how much is burnt at least; how much rust may show */
    float plain;               /* how much is burnt where there is no texture */
    float air[3], clear;       /* the air's colour times how much, and how much shows through */
    bool shaped;
};

/* A face's shadow on the ground. */
struct soft_shadow {
    struct triangle_edges edges;
    struct triangle_plane depth; /* nearer by what the ground may be off */
    uint32_t dark;               /* 1 .. SOFT_SHADOW_FULL */
};

/* Faces of a kind, and the bands they are in. */
struct soft_faces {
    void *list; /* owned */
    struct band_rows *rows;
    size_t list_room, row_room;
    uint32_t count;
    struct band_lists lists;
};

/* The corners of one body, as columns: its mesh's, and some that are cut at the near plane. First
 * where they are in the picture, for the body and again for its shadow. */
enum corner_column {
    CORNER_AHEAD, /* [m] along the view */
    CORNER_ACROSS,
    CORNER_DOWN, /* times the frame's vectors of that name */
    CORNER_OVER, /* 1 / ahead */
    CORNER_COLUMN,
    CORNER_ROW, /* [pixel] */
    CORNER_SHADE,
    CORNER_VALUE = 2 * CORNER_SHADE,           /* as enum side_value, not divided */
    CORNER_PLACE = CORNER_VALUE + SIDE_VALUES, /* three: as formed [m, body axes] */
    CORNER_NORMAL = CORNER_PLACE + 3,
    CORNER_COLUMNS = CORNER_NORMAL + 3
};

#define CORNERS_CUT 32u /* room for those cut from faces at hand */

struct soft_bodies {
    const struct static_scene *static_scene;
    struct soft_mesh *mesh; /* [models * MESH_DETAIL_COUNT]; owned */
    bool *opened;           /* [meshes] is it there? it comes when it is needed; owned */
    uint32_t meshes;
    float *column[CORNER_COLUMNS]; /* scratch; [0] owns them all */
    size_t column_room;            /* corners of each */
    const struct soft_detail *detail;
    struct soft_faces flats, sides, shades;
    struct soft_paint *paints; /* owned; of each body with sides */
    size_t paint_room;
    uint32_t paint_count;
};

/* How large the body may show and how far it reaches from its place. */
struct soft_reach {
    float pixels, metres, ahead;
};
struct soft_reach soft_bodies_reach(const struct soft_bodies *bodies,
                                    const struct soft_frame *frame, uint32_t index);

/* NULL with the reason. */
struct soft_bodies *soft_bodies_open(const struct static_scene *static_scene,
                                     const struct soft_detail *detail, struct error_text *error);
void soft_bodies_close(struct soft_bodies *bodies);
/* Sorts the bodies of the scene into the bands, and their shadows. May run in a thread of its own.
 * 0, or -1 with errno ENOMEM. */
int soft_bodies_prepare(struct soft_bodies *bodies, const struct soft_frame *frame);

#endif
