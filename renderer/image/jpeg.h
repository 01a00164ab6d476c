/* Pictures as JPEG. Any thread. */
#ifndef JOLON_RENDERER_IMAGE_JPEG_H
#define JOLON_RENDERER_IMAGE_JPEG_H

#include "renderer/image/image.h"

#include <stddef.h>
#include <stdint.h>

/* quality 1..100, as libjpeg has it. *bytes is the caller's to free. 0, or -1 with errno ENOMEM. */
int jpeg_encode(const struct image *image, int quality, uint8_t **bytes, size_t *count);

#endif
