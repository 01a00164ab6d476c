/* Smoothing the stairs along edges in a finished picture. Pure. */
#ifndef JOLON_RENDERER_SOFT_FXAA_H
#define JOLON_RENDERER_SOFT_FXAA_H

#include "renderer/image/image.h"

#include <stdint.h>

/* A picture's alpha tells what may be an edge. Pixels of this alpha are smoothed wherever the
 * contrast is high. */
#define FXAA_THING_ALPHA 255u
/* Others are surfaces with a grain of their own, which stays sharp: only where the alphas of
 * neighbours differ by so much are there edges. */
#define FXAA_STEP_ALPHA 2u
#define FXAA_WIDTH_MAX  8192u /* [pixel] */

/* Smooths rows first .. end - 1 of from into to, pictures of one size; to's alpha is 255. first <
 * end. The result is the same on every processor. */
void fxaa_rows(struct image *to, const struct image *from, uint32_t first, uint32_t end);

static inline void fxaa_edges(struct image *to, const struct image *from)
{
    fxaa_rows(to, from, 0, from->height);
}

/* What fxaa_rows() chooses between. */
typedef void fxaa_function(struct image *to, const struct image *from, uint32_t first,
                           uint32_t end);
fxaa_function fxaa_rows_plain, fxaa_rows_avx2;

#endif
