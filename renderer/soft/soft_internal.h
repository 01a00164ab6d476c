/* The software back end's parts. Private to renderer/soft.
 *
 * The picture is cut into bands of SOFT_BAND_ROWS rows; a band's colours and depths stay in a
 * core's own cache. A picture is made in two steps:
 *   prepare   each kind of thing is transformed, clipped, set up and sorted into lists, one for
 *             each band (band_lists_sort). The kinds are prepared by different threads.
 *   bands     each band is cleared, then filled by one pass after the other: ground, shadows,
 *             bodies, plants, resolve, puffs. Threads take bands as they come; a band reads the
 *             lists and writes its own rows, so that the picture is the same for any number of
 *             threads.
 *
 * A pixel of a band is its depth, 1 / (distance along the view) and 0 for nothing, so that greater
 * is nearer; and its colour, which before resolve may be a promise:
 *   alpha 255   coloured already: red lowest, then green, blue
 *   alpha 0     ground that resolve will colour: bits 0..15 where and how (soft_ground.h),
 *               bits 16..23 how dark a shadow lies on it (SOFT_SHADOW_FULL at most); or nothing
 *               (depth 0), where resolve paints the sky.
 * Resolve leaves alphas below 255 on ground and sky, which tell where edges may be
 * (image/smooth.h): what is blended over them later keeps the alpha.
 *
 * How a pass is made (bodies, say): soft_bodies.c owns the lists and their memory, and calls the
 * kernels soft_bodies_set_up (prepare) and soft_bodies_fill (band) in kernel_bodies.c, which is
 * compiled twice (kernel.h lists every kernel). Set-up fills corners8 with eight triangles at a
 * time, clips what crosses the near plane (triangle_raster_clip), calls triangle_raster_set_up and
 * triangle_raster_plane, and stores the records of those that can be seen with the rows they touch.
 * Fill goes through the band's list (band_lists_of) and calls triangle_raster_walk with an inlined
 * function of eight pixels at a time, which tests depth, shades and stores. All of this is in
 * triangle_raster.h, over simd8.h; light and air in atmosphere.h. */
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
#define SOFT_SHADOW_FULL 255 /* of the shadow's eight bits */
#define SOFT_SHADOW_BITS 16  /* where they begin */

struct soft_kernels;

/* What every part knows of a picture. Axes are the world's. */
struct soft_frame {
    const struct draw_list *list;
    const struct frame_view *frame_view;
    const struct soft_kernels *kernels;
    uint32_t width, height, bands;
    /* A place p from the eye is at x = centre_x + dot(across, p) / d, y = centre_y +
     * dot(down, p) / d [pixel], d = dot(ahead, p) [m]. */
    float across[3], down[3], ahead[3];
    float centre_x, centre_y, near_m;
    /* And pixel (x, y) looks along ray + x * ray_x + y * ray_y, which is 1 m ahead; x and y of its
     * centre lie at halves. */
    float ray[3], ray_x[3], ray_y[3];
    float right[3], up[3], forward[3]; /* unit */
    float pixel_m;                     /* a pixel's width at a metre's distance */
    float sun[3];
    float haze, fog, fog_fall; /* [1/m]: haze; fog at the eye's height; how it thins with height */
    float time_s;
    bool texture;
};

/* A band: rows first .. end - 1 of the picture. Row y begins at (y - first) * stride of both. */
struct soft_target {
    uint32_t *colour;
    float *depth; /* [rows * stride], aligned to SOFT_ALIGN */
    uint32_t width, stride, band;
    int32_t first, end;
};

/* --- triangles, set up in triangle_raster.h --- */

/* A triangle's edges, ready to be walked: corners from top to bottom, and how far each edge goes
 * aside in a row. */
struct triangle_edges {
    float top_x, top_y, middle_x, middle_y, low_y;
    float long_slope, upper_slope, lower_slope;
};

/* Something that changes evenly over the picture: its value at the triangle's top corner, and by
 * how much it grows a pixel to the right and down. */
struct triangle_plane {
    float top, x, y;
};

#endif
