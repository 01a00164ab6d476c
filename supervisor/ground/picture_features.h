/* Roads, trees, poles and buildings of a ground file in a picture. */
#ifndef JOLON_SUPERVISOR_GROUND_PICTURE_FEATURES_H
#define JOLON_SUPERVISOR_GROUND_PICTURE_FEATURES_H

#include "supervisor/ground/canvas.h"
#include "world/terrain/ground_file.h"

/* Draws the file's roads, then its objects, then its buildings, each at its size and at least so
 * large that it can be seen. Trees, bushes and poles are left out where a pixel is larger than they
 * are; the cover shows woods then. Ends the process (exit 1) if the file is damaged. */
void picture_features_draw(const struct canvas *canvas, const struct ground_file *file);

#endif
