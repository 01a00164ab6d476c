/* Pictures as PNG files. */
#ifndef JOLON_RENDERER_PNG_H
#define JOLON_RENDERER_PNG_H

#include "renderer/image.h"

/* Writes the picture as RGB, through a temporary file beside it and a rename: path is always a
 * whole picture, old or new. comment goes into the text chunk "Description". 0, or -1 with errno
 * (ENOSPC, EACCES, ENOMEM, ...) and no temporary file left. */
int png_write_file(const char *path, const struct image *image, const char *comment);

#endif
