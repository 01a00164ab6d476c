/* Reducing a picture for documents to few colours: a palette of its own, and error diffusion. */
#ifndef JOLON_DOCS_FIGURES_PALETTE_H
#define JOLON_DOCS_FIGURES_PALETTE_H

#include "renderer/image/image.h"

#include <stdint.h>

#define PALETTE_COLOURS 256u

struct palette {
    uint8_t colours[PALETTE_COLOURS][3]; /* sRGB */
    uint32_t count;
};

/* Fills the palette and the pixels' indices[width * height]. Deterministic. Returns 0, or -1 with
 * errno ENOMEM. */
int palette_reduce(struct palette *palette, uint8_t *indices, const struct image *image);

#endif
