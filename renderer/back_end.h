/* The choice of the back end: OpenGL or the renderer's own rasteriser. */
#ifndef JOLON_RENDERER_BACK_END_H
#define JOLON_RENDERER_BACK_END_H

#include "renderer/scene/back_end_interface.h"
#include "renderer/options.h"

/* Opens the back end of options->back_end for pictures of the options' size, and logs which it is
 * and why. BACK_END_AUTO takes OpenGL when there is graphics hardware that draws, else the own
 * rasteriser; without such hardware OpenGL is not loaded. Returns 0, or -1 with the reason. */
int back_end_open(struct back_end_interface *draw, const struct options *options,
                  const struct static_scene *static_scene, struct error_text *error);

/* Prints the back ends and OpenGL devices of this machine to standard output, a line each. Returns
 * 0. */
int back_end_list(void);

#endif
