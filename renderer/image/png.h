/* Pictures as PNG files. */
#ifndef JOLON_RENDERER_IMAGE_PNG_H
#define JOLON_RENDERER_IMAGE_PNG_H

#include "renderer/image/image.h"

#include <stddef.h>

/* Encodes the picture as a PNG file: RGB, 8 bits each, with the comment in the text chunk
 * "Description". The caller frees *bytes. Returns 0, or -1 with errno ENOMEM. */
int png_encode(const struct image *image, const char *comment, uint8_t **bytes, size_t *count);

/* Writes the picture to a path relative to a folder (a descriptor, or AT_FDCWD). The file is first
 * created under a temporary name with mode 0600, then renamed: path always holds a complete
 * picture, and a symbolic link of that name is replaced, not followed. Returns 0, or -1 with errno
 * (ENOSPC, EACCES, ENOMEM, ...); no temporary file is left. */
int png_write_file(int folder, const char *path, const struct image *image, const char *comment);

#endif
