/* Pictures as PNG files. */
#ifndef JOLON_RENDERER_IMAGE_PNG_H
#define JOLON_RENDERER_IMAGE_PNG_H

#include "renderer/image/image.h"

#include <stddef.h>

/* The picture as the bytes of a file: RGB, 8 bits each, the comment in the text chunk
 * "Description". *bytes is the caller's to free. 0, or -1 with errno ENOMEM. */
int png_encode(const struct image *image, const char *comment, uint8_t **bytes, size_t *count);

/* Writes those to a path beneath a folder (a descriptor, or AT_FDCWD), through a
 * temporary file of mode 0600 beside it, exclusively made, and a rename: path is always a whole
 * picture, old or new, and a link of that name is replaced, not followed. 0, or -1 with errno
 * (ENOSPC, EACCES, ENOMEM, ...) and no temporary file left.
 */
int png_write_file(int folder, const char *path, const struct image *image, const char *comment);

#endif
