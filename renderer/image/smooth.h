/* Smoothing the stairs along edges in a finished picture. Pure. */
#ifndef JOLON_RENDERER_SMOOTH_H
#define JOLON_RENDERER_SMOOTH_H

#include "renderer/image/image.h"

#include <stdint.h>

/* A picture's alpha tells what may be an edge. Pixels of this alpha are smoothed wherever the
 * contrast is high. */
#define SMOOTH_THING_ALPHA 255u
/* Others are surfaces with a grain of their own, which stays sharp: only where the alphas of
 * neighbours differ by so much are there edges. */
#define SMOOTH_STEP_ALPHA 2u
#define SMOOTH_WIDTH_MAX  8192u /* [pixel] */

/* Smooths rows first .. end - 1 of from into to, pictures of one size; to's alpha is 255. first <
 * end. The result is the same on every processor. */
void smooth_rows(struct image *to, const struct image *from, uint32_t first, uint32_t end);

static inline void smooth_edges(struct image *to, const struct image *from)
{
    smooth_rows(to, from, 0, from->height);
}

/* What smooth_rows() chooses between. */
typedef void smooth_function(struct image *to, const struct image *from, uint32_t first,
                             uint32_t end);
smooth_function smooth_rows_plain, smooth_rows_avx2;

#endif
