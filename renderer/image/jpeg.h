/* Pictures as JPEG. Any thread. */
#ifndef JOLON_RENDERER_IMAGE_JPEG_H
#define JOLON_RENDERER_IMAGE_JPEG_H

#include "renderer/image/image.h"

#include <stddef.h>
#include <stdint.h>

/* Encodes with a libjpeg quality of 1..100. The caller frees *bytes. Returns 0, or -1 with errno
 * ENOMEM. */
int jpeg_encode(const struct image *image, int quality, uint8_t **bytes, size_t *count);

#endif
