/* Enlarging a picture. Pure. */
#ifndef JOLON_RENDERER_IMAGE_UPSCALE_H
#define JOLON_RENDERER_IMAGE_UPSCALE_H

#include "renderer/image/image.h"

#define UPSCALE_SIDE_MAX 8192u /* [pixel] of either picture */

/* Enlarges a picture to the size of another by bilinear interpolation. Uses integers only, so that
 * the result is the same everywhere. */
void image_upscale(struct image *to, const struct image *from);

#endif
