/* Antialiasing of edges in a finished picture (FXAA). Pure. */
#ifndef JOLON_RENDERER_SOFT_FXAA_H
#define JOLON_RENDERER_SOFT_FXAA_H

#include "renderer/image/image.h"

#include <stdint.h>

/* A picture's alpha says where edges may be. Pixels of objects have this alpha: they are smoothed
 * wherever the contrast is high. */
#define FXAA_OBJECT_ALPHA 255u
/* Other pixels belong to textured surfaces, which stay sharp. Edges are only where the alphas of
 * neighbours differ by this much. */
#define FXAA_STEP_ALPHA 2u
#define FXAA_WIDTH_MAX  8192u /* [pixel] */

/* Smooths rows first .. end - 1 of a picture into another of the same size, whose alpha becomes
 * 255. first < end. The result is the same on every processor. */
void fxaa_rows(struct image *to, const struct image *from, uint32_t first, uint32_t end);

static inline void fxaa_edges(struct image *to, const struct image *from)
{
    fxaa_rows(to, from, 0, from->height);
}

/* The two builds that fxaa_rows() chooses between. */
typedef void fxaa_function(struct image *to, const struct image *from, uint32_t first,
                           uint32_t end);
fxaa_function fxaa_rows_plain, fxaa_rows_avx2;

#endif
