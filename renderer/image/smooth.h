/* Smoothing the stairs along edges in a finished picture. Pure. */
#ifndef JOLON_RENDERER_SMOOTH_H
#define JOLON_RENDERER_SMOOTH_H

#include "renderer/image/image.h"

#include <stdint.h>

/* Smooths from into to, pictures of one size. luma: [width * height] scratch. */
void smooth_edges(struct image *to, const struct image *from, uint8_t *luma);

#endif
