/* The data that the parts of the software back end share. Private to renderer/soft.
 *
 * The picture is cut into bands of SOFT_BAND_ROWS rows, whose colours and depths fit a core's own
 * cache. A picture is made in two steps. Prepare: the ground, the bodies, the plants and the
 * particles are transformed, clipped, set up and sorted into a list for each band
 * (band_lists_sort). Each of the four may run in a thread of its own. Bands: each band is cleared,
 * then filled by one pass after the other: ground, shadows, bodies, plants, shading, particles.
 * Threads take the bands in turn. A pass only reads the lists and writes the rows of its band, so
 * that the picture is the same for any number of threads.
 *
 * A pixel of a band has a depth and a colour. The depth is 1 / (distance along the view), and 0 for
 * nothing, so that greater is nearer. The colour depends on its alpha. Alpha 255: a colour, red in
 * the lowest byte, then green, blue. Alpha 0: ground or sky that the shading pass will colour. For
 * ground, bits 0..15 are a ground code (soft_ground.h) and bits 16..23 say how dark a shadow is
 * (SOFT_SHADOW_FULL at most); for sky the depth is 0. The shading pass writes alphas below 255 to
 * ground and sky, by which FXAA finds their edges (fxaa.h). Passes that blend over them keep the
 * alpha.
 *
 * Each pass has the same structure, for example the bodies: soft_bodies.c owns the lists and calls
 * the kernels soft_bodies_set_up (prepare) and soft_bodies_fill (band). Set-up fills corners8 with
 * eight triangles at a time, clips those that cross the near plane (triangle_raster_clip), calls
 * triangle_raster_set_up and triangle_raster_plane, and stores the visible triangles with the rows
 * that they touch. Fill calls triangle_raster_walk for each triangle of the band's list, with an
 * inlined function that tests, shades and stores eight pixels. */
#ifndef JOLON_RENDERER_SOFT_SOFT_INTERNAL_H
#define JOLON_RENDERER_SOFT_SOFT_INTERNAL_H

#include "ipc/segment/segment.h"
#include "renderer/scene/back_end_interface.h"
#include "renderer/scene/scene.h"

#include <stddef.h>
#include <stdint.h>

#define SOFT_BAND_ROWS   32
#define SOFT_SIDE_MAX    8192 /* of a picture [pixel] */
#define SOFT_BANDS_MAX   (SOFT_SIDE_MAX / SOFT_BAND_ROWS)
#define SOFT_ALIGN       64  /* [byte] of rows */
#define SOFT_SHADOW_FULL 255 /* of a pixel's eight shadow bits */
#define SOFT_SHADOW_BITS 16  /* the lowest shadow bit */

struct soft_kernels;

/* The data of the picture that every part reads. Vectors are in the world's axes. */
struct soft_frame {
    const struct draw_list *list;
    const struct frame_view *frame_view;
    const struct soft_kernels *kernels;
    uint32_t width, height, bands;
    /* A point p from the eye appears at x = centre_x + dot(across, p) / d, y = centre_y + dot(down,
     * p) / d [pixel], where d = dot(ahead, p) [m]. */
    float across[3], down[3], ahead[3];
    float centre_x, centre_y, near_m;
    /* Pixel (x, y) looks along ray + x * ray_x + y * ray_y, which is 1 m long along the view; pixel
     * centres lie at halves. */
    float ray[3], ray_x[3], ray_y[3];
    float right[3], up[3], forward[3]; /* unit */
    float pixel_m;                     /* the width of a pixel at a distance of 1 m */
    float sun[3];
    float haze, fog, fog_fall; /* [1/m] haze; fog at the eye's height; its thinning with height */
    float time_s;
    bool texture;
};

/* A band: rows first .. end - 1 of the picture. Row y begins at (y - first) * stride of both
 * arrays. */
struct soft_target {
    uint32_t *colour;
    float *depth; /* [rows * stride], aligned to SOFT_ALIGN */
    uint32_t width, stride, band;
    int32_t first, end;
};

/* --- triangles, set up in triangle_raster.h --- */

/* The edges of a triangle: its corners from top to bottom, and by how many columns each edge moves
 * in a row. */
struct triangle_edges {
    float top_x, top_y, middle_x, middle_y, low_y;
    float long_slope, upper_slope, lower_slope;
};

/* A value that is linear over the picture: at the triangle's top corner, and its growth for each
 * pixel to the right and down. */
struct triangle_plane {
    float top, x, y;
};

#endif
