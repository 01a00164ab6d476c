/* The choice of what draws. */
#ifndef JOLON_RENDERER_BACK_END_H
#define JOLON_RENDERER_BACK_END_H

#include "renderer/scene/back_end_interface.h"
#include "renderer/options.h"

/* Opens the back end that options.back_end asks for, for pictures of the options' size, and logs in
 * one line which it is and why. BACK_END_AUTO: OpenGL when there is graphics hardware that draws,
 * else the own rasteriser; a machine without such hardware loads no OpenGL at all. 0, or -1 with
 * the reason. */
int back_end_open(struct back_end_interface *draw, const struct options *options,
                  const struct static_scene *static_scene, struct error_text *error);

/* Prints what can draw here, a line each, to standard output; 0. */
int back_end_list(void);

#endif
