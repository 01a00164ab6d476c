/* Pictures as PNG files. */
#ifndef JOLON_RENDERER_PNG_H
#define JOLON_RENDERER_PNG_H

#include "renderer/image/image.h"

/* Writes the picture as RGB to a path beneath a folder (a descriptor, or AT_FDCWD), through a
 * temporary file of mode 0600 beside it, exclusively made, and a rename: path is always a whole
 * picture, old or new, and a link of that name is replaced, not followed. comment goes into the
 * text chunk "Description". 0, or -1 with errno (ENOSPC, EACCES, ENOMEM, ...) and no temporary file
 * left.
 */
int png_write_file(int folder, const char *path, const struct image *image, const char *comment);

#endif
