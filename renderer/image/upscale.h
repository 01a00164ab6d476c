/* Enlarging a picture. Pure. */
#ifndef JOLON_RENDERER_IMAGE_UPSCALE_H
#define JOLON_RENDERER_IMAGE_UPSCALE_H

#include "renderer/image/image.h"

#define UPSCALE_SIDE_MAX 8192u /* [pixel] of either picture */

/* Fills to with from, which is no larger; between its pixels, colours run evenly. Whole numbers
 * only: the same picture everywhere. */
void image_upscale(struct image *to, const struct image *from);

#endif
